#pragma once

#include "proto/job.h"
#include "proto/timestamp.h"
#include "server/jobs/live_job.h"
#include "server/jobs/running_jobs.h"
#include "server/store/artifact_store.h"
#include "server/store/event_log.h"
#include "server/store/job_store.h"
#include "solver/core/observer.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::server {

// Part of what a job's log and model depend on; a change of the solver or of a built-in example
// that changes models must change it.
inline constexpr const char* kSolverVersion = "models-9";

// What the store knows of a job that was begun before: the candidates that ended, when it makes
// several models; of the one in hand where its solving goes on from, and the blocks that were
// logged after that, which are solved again and not logged again.
struct EarlierProgress {
    struct Block {
        std::uint64_t seq = 0;
        std::string fields;
    };

    std::vector<proto::CandidateEnd> candidates;
    std::uint32_t candidate_blocks = 0;  // logged by them

    std::optional<Checkpoint> checkpoint;
    std::uint64_t checkpoint_seq = 0;
    std::vector<Block> blocks;

    [[nodiscard]] std::uint32_t blocks_before() const {
        return checkpoint ? checkpoint->blocks_done : 0;
    }
};

// What there is to go on from, when this version of the solver made it for a model of so many
// cells. `is_series`: the job makes several.
[[nodiscard]] EarlierProgress read_earlier_progress(
    EventLog& events, const Claim& claim, std::size_t cell_count, bool is_series
);

// One of the models that a job makes, as seen in its log.
struct ModelInSeries {
    // Which of several; nothing: the job makes this one alone.
    std::optional<std::uint32_t> alternative;
    std::uint32_t blocks_before = 0;  // logged by the candidates before it
    std::uint32_t models_left = 1;    // to be made, this one included
    bool begins_claim = true;         // the first that this claim makes
};

// Turns what the solver tells into events, checkpoints and patches of the live job. What was
// logged before is compared with what is solved now. One run, on the thread that solves.
class LoggingObserver final : public Observer {
  public:
    // All but `earlier` outlive the store's last answer; see JobStore::append().
    LoggingObserver(
        JobStore& jobs,
        RunningJobs& running,
        const Claim& claim,
        std::function<void(StopReason)> stop,
        std::shared_ptr<LiveJob> live,
        const EarlierProgress& earlier,
        const ModelInSeries& place,
        std::function<void(bool accepted)> on_new_block
    );

    void on_warnings(std::span<const std::string> warnings) override;
    void on_start(std::uint32_t blocks_total, std::span<const Label> model) override;
    void on_block(const BlockReport& report) override;

    // How long this claim has been solving, and the ones before it.
    [[nodiscard]] double solved_seconds() const;

    // Of this model, as far as it is.
    [[nodiscard]] std::uint32_t blocks_done() const { return blocks_done_; }

    // Logs what became of the model, a candidate of several, with what is linked to the job by it.
    // `artifacts` are held until then. `is_last`: no other is begun.
    void end_candidate(
        const proto::CandidateEnd& end,
        std::vector<ArtifactLink> links,
        std::vector<std::shared_ptr<ArtifactStore::Pin>> artifacts,
        bool is_last
    );

    // What was solved again differs from what the log holds; the run was stopped.
    [[nodiscard]] bool diverged() const { return diverged_; }

  private:
    using Clock = std::chrono::steady_clock;

    // The newest event that the live job can show; the store's thread alone changes it.
    struct Start {
        std::uint64_t seq = 0;  // of this claim's `started` event
    };

    void replay(
        const EarlierProgress::Block& logged,
        const std::string& fields,
        std::shared_ptr<Patch> patch
    );
    [[nodiscard]] std::shared_ptr<Patch> make_patch(const BlockReport& report) const;
    // The checkpoint after this block; nothing when it is too early for one.
    [[nodiscard]] std::optional<JobCheckpoint> make_checkpoint(const BlockReport& report);
    // With the labels that the live job begins with.
    void start_claim(std::shared_ptr<const std::vector<Label>> labels);
    void start_next(std::shared_ptr<const std::vector<Label>> labels);
    // `blocks_done` of this model.
    void append(
        std::vector<NewEvent> events,
        std::uint32_t blocks_done,
        std::optional<JobCheckpoint> checkpoint,
        std::function<void(std::uint64_t)> then,
        std::vector<ArtifactLink> artifacts = {}
    );

    JobStore& jobs_;
    RunningJobs& running_;
    const Claim& claim_;
    std::function<void(StopReason)> stop_;
    std::shared_ptr<LiveJob> live_;
    const EarlierProgress& earlier_;
    std::shared_ptr<Start> start_ = std::make_shared<Start>();
    const ModelInSeries place_;
    std::function<void(bool)> on_new_block_;
    std::vector<std::string> warnings_;
    std::uint32_t blocks_total_ = 0;  // of the job
    std::uint32_t blocks_done_ = 0;
    bool diverged_ = false;
    Clock::time_point begun_ = Clock::now();
    std::optional<Clock::time_point> last_checkpoint_;
};

}  // namespace modelsynth::server
