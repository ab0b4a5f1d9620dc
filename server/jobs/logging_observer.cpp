#include "server/jobs/logging_observer.h"

#include "proto/frame.h"
#include "proto/job.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

namespace {

// So much work at most is done twice after a crash, ...
constexpr std::chrono::seconds kCheckpointInterval(1);
// ... or more for a large model: checkpoints take no more than this of the disk.
constexpr double kCheckpointBytesPerSecond = 2e6;

void show(LiveJob& live, const std::shared_ptr<Patch>& patch, std::uint64_t seq) {
    if (patch == nullptr) {
        live.pass(seq);
        return;
    }
    patch->seq = seq;
    live.apply(patch);
}

std::optional<Checkpoint> decode(const JobCheckpoint& stored, std::size_t cell_count) {
    auto labels = proto::decode_labels(stored.labels);
    const auto tally = proto::decode_tally(stored.tally);
    if (!labels || labels->size() != cell_count || !tally) {
        return std::nullopt;
    }
    return Checkpoint{stored.blocks_done, *tally, std::move(*labels)};
}

}  // namespace

EarlierProgress read_earlier_progress(
    EventLog& events, const Claim& claim, std::size_t cell_count, bool is_series
) {
    EarlierProgress earlier;
    if (claim.solver_version != kSolverVersion) {
        return earlier;
    }
    if (claim.checkpoint) {
        earlier.checkpoint = decode(*claim.checkpoint, cell_count);
        earlier.checkpoint_seq = earlier.checkpoint ? claim.checkpoint->seq : 0;
    }
    constexpr std::size_t kPage = 1000;
    // What became of candidates stands in the log alone.
    std::uint64_t after =
        is_series ? claim.version_base : std::max(earlier.checkpoint_seq, claim.version_base);
    std::uint32_t blocks = 0;
    while (after < claim.head) {
        const auto page = events.read(claim.lease.job_id, after, kPage);
        if (!page || page->events.empty()) {
            break;
        }
        for (const Event& event : page->events) {
            if (event.type == "block") {
                ++blocks;
                if (event.seq > earlier.checkpoint_seq) {
                    earlier.blocks.push_back({event.seq, event.fields});
                }
            } else if (event.type == "alternative") {
                auto end = proto::parse_alternative_fields(event.fields);
                if (!end) {
                    return {};
                }
                earlier.candidates.push_back(std::move(*end));
                earlier.candidate_blocks = blocks;
                earlier.blocks.clear();
                if (earlier.checkpoint_seq < event.seq) {
                    earlier.checkpoint.reset();  // of that candidate
                }
            }
            after = event.seq;
        }
    }
    return earlier;
}

LoggingObserver::LoggingObserver(
    JobStore& jobs,
    RunningJobs& running,
    const Claim& claim,
    std::function<void(StopReason)> stop,
    std::shared_ptr<LiveJob> live,
    const EarlierProgress& earlier,
    const ModelInSeries& place,
    std::function<void(bool)> on_new_block
)
    : jobs_(jobs),
      running_(running),
      claim_(claim),
      stop_(std::move(stop)),
      live_(std::move(live)),
      earlier_(earlier),
      place_(place),
      on_new_block_(std::move(on_new_block)),
      blocks_done_(earlier.blocks_before()) {
    if (earlier_.checkpoint) {
        last_checkpoint_ = begun_;
    }
}

void LoggingObserver::on_warnings(std::span<const std::string> warnings) {
    warnings_.assign(warnings.begin(), warnings.end());
}

void LoggingObserver::on_start(std::uint32_t blocks_total, std::span<const Label> model) {
    blocks_total_ = place_.blocks_before + place_.models_left * blocks_total;
    auto labels = std::make_shared<const std::vector<Label>>(model.begin(), model.end());
    if (place_.begins_claim) {
        start_claim(std::move(labels));
    } else {
        start_next(std::move(labels));
    }
}

void LoggingObserver::start_claim(std::shared_ptr<const std::vector<Label>> labels) {
    // The state that the live job begins with belongs to the seq that it had.
    const bool any_block = earlier_.checkpoint && earlier_.checkpoint->tally.accepted() > 0;
    const std::uint64_t first_replayed = earlier_.blocks.empty() ? 0 : earlier_.blocks.front().seq;
    const std::uint64_t known_seq = earlier_.checkpoint  ? earlier_.checkpoint_seq
                                    : first_replayed > 0 ? first_replayed - 1
                                                         : 0;
    const bool nothing_to_replay = earlier_.blocks.empty();
    const bool resumed = !claim_.solver_version.empty();
    std::vector<NewEvent> events;
    events.push_back(
        {"started", proto::started_fields(blocks_total_, resumed, warnings_), proto::now_millis()}
    );
    append(
        std::move(events),
        earlier_.blocks_before() + static_cast<std::uint32_t>(earlier_.blocks.size()),
        std::nullopt,
        [start = start_, live = live_, labels, known_seq, any_block, nothing_to_replay](
            std::uint64_t seq
        ) {
            start->seq = seq;
            live->start(known_seq > 0 ? known_seq : seq, *labels, any_block);
            if (nothing_to_replay) {
                live->pass(seq);
            }
        }
    );
}

