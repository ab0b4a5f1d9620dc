#pragma once

#include <cstdint>
#include <string_view>

namespace modelsynth::server {

// What the front tells whoever counts. Calls come from any thread and must not block.
class HttpObserver {
  public:
    // A request that was answered. All texts are of a bounded set.
    struct Answer {
        std::string_view route;   // the template, as /v1/jobs/{id}; "none" when there is none
        std::string_view method;  // "other" for all that no route has
        int status = 0;
        std::uint64_t bytes = 0;   // head and body; of a WebSocket none
        double seconds = 0;        // from the first byte of the request to the last of the answer
        bool is_stream = false;    // lasts as long as a job
        std::string_view problem;  // the name of the problem, when it is one
    };

    virtual ~HttpObserver() = default;

    virtual void on_answer(const Answer& /*answer*/) {}

    // Connections came (1) or went (-1), of all kinds and WebSockets among them.
    virtual void on_connections(int /*change*/) {}

    virtual void on_websockets(int /*change*/) {}

    // A connection that was one too many: "connections" or "connections-of-address".
    virtual void on_connection_refused(std::string_view /*reason*/) {}

    // What a listener was spared: events for a snapshot ("slow-reader"), a frame for a whole state
    // ("frame-not-kept").
    virtual void on_events_dropped(std::string_view /*reason*/, std::uint64_t /*count*/) {}
};

}  // namespace modelsynth::server
