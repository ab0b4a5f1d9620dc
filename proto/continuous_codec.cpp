#include "proto/continuous_codec.h"

#include "proto/blocks_codec.h"
#include "proto/solid_constraint_codec.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::proto {

namespace {

using continuous::Parameters;
using continuous::Point;

constexpr double kOffsetMax = 2e5;  // the corners of the largest model are nearer

void read_weights(const Value& value, const RequestLimits& limits, Parameters& parameters) {
    if (!value.json().is_object()) {
        value.fault("must be an object of weights by object");
        return;
    }
    for (const auto& [name, json] : value.json().items()) {
        const Value weight(json, value.pointer() + "/" + pointer_part(name), value.faults());
        if (count_characters(name) > limits.name_characters_max) {
            weight.fault("the name is too long");
        } else if (const auto number = weight.number(0, 1e6)) {
            parameters.weights.emplace_back(name, *number);
        }
    }
}

// What is faulty has length 0, so that nothing more is said of it.
constexpr std::array<double, 3> kNoNormal = {0, 0, 0};

// What stands in a list keeps its place in it, faults or not: pointers count on that.
void read_spacing_list(const Value& value, Parameters& parameters) {
    const auto entries = value.array(1, continuous::kFamiliesMax + 1);
    for (std::size_t i = 0; entries && i < entries->size(); ++i) {
        ObjectReader reader((*entries)[i]);
        const auto normal = reader.optional("normal");
        const auto spacing_value = reader.required("spacing");
        reader.finish();
        const auto spacing =
            spacing_value ? spacing_value->number_above(0, kMetresMax) : std::nullopt;
        const bool is_last = i + 1 == entries->size();
        if (normal) {
            parameters.spacings.push_back(
                {read_normal(*normal).value_or(kNoNormal), spacing.value_or(kMetresMax)}
            );
        } else if (is_last) {
            parameters.spacing = spacing;
        } else {
            (*entries)[i].fault(
                "has no normal; only the last one may lack it, which is for all other planes"
            );
            parameters.spacings.push_back({kNoNormal, kMetresMax});
        }
    }
}

void read_spacing(const Value& value, Parameters& parameters) {
    if (value.json().is_array()) {
        read_spacing_list(value, parameters);
    } else if (value.json().is_number()) {
        parameters.spacing = value.number_above(0, kMetresMax);
    } else {
        value.fault("must be a number or a list of spacings");
    }
}

OrderedJson write_spacing(const Parameters& parameters) {
    if (parameters.spacings.empty()) {
        return *parameters.spacing;
    }
    OrderedJson list = OrderedJson::array();
    for (const continuous::FamilySpacing& family : parameters.spacings) {
        list.push_back({{"normal", family.normal}, {"spacing", family.spacing}});
    }
    list.push_back({{"spacing", *parameters.spacing}});
    return list;
}

continuous::FamilyOffsets read_family_offsets(const Value& value) {
    continuous::FamilyOffsets family = {kNoNormal, {}};
    ObjectReader reader(value);
    if (const auto normal = reader.required("normal")) {
        family.normal = read_normal(*normal).value_or(kNoNormal);
    }
    if (const auto offsets = reader.required("offsets")) {
        const auto values = offsets->array(1, continuous::kOffsetsMax);
        for (const Value& one : values.value_or(std::vector<Value>())) {
            family.offsets.push_back(one.number(-kOffsetMax, kOffsetMax).value_or(0));
        }
    }
    reader.finish();
    return family;
}

std::vector<continuous::FamilyOffsets> read_offsets(const Value& value) {
    std::vector<continuous::FamilyOffsets> families;
    if (const auto values = value.array(0, continuous::kFamiliesMax)) {
        for (const Value& one : *values) {
            families.push_back(read_family_offsets(one));
        }
    }
    return families;
}

OrderedJson write_offsets(const Parameters& parameters) {
    OrderedJson list = OrderedJson::array();
    for (const continuous::FamilyOffsets& family : parameters.offsets) {
        list.push_back({{"normal", family.normal}, {"offsets", family.offsets}});
    }
    return list;
}

continuous::Variants read_variants(const Value& value) {
    continuous::Variants variants;
    ObjectReader reader(value);
    if (const auto turns = reader.optional("turns")) {
        const auto count = turns->integer(1, 4).value_or(1);
        if (count == 3) {
            turns->fault("must be 1, 2 or 4");
        }
        variants.turns = static_cast<std::uint8_t>(count);
    }
    if (const auto mirrors = reader.optional("mirrors")) {
        constexpr std::array<const char*, 2> kAxes = {"x", "z"};
        for (const Value& axis : mirrors->array(0, 2).value_or(std::vector<Value>())) {
            if (const auto number = axis.one_of(kAxes)) {
                (*number == 0 ? variants.mirror_x : variants.mirror_z) = true;
            }
        }
    }
    reader.finish();
    return variants;
}

OrderedJson write_variants(const continuous::Variants& variants) {
    OrderedJson mirrors = OrderedJson::array();
    if (variants.mirror_x) {
        mirrors.push_back("x");
    }
    if (variants.mirror_z) {
        mirrors.push_back("z");
    }
    return {{"turns", variants.turns}, {"mirrors", std::move(mirrors)}};
}

// Side 2 * axis, + 1 where the coordinate is largest.
constexpr std::array<const char*, 6> kSides = {"west", "east", "bottom", "top", "north", "south"};
constexpr std::array<const char*, 2> kSideKinds = {"closed", "free"};

void read_boundary(const Value& value, Parameters& parameters) {
    ObjectReader reader(value);
    for (std::size_t side = 0; side < kSides.size(); ++side) {
        const auto given = reader.optional(kSides[side]);
        if (const auto kind = given ? given->one_of(kSideKinds) : std::nullopt) {
            parameters.boundary[side] =
                *kind == 0 ? continuous::SideKind::kClosed : continuous::SideKind::kFree;
        }
    }
    reader.finish();
}

OrderedJson write_boundary(const Parameters& parameters) {
    OrderedJson boundary = OrderedJson::object();
    for (std::size_t side = 0; side < kSides.size(); ++side) {
        boundary[kSides[side]] =
            kSideKinds[parameters.boundary[side] == continuous::SideKind::kFree ? 1 : 0];
    }
    return boundary;
}

}  // namespace

