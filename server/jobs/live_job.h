#pragma once

#include "solver/registry/task.h"

#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace modelsynth::server {

// What one block changed.
struct Patch {
    std::uint64_t seq = 0;
    Box region;
    std::vector<Label> labels;  // of the region, x fastest, then z, then y
};

// The model of a job as far as its log tells it, for previews and partial frames. It changes only
// after the event is on disk, so that nobody sees what a crash could take back. Thread-safe.
class LiveJob {
  public:
    struct State {
        std::uint64_t seq = 0;  // the newest event included
        Model model;
        bool any_block = false;  // a block was accepted
    };

    LiveJob(Example example, GridSize size);

    [[nodiscard]] const Example& example() const { return example_; }

    // The initial model stands; kNoLabel everywhere where there is none.
    void start(std::uint64_t seq, std::span<const Label> initial);

    // An accepted block; patches older than the last kPatchBytesMax are dropped.
    void apply(std::shared_ptr<const Patch> patch);

    // A reverted block, or any event that changes nothing.
    void pass(std::uint64_t seq);

    [[nodiscard]] State state() const;

    // What the event changed; nothing when it is no longer kept.
    [[nodiscard]] std::shared_ptr<const Patch> patch(std::uint64_t seq) const;

    [[nodiscard]] std::size_t bytes() const;

  private:
    static constexpr std::size_t kPatchBytesMax = std::size_t{8} << 20;

    Example example_;
    mutable std::mutex mutex_;
    State state_;
    std::deque<std::shared_ptr<const Patch>> patches_;
    std::size_t patch_bytes_ = 0;
};

// The live jobs by id: all that run, and the latest that ended, so that a client who asks a
// moment late still gets every frame. Thread-safe.
class LiveJobs {
  public:
    void add(const std::string& id, std::shared_ptr<LiveJob> job);
    [[nodiscard]] std::shared_ptr<LiveJob> find(const std::string& id) const;
    // The job runs no more; it may be forgotten when memory is wanted.
    void retire(const std::string& id);
    void forget(const std::string& id);

  private:
    static constexpr std::size_t kRetiredMax = 64;
    static constexpr std::size_t kRetiredBytesMax = std::size_t{32} << 20;

    mutable std::mutex mutex_;
    std::map<std::string, std::shared_ptr<LiveJob>> jobs_;
    std::list<std::string> retired_;  // oldest first
};

}  // namespace modelsynth::server
