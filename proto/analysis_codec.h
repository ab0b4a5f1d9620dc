#pragma once

#include "solver/registry/task.h"

#include <optional>
#include <string>

namespace modelsynth::proto {

// The resource /v1/examples/{id}/analysis.
//
// Its `splitting` tells how pieces can be told apart so that models never come to a dead end (see
// label_splitting.h), null where that was not found with little work or is not needed:
//   labels  how many there are then
//   method  "rules": all models are kept that can go on beyond their far sides; "cells": pieces
//           stand as they do in the example, and models may be lost
//   proof   "equation_3_11" or "region"
//   split   [{ "piece", "into" }]: the pieces that several labels stand for, and how many
//   lost    the pieces that stand in no such model
[[nodiscard]] std::string analysis_json(
    const Example& example, const std::string& id, const Analysis& analysis
);

// The resource /v1/examples/{id}/success.svg; nothing where there is no such curve.
[[nodiscard]] std::optional<std::string> success_drawing(
    const Example& example, const Analysis& analysis
);

}  // namespace modelsynth::proto