std::optional<Point> read_point(const Value& value, double extent_max) {
    const auto values = value.array(3, 3);
    if (!values) {
        return std::nullopt;
    }
    Point point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto number = (*values)[axis].number(-extent_max, extent_max);
        if (!number) {
            return std::nullopt;
        }
        point[static_cast<Eigen::Index>(axis)] = *number;
    }
    return point;
}

std::optional<std::array<double, 3>> read_metre_size(const Value& value) {
    const auto values = value.array(3, 3);
    if (!values) {
        return std::nullopt;
    }
    std::array<double, 3> size = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto length = (*values)[axis].number_above(0, kMetresMax);
        if (!length) {
            return std::nullopt;
        }
        size[axis] = *length;
    }
    return size;
}

std::optional<std::array<double, 3>> read_normal(const Value& value) {
    const auto direction = read_point(value, kMetresMax);
    if (!direction) {
        return std::nullopt;
    }
    if (direction->norm() < 1e-9) {
        value.fault("must have a length");
    }
    return std::array{direction->x(), direction->y(), direction->z()};
}

OrderedJson write_point(const Point& point) {
    return OrderedJson::array({point.x(), point.y(), point.z()});
}

Parameters read_continuous_parameters(
    const Value& value, const RequestLimits& limits, Parameters parameters
) {
    ObjectReader reader(value);
    if (const auto size = reader.optional("size")) {
        parameters.size = read_metre_size(*size);
    }
    if (const auto spacing = reader.optional("spacing")) {
        parameters.spacings.clear();
        read_spacing(*spacing, parameters);
    }
    if (const auto offsets = reader.optional("offsets")) {
        parameters.offsets = read_offsets(*offsets);
    }
    if (const auto blocks = reader.optional("blocks")) {
        parameters.blocks.emplace(read_blocks(*blocks, limits, continuous::kDefaultBlocks));
    }
    if (const auto boundary = reader.optional("boundary")) {
        parameters.boundary = {};
        read_boundary(*boundary, parameters);
    }
    if (const auto jitter = reader.optional("jitter")) {
        parameters.jitter = jitter->number(0, continuous::kJitterMax).value_or(0);
    }
    if (const auto perturbation = reader.optional("perturbation")) {
        parameters.perturbation = perturbation->number(0, continuous::kPerturbationMax).value_or(0);
    }
    if (const auto nudge = reader.optional("nudge")) {
        parameters.nudge = nudge->number(0, continuous::kNudgeMax).value_or(0);
    }
    if (const auto variants = reader.optional("variants")) {
        parameters.variants = read_variants(*variants);
    }
    if (const auto density = reader.optional("density")) {
        parameters.density = density->number(0.001, 1);
    }
    if (const auto weights = reader.optional("weights")) {
        parameters.weights.clear();
        read_weights(*weights, limits, parameters);
    }
    if (const auto constraints = reader.optional("constraints")) {
        parameters.constraints = read_solid_constraints(*constraints, limits);
    }
    reader.finish();
    return parameters;
}

OrderedJson write_parameters(const Parameters& parameters) {
    OrderedJson weights = OrderedJson::object();
    for (const auto& [name, weight] : parameters.weights) {
        weights[name] = weight;
    }
    return {
        {"size", *parameters.size},
        {"spacing", write_spacing(parameters)},
        {"offsets", write_offsets(parameters)},
        {"blocks", write_blocks(*parameters.blocks)},
        {"boundary", write_boundary(parameters)},
        {"jitter", parameters.jitter},
        {"perturbation", parameters.perturbation},
        {"nudge", parameters.nudge},
        {"variants", write_variants(parameters.variants)},
        {"density", *parameters.density},
        {"weights", std::move(weights)},
        {"constraints", write_constraints(*parameters.constraints)}};
}

}  // namespace modelsynth::proto
