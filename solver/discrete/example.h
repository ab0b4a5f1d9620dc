#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace modelsynth::discrete {

// A model piece: the thing a label stands for (thesis 2.3).
struct Piece {
    std::string name;
    // Which mesh of the kit draws it; none: nothing is drawn.
    std::optional<std::uint32_t> mesh;
    // Quarter turns of the mesh about the cell's vertical axis, counter-clockwise from above:
    // one turn takes east (+x) to north (-z).
    std::uint8_t quarter_turns = 0;
    // Multiplies how often the piece is chosen. >= 0; 0 removes the piece.
    double weight = 1;
};

// What may stand in the outermost layer of cells of a side.
enum class BoundaryKind : std::uint8_t {
    kFree,      // anything
    kExample,   // what stands in that layer of the example
    kPieces,    // the pieces listed
    kPeriodic,  // the side is joined to the opposite one
};

struct SideBoundary {
    BoundaryKind kind = BoundaryKind::kFree;
    std::vector<std::string> pieces = {};  // for kPieces
    bool is_list = true;  // the pieces were given as a list; a fault's pointer depends on it

    friend bool operator==(const SideBoundary&, const SideBoundary&) = default;
};

// Sides are numbered as the directions that lead out of them: east, west, top, bottom, south,
// north.
using Boundary = std::array<SideBoundary, kDirectionCount>;
inline constexpr std::array<const char*, kDirectionCount> kSideNames = {
    "east", "west", "top", "bottom", "south", "north"};

// How often a piece is chosen against the others that are possible.
enum class WeightRule : std::uint8_t {
    kUniform,  // each by its own weight
    kExample,  // each by its own weight times how often it stands in the example
};

// Two pieces that may be neighbours: `lower` at a cell, `upper` one cell on along the axis.
struct AdjacentPair {
    std::uint8_t axis = 0;  // 0 x, 1 y, 2 z
    Label lower = 0;
    Label upper = 0;

    friend bool operator==(const AdjacentPair&, const AdjacentPair&) = default;
};

// An example model E (thesis 3.1): labels on a grid, and what each label looks like.
// Invariants (examples from outside are checked on parsing): piece names are unique and not
// empty; cells.size() == size.cell_count(); every cell names a piece; 1 ... kLabelCountMax pieces.
struct Example {
    std::string name;
    std::array<double, 3> cell = {1, 1, 1};  // metres along x, y, z
    std::vector<Piece> pieces;
    GridSize size;             // 0 cells where only `adjacency` says who may be neighbours
    std::vector<Label> cells;  // x fastest, then z, then y
    std::vector<AdjacentPair> adjacency;
    std::optional<Label> empty;
    Boundary boundary;
    // What a job gets that does not ask. Labels alone, of which ground and air are most, give
    // livelier models when they count alike.
    WeightRule default_weights = WeightRule::kUniform;
    GridSize default_size = {40, 10, 40};
    std::shared_ptr<const Kit> kit = std::make_shared<Kit>();
};

}  // namespace modelsynth::discrete
