#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/core/block_schedule.h"
#include "solver/core/grid.h"
#include "solver/core/result.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// Across a direction planes are asked for so far apart, ...
struct FamilySpacing {
    std::array<double, 3> normal = {0, 1, 0};  // need not be of unit length
    double spacing = 1;                        // metres

    friend bool operator==(const FamilySpacing&, const FamilySpacing&) = default;
};

// ... or one by one: { p : n . p = offset }, n the normal at unit length. In any order; those that
// are one plane, or outside of the model, do not matter.
struct FamilyOffsets {
    std::array<double, 3> normal = {0, 1, 0};
    std::vector<double> offsets;  // metres

    friend bool operator==(const FamilyOffsets&, const FamilyOffsets&) = default;
};

// In which ways an example is read besides as it stands: as many turns about the upright axis as
// make a whole one, and mirrored across x or z; what these are together, too.
struct Variants {
    std::uint8_t turns = 1;  // 1, 2 or 4
    bool mirror_x = false;
    bool mirror_z = false;

    friend bool operator==(const Variants&, const Variants&) = default;
};

// What stands at a side of a model's box.
enum class SideKind : std::uint8_t {
    kClosed,  // empty space, or bare ground: the model ends within
    kFree,    // anything: the model goes on beyond, and is cut off there
};

// Twice the attempts of blocks of cells, which have other means than to try again: of plumbing, 5
// of 180 blocks are given up with eight, 5 of 720 with so many.
inline constexpr Blocks kDefaultBlocks = {{}, 16};

// What a continuous synthesis can be asked for; plain data.
struct Parameters {
    std::optional<std::array<double, 3>> size;  // metres; none: the example's default
    std::optional<double> spacing;              // metres; none: the example's
    // Families that are not spaced as follows from `spacing` and the example; each but once in
    // both lists.
    std::vector<FamilySpacing> spacings;
    std::vector<FamilyOffsets> offsets;
    // In spacings. None: chosen to suit the size; a value without blocks: the whole at once.
    std::optional<std::optional<Blocks>> blocks;
    Variants variants;
    // Degrees, 0 ... kNudgeMax: by how much faces may be turned so that spacings fit; see nudge().
    double nudge = 0;
    // Side 2 * axis at the smaller end of the axis, 2 * axis + 1 at the larger one.
    std::array<SideKind, 6> boundary = {};
    // 0 ... kJitterMax: by what share of their spacing planes are moved, where no figure needs
    // planes of more than three directions, and nothing has to be so wide across them.
    double jitter = 0;
    // 0 ... kPerturbationMax: by what share of the least distance of planes faces are moved once
    // the model is made; see perturb().
    double perturbation = 0;
    // 0 ... 1: how full the model is to be. What is empty space or bare ground has the weight
    // density^-2 against all else. None: the example's.
    std::optional<double> density;
    // Weights of figures by the object types in them; those not named have the example's.
    std::vector<std::pair<std::string, double>> weights;
    // None: the example's. Of a kind that none of them is of, those of the example hold, too; no
    // constraint at all: none whatever.
    std::optional<std::vector<Constraint>> constraints;

    friend bool operator==(const Parameters&, const Parameters&) = default;
};

inline constexpr double kNudgeMax = 15;
inline constexpr double kJitterMax = 0.5;
inline constexpr double kPerturbationMax = 0.3;
inline constexpr std::int32_t kCellsAlongMax = 4096;
inline constexpr std::size_t kOffsetsMax = 4096;  // of one family

struct Example;

// The parameters with every default filled in from the example.
[[nodiscard]] Parameters fill_defaults(Parameters parameters, const Example& example);

// The model's size in spacings, cut ones counted whole. Requires: defaults filled in.
[[nodiscard]] GridSize cells_of(const Parameters& parameters);

}  // namespace modelsynth::continuous
