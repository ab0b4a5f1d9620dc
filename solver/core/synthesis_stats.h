#pragma once

#include "solver/core/order.h"
#include "solver/core/search_tally.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth {

// What is told of a finished synthesis.
struct SynthesisStats {
    SearchTally blocks;
    // Share of sites whose label differs from the model that the synthesis started from; 1 where
    // there was none, or one as varied as any.
    double changed = 0;
    // Where it was chosen by trial; none where it was told.
    std::optional<Order> order = std::nullopt;
    // Where something is to be made small: what it came to, ...
    std::optional<double> objective = std::nullopt;
    // ... and in each of the models that the best was chosen from; nothing for one that failed.
    std::vector<std::optional<double>> candidates = {};
    // Of the surface, where the model is made of polygons.
    std::optional<std::size_t> polygons = std::nullopt;
    // What of the request could not be had, one sentence each; those that the observer was told
    // come first.
    std::vector<std::string> warnings = {};
};

}  // namespace modelsynth
