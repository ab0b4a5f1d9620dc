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
    std::vector<Label> labels;  // of the region, as ModelSpace::copy_out() gives them
};

// The model of a job as far as its log tells it, for previews and partial frames. It changes only
// after the event is on disk, so that nobody sees what a crash could take back. Kept as an older
// state and the patches since, so that every state from there on can be had. Thread-safe.
class LiveJob {
  public:
    struct State {
        std::uint64_t seq = 0;  // the newest event included
        Model model;
        bool any_block = false;  // a block was accepted
    };

    explicit LiveJob(std::shared_ptr<const ModelSpace> space);

    [[nodiscard]] const ModelSpace& space() const { return *base_.space; }

    // The initial model stands, or that of a checkpoint with accepted blocks; kNoLabel everywhere
    // where there is none. Of several models, the next begins so; the one before is forgotten.
    void start(std::uint64_t seq, std::span<const Label> model, bool any_block);

    // An accepted block; seqs rise. Patches beyond kPatchBytesMax become part of the older state.
    void apply(std::shared_ptr<const Patch> patch);

    // A reverted block, or any event that changes nothing.
    void pass(std::uint64_t seq);

    // The newest state.
    [[nodiscard]] State state() const;

    // The state at an event, or the oldest one that can be had when it is newer. Nothing when the
    // job has not come so far.
    [[nodiscard]] std::optional<State> state_at(std::uint64_t seq) const;

    // What the event changed; nothing when it is no longer kept.
    [[nodiscard]] std::shared_ptr<const Patch> patch(std::uint64_t seq) const;

    [[nodiscard]] std::size_t bytes() const;

  private:
    static constexpr std::size_t kPatchBytesMax = std::size_t{8} << 20;

    [[nodiscard]] State build(std::uint64_t seq) const;

    mutable std::mutex mutex_;
    Model base_;  // before the patches
    std::uint64_t base_seq_ = 0;
    std::uint64_t head_seq_ = 0;
    bool base_has_block_ = false;  // a block was accepted up to base_seq_
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
