#pragma once

#include "solver/core/block_schedule.h"
#include "solver/core/grid.h"
#include "solver/core/masks.h"
#include "solver/core/order.h"
#include "solver/discrete/example.h"
#include "solver/discrete/scan_order.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::discrete {

// A list gives the weights of the pieces named; the others have weight 1.
using WeightList = std::vector<std::pair<std::string, double>>;
using Weights = std::variant<WeightRule, WeightList>;

using modelsynth::Blocks;
using modelsynth::Mask;
using modelsynth::Voxels;

// Where a constraint holds: in the cells of any of these, or everywhere when none is given.
struct Region {
    std::optional<Box> box = std::nullopt;
    std::vector<Cell> cells = {};
    std::optional<Mask> mask = std::nullopt;
    std::optional<Voxels> voxels = std::nullopt;

    friend bool operator==(const Region&, const Region&) = default;
};

// What a constraint asks of the pieces it names.
struct Fixed {  // only these pieces
    friend bool operator==(const Fixed&, const Fixed&) = default;
};

struct Forbidden {  // none of these pieces
    friend bool operator==(const Forbidden&, const Forbidden&) = default;
};

// Their weights are multiplied by this (thesis 3.5.3), by 1 + value * (weight - 1) where a mask or
// voxels give a value between 0 and 1; 0 removes them. >= 0.
struct Probability {
    double weight = 1;

    friend bool operator==(const Probability&, const Probability&) = default;
};

// So many of them all together.
struct Count {
    std::uint32_t min = 0;
    std::optional<std::uint32_t> max;

    friend bool operator==(const Count&, const Count&) = default;
};

// Any two of them at least so many steps along the axes apart. >= 1.
struct Separation {
    std::int32_t distance = 1;

    friend bool operator==(const Separation&, const Separation&) = default;
};

// No more of them in a straight line. >= 1.
struct MaxRun {
    std::int32_t max = 1;
    std::optional<std::uint8_t> axis;  // 0 x, 1 y, 2 z; none: along any

    friend bool operator==(const MaxRun&, const MaxRun&) = default;
};

// They hang together through the faces of their cells.
struct Connected {
    friend bool operator==(const Connected&, const Connected&) = default;
};

// They form no ring through the faces of their cells.
struct Acyclic {
    friend bool operator==(const Acyclic&, const Acyclic&) = default;
};

// They link two cells through the faces of theirs.
struct Path {
    Cell from;
    Cell to;

    friend bool operator==(const Path&, const Path&) = default;
};

// Pieces and their images, by name.
using NamePairs = std::vector<std::pair<std::string, std::string>>;

// Where a piece stands at a cell, its image stands at the cell's image (2007 paper, 4.1; thesis
// 3.5.2).
struct Symmetry {
    enum class Kind : std::uint8_t { kReflectX, kReflectZ, kHalfTurn, kQuarterTurn, kTranslate };

    Kind kind = Kind::kReflectX;  // a quarter turn: from the east to the north
    Cell translation = {};        // for kTranslate
    // Pieces and their images; see label_images() for those that are not named. None: found, see
    // likely_mirror().
    std::optional<NamePairs> mirror = std::nullopt;

    friend bool operator==(const Symmetry&, const Symmetry&) = default;
};

// Pieces are chosen so that the surroundings of each cell look like surroundings in the example
// (2007 paper, Eq. 2-6).
struct Resemblance {
    std::int32_t window = 1;     // w: the surroundings reach so many cells in every direction
    std::int32_t threshold = 0;  // how many more cells than in the best match may differ

    friend bool operator==(const Resemblance&, const Resemblance&) = default;
};

// What a model should be like, as a number: its error, or how much there is of something.
struct Term {
    enum class Kind : std::uint8_t {
        kDensity,        // share of the region's cells that hold one of the pieces
        kCount,          // how many cells of the region do
        kHeightProfile,  // the share on each floor of the region, against a profile
        kShape,          // share of the model's cells that hold one, or none, against the region
    };

