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

std::int64_t StoreModel::level(const NewJob& job, proto::UnixMillis now) const {
    const auto served = served_.find(flow_of(job));
    const proto::UnixMillis since =
        served == served_.end() ? job.created : std::max(job.created, served->second);
    return job.priority + std::max<proto::UnixMillis>(0, now - since) / 30'000;
}

// Of two that are queued; `one` came before the other.
bool StoreModel::goes_before(const Row& one, const Row& other, proto::UnixMillis now) const {
    const std::int64_t difference = level(one.submitted, now) - level(other.submitted, now);
    return difference > 0 || (difference == 0 && one.turn <= other.turn);
}

void StoreModel::end(Row& row, JobState state, NewEvent event) {
    row.job.state = state;
    row.job.finished = event.time;
    row.job.expires = event.time + retention_ms_;
    append_event(row, event);
}

Stored<Submitted> StoreModel::submit(const NewJob& job, const QueueLimits& limits) {
    std::size_t queued_count = 0;
    std::size_t unfinished_count = 0;
    Row row;
    row.submitted = job;
    row.turn = turn_;
    for (const Row& earlier : rows_) {
        if (!proto::is_ended(earlier.job.state) && earlier.submitted.owner == job.owner) {
            ++unfinished_count;
            if (earlier.submitted.priority == job.priority) {
                row.turn = std::max(row.turn, earlier.turn + earlier.submitted.cost);
            }
        }
    }
    std::uint64_t position = 0;
    for (const Row& earlier : rows_) {
        if (!job.idempotency_key.empty() && earlier.submitted.owner == job.owner &&
            earlier.submitted.idempotency_key == job.idempotency_key) {
            if (earlier.submitted.request_hash != job.request_hash) {
                return failure(StoreErrorCode::kConflict);
            }
            return Submitted{earlier.job, true};
        }
        if (earlier.job.state == JobState::kQueued) {
            ++queued_count;
            position += goes_before(earlier, row, job.created) ? 1U : 0U;
        }
    }
    if (queued_count >= limits.queued_max) {
        return failure(StoreErrorCode::kQueueFull);
    }
    if (unfinished_count >= limits.unfinished_max) {
        return failure(StoreErrorCode::kOwnerFull);
    }
    for (const ArtifactLink& artifact : job.artifacts) {
        if (!stored_digests_.contains(artifact.digest)) {
            return failure(StoreErrorCode::kConflict);
        }
        row.artifacts.insert({artifact.name, artifact.digest});
    }
    row.job.id = job.id;
    row.job.solver = job.solver;
    row.job.seed = job.seed;
    row.job.request = job.request;
    row.job.created = job.created;
    row.job.owner = job.owner;
    row.job.traceparent = job.traceparent;
    append_event(row, {"queued", proto::queued_fields(position), job.created});
    rows_.push_back(row);
    return Submitted{row.job, false};
}

std::optional<Claim> StoreModel::claim(proto::UnixMillis now, const ClaimLimits& limits) {
    std::vector<Row*> queue;
    for (Row& row : rows_) {
        if (row.job.state == JobState::kQueued) {
            queue.push_back(&row);
        }
    }
    std::stable_sort(queue.begin(), queue.end(), [this, now](const Row* one, const Row* other) {
        const std::int64_t difference = level(one->submitted, now) - level(other->submitted, now);
        return difference > 0 || (difference == 0 && one->turn < other->turn);
    });
    Row* best = nullptr;
    for (Row* row : queue) {
        const NewJob& job = row->submitted;
        if (job.cost > limits.cost_max) {
            continue;
        }
        if (job.memory_bytes <= limits.memory_bytes_max) {
            best = row;
            break;
        }
        if (now - job.created >= 30'000) {
            break;  // waits until there is room, and all others with it
        }
    }
    if (best == nullptr) {
        return std::nullopt;
    }
    turn_ = std::max(turn_, best->turn);
    served_[flow_of(best->submitted)] = now;
    best->job.state = JobState::kRunning;
    best->has_gap = false;
    best->job.started = best->job.started.value_or(now);
    ++best->token;
    Claim claim;
    claim.lease = {best->job.id, best->token};
    claim.job = best->job;
    claim.deadline_seconds = best->submitted.deadline_seconds;
    claim.cost = best->submitted.cost;
    claim.memory_bytes = best->submitted.memory_bytes;
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
    if (row->has_gap) {
        return failure(StoreErrorCode::kUnavailable);
    }
    const bool all_stored = std::all_of(
        progress.artifacts.begin(),
        progress.artifacts.end(),
        [this](const ArtifactLink& artifact) { return stored_digests_.contains(artifact.digest); }
    );
    if (!all_stored) {
        row->has_gap = true;
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
    if (row->has_gap) {
        return failure(StoreErrorCode::kUnavailable);
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
            if (link.name == "preview" && proto::is_ended(row.job.state)) {
                row.checkpoint.reset();
            }
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
