#include "proto/continuous_codec.h"

#include "proto/blocks_codec.h"
#include "proto/constraint_codec.h"
#include "proto/region_codec.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::proto {

namespace {

using continuous::ConnectedRule;
using continuous::Constraint;
using continuous::DimensionRule;
using continuous::FixedRule;
using continuous::ForbiddenRule;
using continuous::MetreBox;
using continuous::Parameters;
using continuous::Point;
using continuous::ProbabilityRule;
using continuous::Region;
using continuous::Rule;
using continuous::SymmetryRule;

constexpr double kMetresMax = 1e5;
constexpr double kOffsetMax = 2e5;  // the corners of the largest model are nearer

std::optional<std::array<double, 3>> read_size(const Value& value) {
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

void read_weights(const Value& value, const RequestLimits& limits, Parameters& parameters) {
    if (!value.json().is_object()) {
        value.fault("must be an object of weights by object");
        return;
    }
    for (const auto& [name, json] : value.json().items()) {
        const Value weight(json, value.pointer() + "/" + pointer_part(name), value.faults());
        if (name.size() > limits.name_characters_max) {
            weight.fault("the name is too long");
        } else if (const auto number = weight.number(0, 1e6)) {
            parameters.weights.emplace_back(name, *number);
        }
    }
}

std::optional<MetreBox> read_metre_box(const Value& value) {
    ObjectReader reader(value);
    const auto min_value = reader.required("min");
    const auto max_value = reader.required("max");
    reader.finish();
    const auto min = min_value ? read_point(*min_value, kMetresMax) : std::nullopt;
    const auto max = max_value ? read_point(*max_value, kMetresMax) : std::nullopt;
    if (!min || !max) {
        return std::nullopt;
    }
    if ((min->array() >= max->array()).any()) {
        value.fault("max must be beyond min along every axis");
    }
    return MetreBox{{min->x(), min->y(), min->z()}, {max->x(), max->y(), max->z()}};
}

Region read_metre_region(ObjectReader& reader, const RequestLimits& limits) {
    Region region;
    if (const auto box = reader.optional("box")) {
        region.box = read_metre_box(*box);
    }
    if (const auto mask = reader.optional("mask")) {
        region.mask = read_mask(*mask, limits);
    }
    if (const auto voxels = reader.optional("voxels")) {
        region.voxels = read_voxels(*voxels, limits);
    }
    return region;
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

DimensionRule read_dimension(ObjectReader& reader) {
    DimensionRule rule;
    if (const auto normal = reader.required("normal")) {
        rule.normal = read_normal(*normal).value_or(rule.normal);
    }
    if (const auto spacings = reader.optional("spacings")) {
        rule.spacings =
            static_cast<std::int32_t>(spacings->integer(1, continuous::kCellsAlongMax).value_or(1));
    }
    return rule;
}

SymmetryRule read_symmetry(ObjectReader& reader, const Value& whole, const RequestLimits& limits) {
    using Kind = SymmetryRule::Kind;
    SymmetryRule rule;
    int kinds = 0;
    if (const auto reflect = reader.optional("reflect")) {
        ++kinds;
        rule.kind = reflect->one_of({"x", "z"}) == 1U ? Kind::kReflectZ : Kind::kReflectX;
    }
    if (const auto translate = reader.optional("translate")) {
        ++kinds;
        rule.kind = Kind::kTranslate;
        const Point step = read_point(*translate, kMetresMax).value_or(Point::UnitX());
        rule.translation = {step.x(), step.y(), step.z()};
    }
    if (const auto rotate = reader.optional("rotate")) {
        ++kinds;
        const auto turns = rotate->integer(2, 4);
        if (turns == 3) {
            rotate->fault("must be 2, by half turns, or 4, by quarter turns");
        }
        rule.kind = turns == 4 ? Kind::kQuarterTurn : Kind::kHalfTurn;
    }
    if (kinds != 1) {
        whole.fault("symmetry needs one of \"reflect\", \"translate\" and \"rotate\"");
    }
    if (const auto mirror = reader.optional("mirror")) {
        rule.mirror = read_mirror(*mirror, limits);
    }
    return rule;
}

Rule read_rule(
    std::size_t kind, ObjectReader& reader, const Value& whole, const RequestLimits& limits
) {
    switch (kind) {
        case 0:
            return read_dimension(reader);
        case 1: {
            ConnectedRule rule;
            if (const auto components = reader.optional("components")) {
                rule.components =
                    static_cast<std::uint32_t>(components->integer(1, 1000).value_or(1));
            }
            return rule;
        }
        case 2:
            return FixedRule{};
        case 3:
            return ForbiddenRule{};
        case 4: {
            ProbabilityRule rule;
            if (const auto weight = reader.required("weight")) {
                rule.weight = weight->number(0, 1e6).value_or(1);
            }
            return rule;
        }
        default:
            return read_symmetry(reader, whole, limits);
    }
}

// One that cannot be read keeps its place in the list, so that faults of the others are told at
// theirs, as a rule that says nothing.
Constraint read_constraint(const Value& value, const RequestLimits& limits) {
    const Constraint nothing = {ForbiddenRule{}};
    ObjectReader reader(value);
    const auto kind_value = reader.required("kind");
    const auto kind = kind_value ? kind_value->one_of(continuous::kRuleNames) : std::nullopt;
    if (!kind) {
        return nothing;
    }
    Constraint constraint;
    constraint.rule = read_rule(*kind, reader, value, limits);
    if (std::holds_alternative<DimensionRule>(constraint.rule)) {
        if (const auto object = reader.required("object")) {
            constraint.objects = {object->string(limits.name_characters_max).value_or("")};
        }
    } else if (std::holds_alternative<SymmetryRule>(constraint.rule)) {
        constraint.objects.clear();
    } else if (const auto objects = reader.required("objects")) {
        constraint.objects =
            objects->strings(1, continuous::kObjectTypesMax, limits.name_characters_max)
                .value_or(std::vector<std::string>());
    }
    if (continuous::has_region(constraint.rule)) {
        constraint.region = read_metre_region(reader, limits);
    }
    reader.finish();
    const bool names_none = constraint.objects.empty() &&
                            !std::holds_alternative<SymmetryRule>(constraint.rule);
    return names_none ? nothing : constraint;
}

std::vector<Constraint> read_solid_constraints(const Value& value, const RequestLimits& limits) {
    std::vector<Constraint> constraints;
    const auto values = value.array(0, limits.constraints_max);
    if (!values) {
        return constraints;
    }
    // Masks are counted before any is unpacked.
    const auto has_mask = [](const Value& one) {
        return one.json().is_object() && one.json().contains("mask");
    };
    if (std::count_if(values->begin(), values->end(), has_mask) >
        static_cast<std::ptrdiff_t>(limits.masks_max)) {
        value.fault(
            "has more than " + std::to_string(limits.masks_max) + " masks; the limit is masks_max",
            true
        );
        return constraints;
    }
    std::size_t member_rules = 0;
    for (const Value& one : *values) {
        const Constraint& constraint = constraints.emplace_back(read_constraint(one, limits));
        if (std::holds_alternative<ConnectedRule>(constraint.rule) &&
            ++member_rules == limits.member_rules_max + 1) {
            value.fault(
                "has more than " + std::to_string(limits.member_rules_max) +
                    " constraints of the kind connected; the limit is member_rules_max",
                true
            );
        }
    }
    return constraints;
}

void write_symmetry(const SymmetryRule& rule, OrderedJson& written) {
    switch (rule.kind) {
        case SymmetryRule::Kind::kReflectX:
            written["reflect"] = "x";
            break;
        case SymmetryRule::Kind::kReflectZ:
            written["reflect"] = "z";
            break;
        case SymmetryRule::Kind::kHalfTurn:
            written["rotate"] = 2;
            break;
        case SymmetryRule::Kind::kQuarterTurn:
            written["rotate"] = 4;
            break;
        case SymmetryRule::Kind::kTranslate:
            written["translate"] = rule.translation;
            break;
    }
    written["mirror"] = OrderedJson::object();
    for (const auto& [object, image] : rule.mirror) {
        written["mirror"][object] = image;
    }
}

OrderedJson write_constraint(const Constraint& constraint) {
    OrderedJson written = {{"kind", continuous::kRuleNames[constraint.rule.index()]}};
    if (const auto* dimension = std::get_if<DimensionRule>(&constraint.rule)) {
        written["object"] = constraint.objects.front();
        written["normal"] = dimension->normal;
        written["spacings"] = dimension->spacings;
        return written;
    }
    if (const auto* symmetry = std::get_if<SymmetryRule>(&constraint.rule)) {
        write_symmetry(*symmetry, written);
        return written;
    }
    written["objects"] = constraint.objects;
    if (const auto* connected = std::get_if<ConnectedRule>(&constraint.rule)) {
        written["components"] = connected->components;
    } else if (const auto* probability = std::get_if<ProbabilityRule>(&constraint.rule)) {
        written["weight"] = probability->weight;
    }
    if (const auto& box = constraint.region.box) {
        written["box"] = {{"min", box->min}, {"max", box->max}};
    }
    write_fields(constraint.region.mask, constraint.region.voxels, written);
    return written;
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

OrderedJson write_point(const Point& point) {
    return OrderedJson::array({point.x(), point.y(), point.z()});
}

Parameters read_continuous_parameters(const Value& value, const RequestLimits& limits) {
    Parameters parameters;
    ObjectReader reader(value);
    if (const auto size = reader.optional("size")) {
        parameters.size = read_size(*size);
    }
    if (const auto spacing = reader.optional("spacing")) {
        read_spacing(*spacing, parameters);
    }
    if (const auto offsets = reader.optional("offsets")) {
        parameters.offsets = read_offsets(*offsets);
    }
    if (const auto blocks = reader.optional("blocks")) {
        parameters.blocks.emplace(read_blocks(*blocks, limits));
    }
    if (const auto density = reader.optional("density")) {
        parameters.density = density->number(0.001, 1);
    }
    if (const auto weights = reader.optional("weights")) {
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
    OrderedJson constraints = OrderedJson::array();
    for (const Constraint& constraint : *parameters.constraints) {
        constraints.push_back(write_constraint(constraint));
    }
    return {
        {"size", *parameters.size},
        {"spacing", write_spacing(parameters)},
        {"offsets", write_offsets(parameters)},
        {"blocks", write_blocks(*parameters.blocks)},
        {"density", *parameters.density},
        {"weights", std::move(weights)},
        {"constraints", std::move(constraints)}};
}

}  // namespace modelsynth::proto
