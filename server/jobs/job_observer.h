#pragma once

#include <string_view>

namespace modelsynth::server {

// What is told of jobs to whoever counts. Calls come from any thread and must not block. All texts
// are of a bounded set.
class JobObserver {
  public:
    virtual ~JobObserver() = default;

    // A job was handed to a worker for the first time.
    virtual void on_started(double /*waited_seconds*/) {}

    // A block that was not logged before. `example`: the name of a built-in one, "uploaded" or
    // "inline".
    virtual void on_block(std::string_view /*example*/, bool /*accepted*/) {}

    // A job has ended: `result` is the state it is in. `seconds`: how long it was worked on, 0 when
    // it never was.
    virtual void on_ended(
        std::string_view /*solver*/, std::string_view /*result*/, double /*seconds*/
    ) {}
};

}  // namespace modelsynth::server