    Kind kind = Kind::kDensity;
    double weight = 1;
    std::vector<std::string> pieces = {};         // empty: all but the empty piece
    std::optional<double> target = std::nullopt;  // of density and count; none: the more the better
    std::vector<double> profile = {};             // from the bottom up, stretched over the model

    friend bool operator==(const Term&, const Term&) = default;
};

// As requests name the terms, in the order of Term::Kind.
inline constexpr std::array<const char*, 4> kTermNames = {
    "density", "count", "height_profile", "shape"};

// A block that makes the weighted sum of errors grow by d is kept with probability
// exp(-d / temperature), another one always (2007 paper, 4.2, for f = exp(-sum / temperature)).
struct Objective {
    std::vector<Term> terms;
    double temperature = 0;  // 0: no block is kept that makes it worse

    friend bool operator==(const Objective&, const Objective&) = default;
};

// The best of n models by the weighted sum of errors.
struct BestOf {
    std::vector<Term> terms;
    std::uint32_t n = 1;

    friend bool operator==(const BestOf&, const BestOf&) = default;
};

using Rule = std::variant<
    Fixed,
    Forbidden,
    Probability,
    Count,
    Separation,
    MaxRun,
    Connected,
    Acyclic,
    Path,
    Symmetry,
    Resemblance,
    Objective,
    BestOf>;

// As requests name the rules, in the order of the alternatives of Rule.
inline constexpr std::array<const char*, std::variant_size_v<Rule>> kRuleNames = {
    "fixed",
    "forbidden",
    "probability",
    "count",
    "separation",
    "max_run",
    "connected",
    "acyclic",
    "path",
    "symmetry",
    "resemblance",
    "objective",
    "best_of"};

// Whether a rule speaks of the cells that hold its pieces together, not of each cell by itself.
[[nodiscard]] inline bool is_member_rule(const Rule& rule) {
    return std::holds_alternative<Count>(rule) || std::holds_alternative<Separation>(rule) ||
           std::holds_alternative<MaxRun>(rule) || std::holds_alternative<Connected>(rule) ||
           std::holds_alternative<Acyclic>(rule) || std::holds_alternative<Path>(rule);
}

// Whether a rule is about some pieces, which it then names.
[[nodiscard]] inline bool names_pieces(const Rule& rule) {
    return is_member_rule(rule) || std::holds_alternative<Fixed>(rule) ||
           std::holds_alternative<Forbidden>(rule) || std::holds_alternative<Probability>(rule);
}

// Whether it can be said where a rule holds.
[[nodiscard]] inline bool has_region(const Rule& rule) {
    return !std::holds_alternative<Resemblance>(rule);
}

struct Constraint {
    Rule rule;
    std::vector<std::string> pieces = {};  // of rules that name some
    Region region = {};

    friend bool operator==(const Constraint&, const Constraint&) = default;
};

// Which cell is labelled next.
struct CellOrder {
    Order order = Order::kScan;
    ScanAxes axes = kColumns;       // of kScan
    bool is_chosen_for_it = false;  // by trying which suits the example; `order` is then nothing

    friend bool operator==(const CellOrder&, const CellOrder&) = default;
};

// What a discrete synthesis can be asked for; plain data, every field with a usable default once
// `fill_defaults` has run.
struct Parameters {
    std::optional<GridSize> size;  // none: the example's default
    // none: chosen to suit the size; a value without blocks: the whole at once.
    std::optional<std::optional<Blocks>> blocks;
    std::array<std::optional<SideBoundary>, kDirectionCount> boundary;  // none: the example's
    CellOrder order;
    std::optional<Weights> weights;  // none: the example's default
    std::vector<Constraint> constraints;

    friend bool operator==(const Parameters&, const Parameters&) = default;
};

// Attempts at the whole model where there are no blocks.
inline constexpr std::uint32_t kWholeAttempts = 20;

// The parameters with every default filled in from the example.
[[nodiscard]] Parameters fill_defaults(Parameters parameters, const Example& example);

}  // namespace modelsynth::discrete
