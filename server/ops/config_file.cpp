#include "server/ops/config_file.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace modelsynth::server {

namespace {

constexpr std::string_view kSpace = " \t\r";

void skip_space(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
}

bool is_end(std::string_view text) {
    return text.empty() || text.front() == '#' || text.front() == ';';
}

// Takes a value off the text: "..." with \" and \\, '...', or anything up to one of `ends`.
std::optional<std::string> take_value(std::string_view& text, std::string_view ends) {
    std::string value;
    const char quote = text.front();
    if (quote != '"' && quote != '\'') {
        value = text.substr(0, text.find_first_of(ends));
        text.remove_prefix(value.size());
        return value.empty() ? std::nullopt : std::optional(std::move(value));
    }
    for (std::size_t i = 1; i < text.size(); ++i) {
        if (text[i] == quote) {
            text.remove_prefix(i + 1);
            return value;
        }
        if (text[i] == '\\' && quote == '"') {
            ++i;
            if (i == text.size() || (text[i] != '"' && text[i] != '\\')) {
                return std::nullopt;
            }
        }
        value += text[i];
    }
    return std::nullopt;
}

// What is wrong with the value that the text is, or null.
const char* read_values(std::string_view text, std::vector<std::string>& values) {
    const bool is_list = text.front() == '[';
    const std::string_view ends = is_list ? ",] \t\r" : " \t\r";
    if (is_list) {
        text.remove_prefix(1);
        skip_space(text);
    }
    bool goes_on = !is_list || !text.starts_with(']');
    while (goes_on) {
        auto value = text.empty() ? std::nullopt : take_value(text, ends);
        if (!value) {
            return "a value is neither plain nor in quotes that close; within \"\" there may be "
                   "\\\" "
                   "and \\\\";
        }
        values.push_back(std::move(*value));
        skip_space(text);
        goes_on = is_list && text.starts_with(',');
        if (goes_on) {
            text.remove_prefix(1);
            skip_space(text);
        }
    }
    if (is_list) {
        if (!text.starts_with(']')) {
            return "a list must end in ] on the same line";
        }
        text.remove_prefix(1);
        skip_space(text);
    }
    return is_end(text) ? nullptr : "there is more after the value; quotes hold words together";
}

// What is wrong with the line, or null.
const char* read_line(std::string_view text, ConfigLine& line) {
    if (text.front() == '[') {
        return "there are no sections here";
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
        return "a line must be name = value";
    }
    line.name = text.substr(0, equals);
    line.name.erase(line.name.find_last_not_of(kSpace) + 1);
    text.remove_prefix(equals + 1);
    skip_space(text);
    return is_end(text) ? "the value is missing" : read_values(text, line.values);
}

}  // namespace

std::vector<ConfigLine> parse_config_file(
    std::string_view text, const std::string& path, std::vector<ConfigFault>& faults
) {
    std::vector<ConfigLine> lines;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        std::string_view rest = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        skip_space(rest);
        if (is_end(rest)) {
            continue;
        }
        ConfigLine line;
        line.number = number;
        if (const char* wrong = read_line(rest, line)) {
            faults.push_back({path + ":" + std::to_string(number), wrong});
        } else {
            lines.push_back(std::move(line));
        }
    }
    return lines;
}

std::string config_file_line(
    const std::string& name, const std::vector<std::string>& values, bool is_list
) {
    std::string text;
    for (const std::string& value : values) {
        text += text.empty() ? "\"" : ", \"";
        for (const char c : value) {
            text += c == '"' || c == '\\' ? "\\" : "";
            text += c;
        }
        text += '"';
    }
    return name + " = " + (is_list ? "[" + text + "]" : text) + "\n";
}

}  // namespace modelsynth::server
