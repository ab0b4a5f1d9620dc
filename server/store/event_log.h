#pragma once

#include "server/store/types.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace modelsynth::server {

// The ordered log of events of every job: gapless from 1, only what is on disk.
class EventLog {
  public:
    // Ends the subscription; once it has returned the callback does not run any more.
    class Subscription {
      public:
        virtual ~Subscription() = default;
    };

    virtual ~EventLog() = default;

    // The events after `after`, at most `limit`. Blocks. Fails: kNotFound.
    [[nodiscard]] virtual Stored<EventPage> read(
        const std::string& job_id, std::uint64_t after, std::size_t limit
    ) = 0;

    // Which commits a subscriber is told of: all that touched the job's log, or those alone after
    // which it stays as it is.
    enum class News : std::uint8_t { kAny, kEnd };

    // Calls `changed` after such commits, and when the job is erased; never two at once. A hint to
    // read, nothing more. It must not call into the store.
    [[nodiscard]] virtual std::unique_ptr<Subscription> subscribe(
        const std::string& job_id, News news, std::function<void()> changed
    ) = 0;
};

}  // namespace modelsynth::server
