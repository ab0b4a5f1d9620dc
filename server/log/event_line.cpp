#include "server/log/event_line.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace modelsynth::server {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Characters that need no quotes in a value.
bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) ||
           std::string_view("_-+./:{}@,").find(c) != std::string_view::npos;
}

// As JSON has them (RFC 8259, section 6).
bool is_number(std::string_view text) {
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t begin = i;
        while (i < text.size() && is_digit(text[i])) {
            ++i;
        }
        return i > begin;
    };
    i += text.starts_with('-') ? 1U : 0U;
    const bool has_leading_zero = i + 1 < text.size() && text[i] == '0' && is_digit(text[i + 1]);
    if (has_leading_zero || !digits()) {
        return false;
    }
    if (i < text.size() && text[i] == '.') {
        ++i;
        if (!digits()) {
            return false;
        }
    }
    if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
        ++i;
        i += i < text.size() && (text[i] == '+' || text[i] == '-') ? 1U : 0U;
        if (!digits()) {
            return false;
        }
    }
    return i == text.size();
}

// As a JSON string, of ASCII alone; what is no UTF-8 becomes U+FFFD.
std::string quoted(std::string_view text) {
    using Json = nlohmann::json;
    return Json(text).dump(-1, ' ', true, Json::error_handler_t::replace);
}

// Of the escape that the text begins with; 0 when it is none of quoted().
std::size_t escape_length(std::string_view text) {
    if (text.size() >= 2 && std::string_view("\"\\bfnrt").find(text[1]) != std::string_view::npos) {
        return 2;
    }
    const bool is_code =
        text.size() >= 6 && text[1] == 'u' &&
        text.substr(2, 4).find_first_not_of("0123456789abcdef") == std::string_view::npos;
    return is_code ? 6 : 0;
}

// Where the name=value at the beginning of the text ends, and its parts; false when there is none.
struct ReadField {
    std::string_view name;
    std::string_view value;
    std::size_t end = 0;
};

bool read_field(std::string_view text, ReadField& field) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0) {
        return false;
    }
    field.name = text.substr(0, equals);
    const bool is_name = std::all_of(field.name.begin(), field.name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || c == '_';
    });
    std::size_t end = equals + 1;
    if (end < text.size() && text[end] == '"') {
        ++end;
        while (end < text.size() && text[end] != '"') {
            const std::size_t length = text[end] == '\\' ? escape_length(text.substr(end)) : 1;
            if (length == 0) {
                return false;
            }
            end += length;
        }
        if (end == text.size()) {
            return false;
        }
        ++end;
    } else {
        while (end < text.size() && is_plain(text[end])) {
            ++end;
        }
    }
    field.value = text.substr(equals + 1, end - equals - 1);
    field.end = end;
    return is_name && !field.value.empty() && (end == text.size() || text[end] == ' ');
}

}  // namespace

LogField::LogField(const char* field_name, std::string_view text) : name(field_name) {
    const bool needs_quotes = is_number(text) || !std::all_of(text.begin(), text.end(), is_plain);
    value = needs_quotes ? quoted(text) : std::string(text);
}

LogField::LogField(const char* field_name, double number)
    : name(field_name), value(std::isfinite(number) ? fmt::format("{:.6g}", number) : "") {}

std::string event_line(std::string_view event, std::initializer_list<LogField> fields) {
    std::string line(event);
    for (const LogField& field : fields) {
        if (!field.value.empty()) {
            line += ' ';
            line += field.name;
            line += '=';
            line += field.value;
        }
    }
    return line;
}

std::string json_members_of(std::string_view line) {
    const std::string whole = "\"event\":" + quoted(line);
    // The event is what stands before the first name=; there is a space before that.
    const std::size_t space = line.rfind(' ', line.find('='));
    if (line.find('=') == std::string_view::npos || space == std::string_view::npos) {
        return whole;
    }
    std::string members = "\"event\":" + quoted(line.substr(0, space));
    std::string_view rest = line.substr(space);
    while (!rest.empty()) {
        ReadField field;
        if (rest.front() != ' ' || !read_field(rest.substr(1), field)) {
            return whole;
        }
        const bool is_json = field.value.front() == '"' || is_number(field.value);
        members += ",\"" + std::string(field.name) + "\":";
        members += is_json ? std::string(field.value) : quoted(field.value);
        rest.remove_prefix(1 + field.end);
    }
    // A quoted value is copied, which is right only when event_line() has escaped it.
    const bool is_ours =
        std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; });
    return is_ours ? members : whole;
}

std::string printable(std::string_view text) {
    const bool is_printable =
        std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (is_printable) {
        return std::string(text);
    }
    const std::string literal = quoted(text);
    return literal.substr(1, literal.size() - 2);
}

void log_event(
    spdlog::logger& log,
    spdlog::level::level_enum level,
    std::string_view event,
    std::initializer_list<LogField> fields
) {
    if (log.should_log(level)) {
        log.log(level, spdlog::string_view_t(event_line(event, fields)));
    }
}

}  // namespace modelsynth::server
