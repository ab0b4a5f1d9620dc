#include "server/ops/config_sources.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace modelsynth::server {

namespace {

std::string variable_of(const std::string& option_name) {
    std::string name = "MODELSYNTH_" + option_name;
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        return c == '-' ? '_' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
    });
    return name;
}

std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

void set(
    CLI::Option& option,
    const std::vector<std::string>& values,
    const std::string& place,
    std::vector<ConfigFault>& faults
) {
    try {
        for (const std::string& value : values) {
            option.add_result(value);
        }
        option.run_callback();
    } catch (const CLI::Error& error) {
        option.clear();
        faults.push_back({place, error.what()});
    }
}

std::optional<std::string> read_file(const std::string& path, std::vector<ConfigFault>& faults) {
    constexpr std::streamsize kBytesMax = 1 << 20;
    std::ifstream file(path, std::ios::binary);
    std::string text;
    text.resize(kBytesMax + 1);
    file.read(text.data(), kBytesMax + 1);
    if (!file.is_open() || file.bad() || (file.gcount() == 0 && !file.eof())) {
        faults.push_back({path, "the file cannot be read"});
        return std::nullopt;
    }
    if (file.gcount() > kBytesMax) {
        faults.push_back({path, "the file has more than 1 MiB"});
        return std::nullopt;
    }
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

}  // namespace

bool is_setting(const CLI::Option& option) {
    const std::string name = option.get_single_name();
    return name != "help" && name != "version" && name != "config" && name != "check-config" &&
           name != "print-config";
}

bool is_list(const CLI::Option& option) { return option.get_items_expected_max() > 1; }

std::optional<std::string> environment(const std::string& variable) {
    const char* value = std::getenv(variable.c_str());
    return value == nullptr || *value == '\0' ? std::nullopt : std::optional<std::string>(value);
}

void take_environment(CLI::App& app, std::vector<ConfigFault>& faults) {
    for (CLI::Option* option : app.get_options()) {
        const std::string variable = variable_of(option->get_single_name());
        const auto text = environment(variable);
        if (text && is_setting(*option) && option->empty()) {
            const auto values =
                is_list(*option) ? split_at_commas(*text) : std::vector<std::string>{*text};
            set(*option, values, variable, faults);
        }
    }
}

void take_file(CLI::App& app, const std::string& path, std::vector<ConfigFault>& faults) {
    const auto text = read_file(path, faults);
    if (!text) {
        return;
    }
    std::vector<const CLI::Option*> set_before;
    for (const CLI::Option* option : app.get_options()) {
        if (!option->empty()) {
            set_before.push_back(option);
        }
    }
    std::vector<std::pair<CLI::Option*, ConfigLine>> found;
    for (ConfigLine& line : parse_config_file(*text, path, faults)) {
        const std::string place = path + ":" + std::to_string(line.number);
        CLI::Option* option = app.get_option_no_throw("--" + line.name);
        if (option == nullptr || !is_setting(*option)) {
            faults.push_back({place, "there is no option " + line.name.substr(0, 64)});
            continue;
        }
        const auto same = std::find_if(found.begin(), found.end(), [option](const auto& known) {
            return known.first == option;
        });
        if (same == found.end()) {
            found.emplace_back(option, std::move(line));
        } else if (is_list(*option)) {
            auto& values = same->second.values;
            values.insert(values.end(), line.values.begin(), line.values.end());
        } else {
            faults.push_back({place, line.name + " stands here a second time"});
        }
    }
    for (auto& [option, line] : found) {
        const std::string place = path + ":" + std::to_string(line.number);
        if (!is_list(*option) && line.values.size() != 1) {
            faults.push_back({place, line.name + " takes one value"});
        } else if (std::count(set_before.begin(), set_before.end(), option) == 0) {
            set(*option, line.values, place, faults);
        }
    }
}

}  // namespace modelsynth::server