void LoggingObserver::start_next(std::shared_ptr<const std::vector<Label>> labels) {
    // Nothing is logged; the newest event is the one before the next.
    append({}, 0, std::nullopt, [live = live_, labels](std::uint64_t next_seq) {
        live->start(next_seq - 1, *labels, false);
    });
}

void LoggingObserver::on_block(const BlockReport& report) {
    blocks_done_ = report.index + 1;
    BlockReport in_job = report;
    in_job.index += place_.blocks_before;
    in_job.blocks_total = blocks_total_;
    std::string fields = proto::block_fields(in_job, place_.alternative);
    std::shared_ptr<Patch> patch = report.accepted ? make_patch(report) : nullptr;
    const std::uint32_t replayed = report.index - earlier_.blocks_before();
    if (replayed < earlier_.blocks.size()) {
        replay(earlier_.blocks[replayed], fields, std::move(patch));
        return;
    }
    on_new_block_(report.accepted);
    std::vector<NewEvent> events;
    events.push_back({"block", std::move(fields), proto::now_millis()});
    append(
        std::move(events),
        report.index + 1,
        make_checkpoint(report),
        [live = live_, patch](std::uint64_t seq) { show(*live, patch, seq); }
    );
}

void LoggingObserver::end_candidate(
    const proto::CandidateEnd& end,
    std::vector<ArtifactLink> links,
    std::vector<std::shared_ptr<ArtifactStore::Pin>> artifacts,
    bool is_last
) {
    if (blocks_total_ == 0) {
        on_start(1, {});  // it was given up before anything was shown of it
    }
    std::vector<NewEvent> events;
    events.push_back({"alternative", proto::alternative_fields(end), proto::now_millis()});
    append(
        std::move(events),
        blocks_done_,
        std::nullopt,
        [live = live_, artifacts = std::move(artifacts), is_last](std::uint64_t seq) {
            // A state after this event is the next model's, which begins at it.
            if (is_last) {
                live->pass(seq);
            }
        },
        std::move(links)
    );
}

double LoggingObserver::solved_seconds() const {
    const std::chrono::duration<double> own = Clock::now() - begun_;
    return claim_.solved_seconds + own.count();
}

void LoggingObserver::replay(
    const EarlierProgress::Block& logged, const std::string& fields, std::shared_ptr<Patch> patch
) {
    if (logged.fields != fields) {
        diverged_ = true;
        stop_(StopReason::kLost);
        return;
    }
    // In order with the blocks still to be appended, so through the store's queue as well.
    const bool last = &logged == &earlier_.blocks.back();
    append(
        {},
        earlier_.blocks_before() + static_cast<std::uint32_t>(earlier_.blocks.size()),
        std::nullopt,
        [live = live_, patch = std::move(patch), seq = logged.seq, last, start = start_](
            std::uint64_t
        ) {
            show(*live, patch, seq);
            if (last) {
                live->pass(start->seq);
            }
        }
    );
}

std::shared_ptr<Patch> LoggingObserver::make_patch(const BlockReport& report) const {
    auto patch = std::make_shared<Patch>();
    patch->region = report.region;
    patch->labels = live_->space().copy_out(report.model, report.region);
    return patch;
}

std::optional<JobCheckpoint> LoggingObserver::make_checkpoint(const BlockReport& report) {
    if (!report.accepted) {
        return std::nullopt;
    }
    // The first one comes with the first block, so that from then on there is always a preview.
    const auto now = Clock::now();
    if (last_checkpoint_) {
        const std::chrono::duration<double> by_size(
            static_cast<double>(report.model.size_bytes()) / kCheckpointBytesPerSecond
        );
        if (now - *last_checkpoint_ <
            std::max<std::chrono::duration<double>>(kCheckpointInterval, by_size)) {
            return std::nullopt;
        }
    }
    last_checkpoint_ = now;
    return JobCheckpoint{
        0, report.index + 1, proto::encode_tally(report.tally), proto::encode_labels(report.model)};
}

void LoggingObserver::append(
    std::vector<NewEvent> events,
    std::uint32_t blocks_done,
    std::optional<JobCheckpoint> checkpoint,
    std::function<void(std::uint64_t)> then,
    std::vector<ArtifactLink> artifacts
) {
    jobs_.append(
        claim_.lease,
        std::move(events),
        {place_.blocks_before + blocks_done,
         blocks_total_,
         solved_seconds(),
         kSolverVersion,
         std::move(checkpoint),
         std::move(artifacts)},
        [&running = running_,
         id = claim_.lease.job_id,
         then = std::move(then)](const Stored<std::uint64_t>& seq) {
            if (seq) {
                then(*seq);
            } else {
                running.stop(id, StopReason::kLost);
            }
        }
    );
}

}  // namespace modelsynth::server
