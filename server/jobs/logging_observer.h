#pragma once

#include "proto/timestamp.h"
#include "server/jobs/live_job.h"
#include "server/jobs/running_jobs.h"
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
inline constexpr const char* kSolverVersion = "discrete-4";

// What the store knows of a job that was begun before: where its solving goes on from, and the
// blocks that were logged after that, which are solved again and not logged again.
struct EarlierProgress {
    struct Block {
        std::uint64_t seq = 0;
        std::string fields;
    };

    std::optional<Checkpoint> checkpoint;
    std::uint64_t checkpoint_seq = 0;
    std::vector<Block> blocks;

    [[nodiscard]] std::uint32_t blocks_before() const {
        return checkpoint ? checkpoint->blocks_done : 0;
    }
};

// What there is to go on from, when this version of the solver made it for a model of so many
// cells.
[[nodiscard]] EarlierProgress read_earlier_progress(
    EventLog& events, const Claim& claim, std::size_t cell_count
);

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
        const EarlierProgress& earlier
    );

    void on_start(std::uint32_t blocks_total, std::span<const Label> model) override;
    void on_block(const BlockReport& report) override;

    // How long this claim has been solving, and the ones before it.
    [[nodiscard]] double solved_seconds() const;

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
    void append(
        std::vector<NewEvent> events,
        std::uint32_t blocks_done,
        std::optional<JobCheckpoint> checkpoint,
        std::function<void(std::uint64_t)> then
    );

    JobStore& jobs_;
    RunningJobs& running_;
    const Claim& claim_;
    std::function<void(StopReason)> stop_;
    std::shared_ptr<LiveJob> live_;
    const EarlierProgress& earlier_;
    std::shared_ptr<Start> start_ = std::make_shared<Start>();
    std::uint32_t blocks_total_ = 0;
    bool diverged_ = false;
    Clock::time_point begun_ = Clock::now();
    std::optional<Clock::time_point> last_checkpoint_;
};

}  // namespace modelsynth::server
