#pragma once

#include "proto/frame.h"
#include "proto/stream_message.h"
#include "server/jobs/job_service.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>

namespace modelsynth::server {

// Makes the binary frames of all streams. A frame that several clients are being sent is made once
// and shared, and is kept as long as one of them needs it. Thread-safe; calls block.
class FrameSource {
  public:
    explicit FrameSource(JobService& service) : service_(service) {}

    using FramePointer = std::shared_ptr<const proto::Frame>;

    // What an accepted block changed; nothing when that is not kept any more.
    // Requires: `partial` is not kNone, here and below.
    [[nodiscard]] FramePointer block_frame(
        const std::string& job_id, std::uint64_t seq, proto::Partial partial
    );

    enum class WholeIf : std::uint8_t { kAny, kAnyBlock };

    // A whole state that includes everything up to `seq`; its own seq may be later. Nothing when
    // there is none yet, or when no block was accepted and the condition asks for one.
    [[nodiscard]] FramePointer whole_frame(
        const std::string& job_id, std::uint64_t seq, proto::Partial partial, WholeIf condition
    );

  private:
    struct Made {
        FramePointer frame;
        bool any_block = true;
    };

    using Key = std::tuple<std::string, proto::FrameKind, std::uint64_t>;

    [[nodiscard]] std::shared_ptr<const Made> find(const Key& key);
    // Gives the one that another thread was quicker to make, if there is one.
    [[nodiscard]] std::shared_ptr<const Made> share(const Key& key, Made made);

    JobService& service_;
    std::mutex mutex_;
    std::map<Key, std::weak_ptr<const Made>> made_;
    std::size_t sweep_at_ = 256;  // entries; then those that nobody needs are removed
};

}  // namespace modelsynth::server
