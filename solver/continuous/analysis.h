#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace modelsynth::continuous {

class ExampleReading;

// What can be said of an example before anything is made of it.
struct Analysis {
    struct Family {
        std::array<double, 3> normal = {};
        double spacing = 0;  // metres, at the example's default spacing
    };

    std::vector<Family> families;
    std::size_t figures = 0;            // labels
    std::size_t corner_figures = 0;     // of those, corners of something
    std::vector<std::string> warnings;  // one sentence each
};

// Cost: that of a small problem, some milliseconds. Thread-safe.
[[nodiscard]] Analysis analyse(const ExampleReading& reading);

}  // namespace modelsynth::continuous
