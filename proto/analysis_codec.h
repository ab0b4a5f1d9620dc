#pragma once

#include "solver/registry/task.h"

#include <cstddef>
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
//
// Of solids its `figure_list` tells what stands around a point, for as many of the `labels` as
// `figures_listed` says, by number:
//   rank         3 at a corner, 2 on an edge, 1 on a face, 0 inside an object or empty space
//   objects      that stand there
//   expressions  where each of them stands, of half-spaces h1, h2, ...: what lies below planes of
//                families[0], families[1], ...; null where that is too long
//   families     indices of those across whose planes it changes
[[nodiscard]] std::string analysis_json(
    const Example& example, const std::string& id, const Analysis& analysis
);

// The resource /v1/examples/{id}/success.svg; nothing where there is no such curve.
[[nodiscard]] std::optional<std::string> success_drawing(
    const Example& example, const Analysis& analysis
);

// How many figures an example of solids has; nothing for others.
[[nodiscard]] std::optional<std::size_t> figure_count(const Example& example);

// The resource /v1/examples/{id}/figures.svg: the figure of a number, or as many as a sheet holds.
// Requires: an example of solids; there is one of that number (checked).
[[nodiscard]] std::string figure_drawing(const Example& example, std::optional<std::size_t> number);

}  // namespace modelsynth::proto
