#include "tests/unit/server/store_model.h"

#include <algorithm>

namespace modelsynth::server {

using proto::JobState;

namespace {

tl::unexpected<StoreError> failure(StoreErrorCode code) {
    return tl::unexpected(StoreError{code, "the model says so"});
}

void append_event(StoreModel::Row& row, const NewEvent& event) {
    ++row.job.head;
    row.events.push_back({row.job.head, event.type, event.fields, event.time});
}

}  // namespace

const StoreModel::Row* StoreModel::find(const std::string& id) const {
    const auto found = std::find_if(rows_.begin(), rows_.end(), [&id](const Row& row) {
        return row.job.id == id;
    });
    return found == rows_.end() ? nullptr : &*found;
}

StoreModel::Row* StoreModel::held(const Lease& lease) {
    const auto found = std::find_if(rows_.begin(), rows_.end(), [&lease](const Row& row) {
        return row.job.id == lease.job_id && row.token == lease.token;
    });
    return found == rows_.end() ? nullptr : &*found;
}

std::int64_t StoreModel::effective_priority(const Row& row, proto::UnixMillis now) {
    return row.submitted.priority + (now - row.submitted.created) / 30'000;
}

void StoreModel::end(Row& row, JobState state, NewEvent event) {
    row.job.state = state;
    row.job.finished = event.time;
    row.job.expires = event.time + retention_ms_;
    append_event(row, event);
}

Stored<Submitted> StoreModel::submit(const NewJob& job, std::size_t queue_max) {
    std::size_t queued_count = 0;
    std::uint64_t position = 0;
    for (const Row& row : rows_) {
        if (!job.idempotency_key.empty() && row.submitted.idempotency_key == job.idempotency_key) {
            if (row.submitted.request_hash != job.request_hash) {
                return failure(StoreErrorCode::kConflict);
            }
            return Submitted{row.job, true};
        }
        if (row.job.state == JobState::kQueued) {
            ++queued_count;
            if (effective_priority(row, job.created) >= job.priority) {
                ++position;
            }
        }
    }
    if (queued_count >= queue_max) {
        return failure(StoreErrorCode::kQueueFull);
    }
    Row row;
    for (const ArtifactLink& artifact : job.artifacts) {
        if (!stored_digests_.contains(artifact.digest)) {
            return failure(StoreErrorCode::kConflict);
        }
        row.artifacts.insert({artifact.name, artifact.digest});
    }
    row.submitted = job;
    row.job.id = job.id;
    row.job.solver = job.solver;
    row.job.seed = job.seed;
    row.job.request = job.request;
    row.job.created = job.created;
    append_event(row, {"queued", proto::queued_fields(position), job.created});
    rows_.push_back(row);
    return Submitted{row.job, false};
}

std::optional<Claim> StoreModel::claim(proto::UnixMillis now) {
    Row* best = nullptr;
    for (Row& row : rows_) {
        if (row.job.state == JobState::kQueued &&
            (best == nullptr || effective_priority(row, now) > effective_priority(*best, now))) {
            best = &row;
        }
    }
    if (best == nullptr) {
        return std::nullopt;
    }
    best->job.state = JobState::kRunning;
    best->job.started = best->job.started.value_or(now);
    ++best->token;
    Claim claim;
    claim.lease = {best->job.id, best->token};
    claim.job = best->job;
    claim.deadline_seconds = best->submitted.deadline_seconds;
    claim.solved_seconds = best->solved_seconds;
    claim.solver_version = best->solver_version;
    claim.version_base = best->version_base;
    claim.checkpoint = best->checkpoint;
    claim.head = best->job.head;
    claim.fruitless_claims = best->fruitless_claims;
    return claim;
}

Stored<std::uint64_t> StoreModel::append(
    const Lease& lease, const std::vector<NewEvent>& events, const Progress& progress
) {
    Row* row = held(lease);
    if (row == nullptr || row->job.state != JobState::kRunning) {
        return failure(StoreErrorCode::kLeaseLost);
    }
    const bool all_stored = std::all_of(
        progress.artifacts.begin(),
        progress.artifacts.end(),
        [this](const ArtifactLink& artifact) { return stored_digests_.contains(artifact.digest); }
    );
    if (!all_stored) {
        return failure(StoreErrorCode::kConflict);
    }
    const std::uint64_t first = row->job.head + 1;
    if (row->solver_version != progress.solver_version) {
        row->checkpoint.reset();
        row->version_base = first - 1;
        std::erase_if(row->artifacts, [](const auto& artifact) {
            return artifact.first != "example" && artifact.first != "origin";
        });
    }
    for (const ArtifactLink& artifact : progress.artifacts) {
        row->artifacts.insert({artifact.name, artifact.digest});
    }
    for (const NewEvent& event : events) {
        append_event(*row, event);
        if (event.type == "block") {
            row->fruitless_claims = 0;
        }
    }
    row->job.blocks_done = progress.blocks_done;
    row->job.blocks_total = progress.blocks_total;
    row->solved_seconds = progress.solved_seconds;
    row->solver_version = progress.solver_version;
    if (progress.checkpoint) {
        row->checkpoint = progress.checkpoint;
        row->checkpoint->seq = row->job.head;
    }
    return first;
}

Stored<proto::Job> StoreModel::finish(const Lease& lease, const Outcome& outcome) {
    Row* row = held(lease);
    if (row == nullptr || row->job.state == JobState::kQueued) {
        return failure(StoreErrorCode::kLeaseLost);
    }
    if (proto::is_ended(row->job.state)) {
        return row->job;
    }
    const JobState state = row->cancel_requested ? JobState::kCancelled : outcome.state;
    std::map<std::string, std::string> kept;
    for (const ArtifactLink& artifact : outcome.artifacts) {
        if (state == JobState::kSucceeded || !artifact.name.ends_with(".glb")) {
            if (!stored_digests_.contains(artifact.digest)) {
                return failure(StoreErrorCode::kConflict);
            }
            kept.insert({artifact.name, artifact.digest});
        }
    }
    if (state == JobState::kSucceeded || kept.contains("labels") || kept.contains("preview")) {
        row->checkpoint.reset();
    }
    row->artifacts.merge(kept);
    std::string fields = "{}";
    if (state == JobState::kSucceeded) {
        row->job.result = outcome.result;
        fields = proto::succeeded_fields(outcome.result);
    } else if (state == JobState::kFailed) {
        row->job.error = outcome.error;
        fields = proto::failed_fields(outcome.error);
    }
    end(*row, state, {std::string(proto::state_name(state)), fields, outcome.finished});
    return row->job;
}

Stored<void> StoreModel::release(const Lease& lease, double solved_seconds) {
    Row* row = held(lease);
    if (row == nullptr || row->job.state != JobState::kRunning) {
        return failure(StoreErrorCode::kLeaseLost);
    }
    row->solved_seconds = solved_seconds;
    row->job.state = JobState::kQueued;
    if (row->cancel_requested) {
        end(*row, JobState::kCancelled, {"cancelled", "{}", proto::now_millis()});
    }
    return {};
}

Stored<proto::Job> StoreModel::cancel(const std::string& id, proto::UnixMillis now) {
    for (Row& row : rows_) {
        if (row.job.id == id) {
            if (row.job.state == JobState::kQueued) {
                end(row, JobState::kCancelled, {"cancelled", "{}", now});
            } else if (row.job.state == JobState::kRunning) {
                row.cancel_requested = true;
            }
            return row.job;
        }
    }
    return failure(StoreErrorCode::kNotFound);
}

Stored<void> StoreModel::erase(const std::string& id) {
    if (find(id) == nullptr) {
        return failure(StoreErrorCode::kNotFound);
    }
    std::erase_if(rows_, [&id](const Row& row) { return row.job.id == id; });
    return {};
}

Stored<void> StoreModel::link(const std::string& id, const ArtifactLink& link) {
    for (Row& row : rows_) {
        if (row.job.id == id) {
            if (!stored_digests_.contains(link.digest)) {
                return failure(StoreErrorCode::kConflict);
            }
            row.artifacts.insert({link.name, link.digest});
            return {};
        }
    }
    return failure(StoreErrorCode::kNotFound);
}

void StoreModel::expire(proto::UnixMillis now) {
    for (Row& row : rows_) {
        if (row.job.expires && *row.job.expires < now) {
            row.artifacts.clear();
            row.checkpoint.reset();
        }
    }
}

void StoreModel::reopen() {
    for (Row& row : rows_) {
        if (row.job.state == JobState::kRunning && row.cancel_requested) {
            end(row, JobState::kCancelled, {"cancelled", "{}", proto::now_millis()});
        } else if (row.job.state == JobState::kRunning) {
            row.job.state = JobState::kQueued;
            ++row.fruitless_claims;
        }
    }
}

}  // namespace modelsynth::server
