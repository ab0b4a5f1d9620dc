#pragma once

#include "solver/continuous/example.h"
#include "solver/core/result.h"
#include "solver/mesh/glb_scene.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// What the extras of a file or scene say of an example:
//     {"spacing": 1, "size": [20, 8, 20], "density": 0.3,
//      "bounds": {"min": [0, 0, 0], "max": [6, 4, 6]},
//      "dimensions": [{"object": "door", "normal": [1, 0, 0]}]}
// Each may be left out; others are left alone, since programs write their own.
struct ImportSettings {
    std::optional<double> spacing;
    std::optional<std::array<double, 3>> size;
    std::optional<double> density;
    std::optional<Bounds> bounds;

    struct NamedDimension {
        std::string object;
        Point normal = Point::UnitY();
        std::string pointer;  // where it was said
    };

    std::vector<NamedDimension> dimensions;
};

// Reads extras over what `settings` has, and adds what is wrong to `faults`, with pointers that
// begin with `pointer`. Thread-safe.
void read_import_settings(
    const Extra& extras,
    const std::string& pointer,
    ImportSettings& settings,
    std::vector<Fault>& faults
);

}  // namespace modelsynth::continuous
