#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// The form of configuration files: lines of `name = value`, which is what TOML and INI files of
// plain settings have in common.
//
//   # a comment, also after a value
//   listen = "127.0.0.1:8080"                  or without quotes, up to white space
//   allow-origin = ["https://a.example", "https://b.example"]     or in one line each

namespace modelsynth::server {

struct ConfigLine {
    std::string name;
    std::vector<std::string> values;
    std::size_t number = 0;  // of the line, from 1
};

// What is wrong, and where: a line of a file, a variable, an option.
struct ConfigFault {
    std::string place;
    std::string detail;
};

// The lines of a text; what cannot be read as one goes to `faults`, placed at `path` and its
// number.
[[nodiscard]] std::vector<ConfigLine> parse_config_file(
    std::string_view text, const std::string& path, std::vector<ConfigFault>& faults
);

// A line that parse_config_file() reads as this again, with its end.
[[nodiscard]] std::string config_file_line(
    const std::string& name, const std::vector<std::string>& values, bool is_list
);

}  // namespace modelsynth::server
