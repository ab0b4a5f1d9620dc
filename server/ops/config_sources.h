#pragma once

#include "server/ops/config_file.h"

#include <CLI/App.hpp>

#include <optional>
#include <string>
#include <vector>

// Where the values of options come from besides the command line, which must have been parsed. What
// is wrong goes to `faults` with its place, and the option stays as it was.

namespace modelsynth::server {

// Whether the option is one of the configuration, and not a question about it.
[[nodiscard]] bool is_setting(const CLI::Option& option);

// Whether it takes several values.
[[nodiscard]] bool is_list(const CLI::Option& option);

// The value of a variable; one that is empty counts as not set.
[[nodiscard]] std::optional<std::string> environment(const std::string& variable);

// Sets from the environment what the command line does not.
void take_environment(CLI::App& app, std::vector<ConfigFault>& faults);

// Sets from the file what neither the command line nor the environment does.
void take_file(CLI::App& app, const std::string& path, std::vector<ConfigFault>& faults);

}  // namespace modelsynth::server
