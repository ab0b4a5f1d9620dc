#pragma once

#include "solver/discrete/example.h"
#include "tests/bench/pattern_set.h"

#include <memory>
#include <string>
#include <vector>

// Problems in the plane, of our own making: what is known as tiled and overlapping wave function
// collapse. About as constrained as the sets and samples that are commonly shown.
namespace modelsynth::bench {

// Tiles, from those that go together in any way to those that are hard to lay out.
[[nodiscard]] std::vector<std::shared_ptr<const discrete::Example>> make_planar_tilesets();

// A small picture to take patterns from.
struct PlanarSample {
    std::string name;
    Image image;
    PatternOptions options;
};

[[nodiscard]] std::vector<PlanarSample> make_planar_samples();

}  // namespace modelsynth::bench
