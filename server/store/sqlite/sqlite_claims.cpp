// What workers ask of the embedded store: jobs to run, what became of them.

#include "server/store/artifact_names.h"
#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace modelsynth::server {

using proto::Job;
using proto::JobState;
using proto::UnixMillis;

namespace {

void keep_checkpoint(
    Database& database, const std::string& id, const JobCheckpoint& checkpoint, std::uint64_t seq
) {
    database
        .prepare(
            "INSERT OR REPLACE INTO checkpoint (job_id, seq, blocks_done, tally, labels) "
            "VALUES (?, ?, ?, ?, ?)"
        )
        .bind(std::string_view(id))
        .bind(seq)
        .bind(std::uint64_t{checkpoint.blocks_done})
        .bind(std::string_view(checkpoint.tally))
        .bind_blob(checkpoint.labels)
        .run();
}

tl::unexpected<StoreError> gap_in_log() {
    return failure(StoreErrorCode::kUnavailable, "what came before in the job's log was not kept");
}

// Whose turn it is now, and that the job's flow had one.
void keep_turn(Database& database, const std::string& id, UnixMillis now) {
    database
        .prepare(
            "UPDATE meta SET value = MAX(value, (SELECT turn FROM job WHERE id = ?)) "
            "WHERE key = 'turn'"
        )
        .bind(std::string_view(id))
        .run();
    database.prepare("INSERT OR REPLACE INTO flow SELECT owner, priority, ? FROM job WHERE id = ?")
        .bind(now)
        .bind(std::string_view(id))
        .run();
}

constexpr const char* kClaimColumns =
    "id, token, deadline, solved_seconds, solver_version, version_base, fruitless_claims, "
    "next_seq, cost, memory_bytes, created";

// The ordinals of the first queued job of each flow, by two looks into the index for each.
constexpr const char* kFirstOfFlows =
    "WITH RECURSIVE first (ordinal) AS ("
    "SELECT (SELECT ordinal FROM job INDEXED BY job_queue WHERE state = 0 "
    "ORDER BY owner, priority, turn LIMIT 1) "
    "UNION ALL "
    "SELECT COALESCE("
    "(SELECT ordinal FROM job INDEXED BY job_queue WHERE state = 0 AND owner = last.owner AND "
    "priority > last.priority ORDER BY priority, turn LIMIT 1), "
    "(SELECT ordinal FROM job INDEXED BY job_queue WHERE state = 0 AND owner > last.owner "
    "ORDER BY owner, priority, turn LIMIT 1)) "
    "FROM first JOIN job AS last USING (ordinal)) ";

enum class Fit : std::uint8_t {
    kNow,
    kLater,   // others may go before it
    kWaiting  // so long that nobody may: it waits until there is room
};

Fit find_fit(const Statement& row, UnixMillis now, const ClaimLimits& limits) {
    if (row.natural(8) > limits.cost_max) {
        return Fit::kLater;
    }
    if (row.natural(9) <= limits.memory_bytes_max) {
        return Fit::kNow;
    }
    return now - row.integer(10) >= kPatienceMs ? Fit::kWaiting : Fit::kLater;
}

Claim claim_of(const Statement& row) {
    Claim claim;
    claim.lease = {row.text(0), row.natural(1) + 1};
    if (!row.is_null(2)) {
        claim.deadline_seconds = row.real(2);
    }
    claim.solved_seconds = row.real(3);
    claim.solver_version = row.text(4);
    claim.version_base = row.natural(5);
    claim.fruitless_claims = static_cast<std::uint32_t>(row.natural(6));
    claim.head = row.natural(7) - 1;
    claim.cost = row.natural(8);
    claim.memory_bytes = row.natural(9);
    return claim;
}

// The first job whose turn it is and that fits. As a rule that is the first of a flow, found
// without a look at the rest of the queue; only where that one does not fit is all of it sorted.
// After the clock was set back the two may see jobs of one flow in another order.
std::optional<Claim> find_next(Database& database, UnixMillis now, const ClaimLimits& limits) {
    const std::string select = std::string("SELECT ") + kClaimColumns + " FROM ";
    const std::string order = std::string(" ORDER BY ") + kLevel + " DESC, turn, ordinal";
    {
        Statement first = database.prepare(
            kFirstOfFlows + select + "first JOIN job USING (ordinal) LEFT JOIN flow USING " +
            "(owner, priority)" + order + " LIMIT 1"
        );
        first.bind(now);
        if (!first.step()) {
            return std::nullopt;
        }
        const Fit fit = find_fit(first, now, limits);
        if (fit != Fit::kLater) {
            return fit == Fit::kNow ? std::optional(claim_of(first)) : std::nullopt;
        }
    }
    Statement next = database.prepare(select + kQueue + " WHERE state = 0" + order);
    next.bind(now);
    while (next.step()) {
        const Fit fit = find_fit(next, now, limits);
        if (fit != Fit::kLater) {
            return fit == Fit::kNow ? std::optional(claim_of(next)) : std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace

Stored<std::optional<Claim>> SqliteStore::claim(UnixMillis now, const ClaimLimits& limits) {
    return writer_->call<std::optional<Claim>>(
        [&](Database& database) -> Stored<std::optional<Claim>> {
            auto claim = find_next(database, now, limits);
            if (!claim) {
                return claim;
            }
            database
                .prepare(
                    "UPDATE job SET state = 1, token = ?, started = COALESCE(started, ?) "
                    "WHERE id = ?"
                )
                .bind(claim->lease.token)
                .bind(now)
                .bind(std::string_view(claim->lease.job_id))
                .run();
            gaps_.erase(claim->lease.job_id);
            keep_turn(database, claim->lease.job_id, now);
            auto job = find_job(database, claim->lease.job_id);
            if (!job) {
                return tl::unexpected(std::move(job.error()));
            }
            claim->job = std::move(*job);
            claim->checkpoint = find_checkpoint(database, claim->lease.job_id);
            return claim;
        }
    );
}

void SqliteStore::append(
    const Lease& lease,
    std::vector<NewEvent> events,
    const Progress& progress,
    std::function<void(const Stored<std::uint64_t>&)> done
) {
    const auto batch =
        waiting_appends_.add(lease, {std::move(events), progress, std::move(done), 0});
    if (batch == nullptr) {
        return;
    }
    writer_->post(
        {[this, batch](Database& database) -> Stored<void> {
             waiting_appends_.seal(batch);
             try {
                 auto written = append_now(database, *batch);
                 if (!written) {
                     note_gap(batch->lease, written.error().code);
                 }
                 return written;
             } catch (const SqliteError&) {
                 note_gap(batch->lease, StoreErrorCode::kUnavailable);
                 throw;
             }
         },
         [this, batch](const Stored<void>& committed) {
             waiting_appends_.seal(batch);  // a closed store has not begun with it
             if (!committed) {
                 note_gap(batch->lease, committed.error().code);
             }
             for (const WaitingAppends::Append& append : batch->appends) {
                 append.done(committed.map([&append] { return append.first_seq; }));
             }
         },
         Writer::Haste::kNobodyWaits}
    );
}

void SqliteStore::note_gap(const Lease& lease, StoreErrorCode code) {
    // After the end of the store there is no writer's thread, and nothing to append to.
    if (code != StoreErrorCode::kLeaseLost && code != StoreErrorCode::kClosed) {
        gaps_[lease.job_id] = lease.token;
    }
}

bool SqliteStore::has_gap(const Lease& lease) const {
    const auto found = gaps_.find(lease.job_id);
    return found != gaps_.end() && found->second == lease.token;
}

Stored<void> SqliteStore::append_now(Database& database, WaitingAppends::Batch& batch) {
    const Lease& lease = batch.lease;
    const Progress& newest = batch.appends.back().progress;
    std::uint64_t next_seq = 0;
    bool is_new_version = false;
    {
        Statement row = database.prepare(
            "SELECT next_seq, solver_version FROM job WHERE id = ? AND token = ? AND state = 1"
        );
        row.bind(std::string_view(lease.job_id)).bind(lease.token);
        if (!row.step()) {
            return lease_lost(lease);
        }
        if (has_gap(lease)) {
            return gap_in_log();
        }
        next_seq = row.natural(0);
        is_new_version = row.text(1) != newest.solver_version;
    }
    if (is_new_version) {
        // What is known of the job's models was made by another solver and is of no use to this
        // one.
        drop_checkpoint(database, lease.job_id);
        unlink_artifacts(database, lease.job_id, Unlinked::kMade);
        database.prepare("UPDATE job SET solver_version = ?, version_base = ? WHERE id = ?")
            .bind(std::string_view(newest.solver_version))
            .bind(next_seq - 1)
            .bind(std::string_view(lease.job_id))
            .run();
    }
    bool has_block = false;
    for (WaitingAppends::Append& append : batch.appends) {
        append.first_seq = next_seq;
        for (const NewEvent& event : append.events) {
            insert_event(database, lease.job_id, next_seq++, event);
            has_block = has_block || event.type == "block";
        }
        if (append.progress.checkpoint) {
            keep_checkpoint(database, lease.job_id, *append.progress.checkpoint, next_seq - 1);
        }
        if (auto linked = link_artifacts(database, lease.job_id, append.progress.artifacts);
            !linked) {
            return linked;
        }
    }
    database
        .prepare(
            "UPDATE job SET next_seq = ?, blocks_done = ?, blocks_total = ?, solved_seconds = ?, "
            "fruitless_claims = CASE WHEN ? THEN 0 ELSE fruitless_claims END WHERE id = ?"
        )
        .bind(next_seq)
        .bind(std::uint64_t{newest.blocks_done})
        .bind(std::uint64_t{newest.blocks_total})
        .bind(newest.solved_seconds)
        .bind(std::int64_t{has_block})
        .bind(std::string_view(lease.job_id))
        .run();
    return {};
}

Stored<Job> SqliteStore::finish(const Lease& lease, const Outcome& outcome) {
    return writer_->call<Job>([&](Database& database) -> Stored<Job> {
        const std::string& id = lease.job_id;
        bool cancel_requested = false;
        {
            Statement row =
                database.prepare("SELECT token, state, cancel_requested FROM job WHERE id = ?");
            row.bind(std::string_view(id));
            if (!row.step() || row.natural(0) != lease.token) {
                return lease_lost(lease);
            }
            const auto state = static_cast<JobState>(row.integer(1));
            if (proto::is_ended(state)) {
                return find_job(database, id);
            }
            if (state != JobState::kRunning) {
                return lease_lost(lease);
            }
            if (has_gap(lease)) {
                return gap_in_log();
            }
            cancel_requested = row.integer(2) != 0;
        }
        const JobState state = cancel_requested ? JobState::kCancelled : outcome.state;
        const bool succeeded = state == JobState::kSucceeded;
        const bool failed = state == JobState::kFailed;
        std::vector<ArtifactLink> kept = outcome.artifacts;
        if (!succeeded) {
            // What is left of an unfinished job is its preview.
            std::erase_if(kept, [](const ArtifactLink& artifact) {
                return artifact.name.ends_with(".glb");
            });
        }
        if (auto linked = link_artifacts(database, id, kept); !linked) {
            return tl::unexpected(std::move(linked.error()));
        }
        const bool has_labels =
            std::any_of(kept.begin(), kept.end(), [](const ArtifactLink& artifact) {
                return artifact.name == kPreviewArtifact || artifact.name == labels_artifact();
            });
        if (succeeded || has_labels) {
            // They tell more than it does.
            drop_checkpoint(database, id);
        }
        const std::string type(proto::state_name(state));
        const std::string fields = succeeded ? proto::succeeded_fields(outcome.result)
                                   : failed  ? proto::failed_fields(outcome.error)
                                             : "{}";
        append_event(database, id, {type, fields, outcome.finished});
        database
            .prepare(
                "UPDATE job SET state = ?, finished = ?, expires = ?, result = ?, error = ? "
                "WHERE id = ?"
            )
            .bind(static_cast<std::int64_t>(state))
            .bind(outcome.finished)
            .bind(outcome.finished + retention_ms_)
            .bind(std::string_view(succeeded ? outcome.result : ""))
            .bind(std::string_view(failed ? outcome.error : ""))
            .bind(std::string_view(id))
            .run();
        add_delivery(database, id, outcome.finished);
        return find_job(database, id);
    });
}

Stored<void> SqliteStore::release(const Lease& lease, double solved_seconds) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        if (!holds(database, lease)) {
            return lease_lost(lease);
        }
        database.prepare("UPDATE job SET state = 0, solved_seconds = ? WHERE id = ?")
            .bind(solved_seconds)
            .bind(std::string_view(lease.job_id))
            .run();
        Statement row = database.prepare("SELECT cancel_requested FROM job WHERE id = ?");
        row.bind(std::string_view(lease.job_id));
        if (row.step() && row.integer(0) != 0) {
            // Nobody shall run it again.
            end_cancelled(database, lease.job_id, proto::now_millis());
        }
        return {};
    });
}

}  // namespace modelsynth::server
