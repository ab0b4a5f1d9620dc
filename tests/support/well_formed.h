#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace modelsynth::testing {

// Elements opened and closed in order, attributes quoted, nothing but known entities.
inline bool is_well_formed(const std::string& xml) {
    std::vector<std::string> open;
    std::size_t roots = 0;
    for (std::size_t i = 0; i < xml.size(); ++i) {
        if (xml[i] == '&') {
            const std::string entity = xml.substr(i, xml.find(';', i) - i);
            if (entity != "&amp" && entity != "&lt" && entity != "&gt") {
                return false;
            }
        }
        if (xml[i] != '<') {
            continue;
        }
        const std::size_t end = xml.find('>', i);
        if (end == std::string::npos) {
            return false;
        }
        const std::string tag = xml.substr(i + 1, end - i - 1);
        if (tag.find('<') != std::string::npos ||
            std::count(tag.begin(), tag.end(), '"') % 2 != 0) {
            return false;
        }
        const std::string name = tag.substr(0, tag.find_first_of(" /"));
        if (tag[0] == '/') {
            if (open.empty() || open.back() != tag.substr(1)) {
                return false;
            }
            open.pop_back();
        } else if (tag.back() != '/') {
            roots += std::size_t{open.empty()};
            open.push_back(name);
        }
        i = end;
    }
    return open.empty() && roots == 1;
}

}  // namespace modelsynth::testing
