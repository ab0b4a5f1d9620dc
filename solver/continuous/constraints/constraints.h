#pragma once

#include "solver/core/masks.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::continuous {

struct Shape;  // example.h

// Metres, in the model's frame.
struct MetreBox {
    std::array<double, 3> min = {};
    std::array<double, 3> max = {};

    friend bool operator==(const MetreBox&, const MetreBox&) = default;
};

// Where a constraint holds: in any of these, or everywhere when none is given. Below y = 0 it says
// nothing of the ground, and nothing that has to be there; what it keeps out, also from there.
struct Region {
    std::optional<MetreBox> box = std::nullopt;
    std::optional<Mask> mask = std::nullopt;  // through the whole height
    std::optional<Voxels> voxels = std::nullopt;

    friend bool operator==(const Region&, const Region&) = default;
};

// What a constraint asks of the objects it names.

// The object is exactly so many spacings wide across the planes of a normal (thesis 4.6.1). Wider
// than one, it begins and ends at every so manieth plane from the origin only.
struct DimensionRule {
    std::array<double, 3> normal = {0, 1, 0};  // need not be of unit length
    std::int32_t spacings = 1;                 // >= 1

    friend bool operator==(const DimensionRule&, const DimensionRule&) = default;
};

// All of the objects together hang together in so many components at most (thesis 4.6.2). What
// touches, be it at a corner, hangs together. >= 1. Of no objects it asks for nothing, and stands
// in the place of what the example asks.
struct ConnectedRule {
    std::uint32_t components = 1;

    friend bool operator==(const ConnectedRule&, const ConnectedRule&) = default;
};

// Nothing but these objects; "empty" names empty space.
struct FixedRule {
    friend bool operator==(const FixedRule&, const FixedRule&) = default;
};

// None of these objects; "empty" names empty space.
struct ForbiddenRule {
    friend bool operator==(const ForbiddenRule&, const ForbiddenRule&) = default;
};

// Weights of figures in which any of the objects takes part are multiplied by this (thesis 4.6.3),
// by 1 + value * (weight - 1) where a mask or voxels give a value between 0 and 1; 0 removes the
// objects. >= 0.
struct ProbabilityRule {
    double weight = 1;

    friend bool operator==(const ProbabilityRule&, const ProbabilityRule&) = default;
};

using NamePairs = std::vector<std::pair<std::string, std::string>>;

// What stands at a place stands at the place's image, too, turned or mirrored as the place is
// (2007 paper, 4.1). Reflections and turns are about the upright line through the middle of the
// model.
struct SymmetryRule {
    enum class Kind : std::uint8_t { kReflectX, kReflectZ, kHalfTurn, kQuarterTurn, kTranslate };

    Kind kind = Kind::kReflectX;             // a quarter turn: from the east to the north
    std::array<double, 3> translation = {};  // for kTranslate, metres
    // Objects and their images; see label_images() for those that are not named. None: found, see
    // likely_mirror().
    std::optional<NamePairs> mirror = std::nullopt;

    friend bool operator==(const SymmetryRule&, const SymmetryRule&) = default;
};

// In models this is put in the place of the object's boxes, whatever its shape is in the example
// (thesis 4.6.4). Never null.
struct BoundingVolumeRule {
    std::shared_ptr<const Shape> shape;

    friend bool operator==(const BoundingVolumeRule& one, const BoundingVolumeRule& other);
};

using Rule = std::variant<
    DimensionRule,
    ConnectedRule,
    FixedRule,
    ForbiddenRule,
    ProbabilityRule,
    SymmetryRule,
    BoundingVolumeRule>;

// As requests name the rules, in the order of the alternatives of Rule.
inline constexpr std::array<const char*, std::variant_size_v<Rule>> kRuleNames = {
    "dimension", "connected", "fixed", "forbidden", "probability", "symmetry", "bounding_volume"};

// What requests call empty space, unless the example has an object of that name.
inline constexpr const char* kEmptyName = "empty";

// Whether it can be said where a rule holds.
[[nodiscard]] inline bool has_region(const Rule& rule) {
    return std::holds_alternative<FixedRule>(rule) || std::holds_alternative<ForbiddenRule>(rule) ||
           std::holds_alternative<ProbabilityRule>(rule);
}

// Whether a rule may speak of empty space.
[[nodiscard]] inline bool may_name_empty(const Rule& rule) {
    return std::holds_alternative<FixedRule>(rule) || std::holds_alternative<ForbiddenRule>(rule);
}

struct Constraint {
    Rule rule;
    std::vector<std::string> objects =
        {};  // one for a dimension or a bounding volume, none for a symmetry
    Region region = {};

    friend bool operator==(const Constraint&, const Constraint&) = default;
};

}  // namespace modelsynth::continuous
