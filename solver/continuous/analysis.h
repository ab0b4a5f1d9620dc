#pragma once

#include <array>
#include <cstddef>
#include <optional>
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

    // What stands around a point, by the number of its label.
    struct Figure {
        struct Part {
            std::string object;
            // Where the object stands, of half-spaces h1 ... hm of families 0 ... m - 1; nothing
            // where that is too long to be written. See expressions.h.
            std::optional<std::string> expression;
        };

        int rank = 0;  // 3: a corner, 2: an edge, 1: a face, 0: the inside of an object
        std::vector<std::size_t> families;  // across whose planes it changes, ascending
        std::vector<Part> parts;            // by object, empty space left out
    };

    static constexpr std::size_t kFiguresListedMax = 1024;

    std::vector<Family> families;
    std::size_t figures = 0;            // labels
    std::size_t corner_figures = 0;     // of those, corners of something
    std::vector<Figure> figure_list;    // the first kFiguresListedMax
    std::vector<std::string> warnings;  // one sentence each
};

// Cost: that of a small problem, some milliseconds; where figures have very many planes some tenths
//       of a second. Thread-safe.
[[nodiscard]] Analysis analyse(const ExampleReading& reading);

}  // namespace modelsynth::continuous
