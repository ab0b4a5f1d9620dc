#include "server/log/event_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

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

// The character that the text begins with, and how many bytes it has; what is no UTF-8 counts as
// U+FFFD, byte by byte.
struct CodePoint {
    std::uint32_t value = 0xfffd;
    std::size_t byte_count = 1;
};

CodePoint first_code_point(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    const std::size_t count = lead < 0x80             ? 1
                              : (lead & 0xe0) == 0xc0 ? 2
                              : (lead & 0xf0) == 0xe0 ? 3
                              : (lead & 0xf8) == 0xf0 ? 4
                                                      : 0;
    if (count == 0 || count > text.size()) {
        return {};
    }
    if (count == 1) {
        return {lead, 1};
    }
    std::uint32_t value = lead & (0x7fU >> count);
    for (std::size_t i = 1; i < count; ++i) {
        if ((byte(i) & 0xc0) != 0x80) {
            return {};
        }
        value = (value << 6) | (byte(i) & 0x3f);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = value >= 0xd800 && value < 0xe000;
    if (value < kLeast[count] || value > 0x10ffff || is_surrogate) {
        return {};
    }
    return {value, count};
}

void append_escape(std::string& out, std::uint32_t value) {
    auto end = std::back_inserter(out);
    if (value >= 0x10000) {
        value -= 0x10000;
        fmt::format_to(end, "\\u{:04x}\\u{:04x}", 0xd800 + (value >> 10), 0xdc00 + (value & 0x3ff));
    } else {
        fmt::format_to(end, "\\u{:04x}", value);
    }
}

// Inside the quotes of a JSON string.
std::string escaped(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const CodePoint point = first_code_point(text);
        if (point.value == '"' || point.value == '\\') {
            out += '\\';
            out += static_cast<char>(point.value);
        } else if (point.value == '\n') {
            out += "\\n";
        } else if (point.value >= 0x20 && point.value < 0x7f) {
            out += static_cast<char>(point.value);
        } else {
            append_escape(out, point.value);
        }
        text.remove_prefix(point.byte_count);
    }
    return out;
}

std::string quoted(std::string_view text) { return '"' + escaped(text) + '"'; }

// Of the escape that the text begins with; 0 when it is none of escaped().
std::size_t escape_length(std::string_view text) {
    if (text.size() >= 2 && std::string_view("\"\\n").find(text[1]) != std::string_view::npos) {
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
    std::string out;
    while (!text.empty()) {
        const CodePoint point = first_code_point(text);
        if (point.value >= 0x20 && point.value < 0x7f) {
            out += static_cast<char>(point.value);
        } else {
            append_escape(out, point.value);
        }
        text.remove_prefix(point.byte_count);
    }
    return out;
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
