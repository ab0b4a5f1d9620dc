#pragma once

#include <spdlog/logger.h>

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace modelsynth::server {

// A field of a line: a name of lower-case letters and underscores, and a value, which may be
// anything.
struct LogField {
    LogField(const char* field_name, std::string_view text);
    LogField(const char* field_name, double number);

    LogField(const char* field_name, std::integral auto number)
        : name(field_name), value(std::to_string(number)) {}

    const char* name;
    std::string value;  // as it stands in a line; empty: nothing to tell, the field is left out
};

// The event and its fields in one line of printable ASCII: name=value, values in quotes and with
// JSON's escapes where they need them. Requires: no '=' in `event`.
[[nodiscard]] std::string event_line(
    std::string_view event, std::initializer_list<LogField> fields
);

// The members of a JSON object that says the same as a line of event_line(); any other text is its
// member `event` as a whole.
[[nodiscard]] std::string json_members_of(std::string_view line);

// The text with everything that is not printable ASCII escaped.
[[nodiscard]] std::string printable(std::string_view text);

// Logs event_line(), which is not made when nobody wants it.
void log_event(
    spdlog::logger& log,
    spdlog::level::level_enum level,
    std::string_view event,
    std::initializer_list<LogField> fields
);

}  // namespace modelsynth::server
