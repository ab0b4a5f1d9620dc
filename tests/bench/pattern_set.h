#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/example.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Examples for the plane from the small windows of an image, which overlap in the model.
namespace modelsynth::bench {

// Rows of one length from north to south, a character a pixel.
using Image = std::vector<std::string>;

struct PatternOptions {
    std::int32_t window = 3;     // pixels along a side of a pattern
    bool has_symmetries = true;  // patterns turned and mirrored are patterns, too
    bool is_toroidal = false;    // windows reach across the sides of the sample
};

// The distinct windows of a sample, in the order in which they are met first.
struct PatternSet {
    std::int32_t window = 3;
    std::vector<std::string> patterns;  // the pixels row by row
    std::vector<std::uint32_t> counts;  // how often each was met
};

// Requires: a sample that is as large as a window.
[[nodiscard]] PatternSet find_patterns(const Image& sample, const PatternOptions& options);

// A piece for every pattern, weighted by how often it was met. Patterns are neighbours along x and
// z when they agree where they overlap, a pixel apart; models are one cell high.
[[nodiscard]] discrete::Example make_pattern_example(
    const std::string& name, const PatternSet& set
);

// The image that a model of patterns shows: all windows of it, and so window - 1 pixels wider and
// deeper than the model.
[[nodiscard]] Image read_image(
    const PatternSet& set, const GridSize& size, std::span<const Label> labels
);

}  // namespace modelsynth::bench
