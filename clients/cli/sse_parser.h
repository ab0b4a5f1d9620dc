#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::cli {

// One event of a stream of Server-Sent Events.
struct SseEvent {
    std::string type = "message";
    std::string data;
    std::string last_event_id;  // the newest id of the stream so far

    friend bool operator==(const SseEvent&, const SseEvent&) = default;
};

// Reads a stream of Server-Sent Events piece by piece (WHATWG HTML, 9.2.6 "Interpreting an event
// stream"): any cut of the bytes gives the same events. An event that the stream ends within is
// not given; each connection takes a parser of its own.
//
//     SseParser parser;
//     parser.feed("id: 7\ndata: a\n\n")  ==  {{"message", "a", "7"}}
class SseParser {
  public:
    // Events of more bytes are refused.
    explicit SseParser(std::size_t event_bytes_max = std::size_t{256} << 20)
        : event_bytes_max_(event_bytes_max) {}

    // The events that these bytes complete; nothing once a line or an event was too long.
    [[nodiscard]] std::optional<std::vector<SseEvent>> feed(std::string_view bytes);

  private:
    void end_line(std::vector<SseEvent>& events);
    void take_field(std::string_view name, std::string_view value);
    void dispatch(std::vector<SseEvent>& events);

    std::size_t event_bytes_max_;
    std::string line_;
    std::string type_;
    std::string data_;
    std::string last_event_id_;
    bool is_first_line_ = true;
    bool has_carriage_return_ = false;  // the last byte; a line feed would belong to it
    bool is_too_long_ = false;
};

}  // namespace modelsynth::cli
