#pragma once

#include "solver/discrete/example.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>

// Examples for the plane from square tiles whose edges have to match.
namespace modelsynth::bench {

// An edge is a text that stands for what crosses it, read clockwise round the tile: the tile on the
// other side has the same text backwards.
struct Tile {
    std::string name;
    std::array<std::string, 4> edges;  // north, east, south, west
    double weight = 1;                 // of each of its variants
};

// Which images of a tile may stand in a model.
enum class Variants : std::uint8_t { kAsDrawn, kTurned, kTurnedAndMirrored };

// A piece for every tile and every variant that looks different by its edges, and the pairs whose
// edges match along x and z; models are one cell high.
[[nodiscard]] discrete::Example make_tile_example(
    const std::string& name, std::span<const Tile> tiles, Variants variants
);

}  // namespace modelsynth::bench
