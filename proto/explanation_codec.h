#pragma once

#include "proto/json.h"

#include <any>

namespace modelsynth::proto {

// Adds what an error tells beyond its sentence as extension members of a problem document:
// `conflict` for a contradiction, `hottest` for a search that gave up. Nothing for nothing, and for
// what no solver gives. No text is longer for a larger model.
void add_explanation(OrderedJson& document, const std::any& explanation);

}  // namespace modelsynth::proto
