#include "proto/continuous_codec.h"

#include "proto/blocks_codec.h"
#include "proto/constraint_codec.h"
#include "proto/region_codec.h"

#include <utility>

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

DimensionRule read_dimension(ObjectReader& reader) {
    DimensionRule rule;
    if (const auto normal = reader.required("normal")) {
        const auto direction = read_point(*normal, kMetresMax);
        if (direction && direction->norm() < 1e-9) {
            normal->fault("must have a length");
        }
        if (direction) {
            rule.normal = {direction->x(), direction->y(), direction->z()};
        }
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

std::optional<Constraint> read_constraint(const Value& value, const RequestLimits& limits) {
    ObjectReader reader(value);
    const auto kind_value = reader.required("kind");
    const auto kind = kind_value ? kind_value->one_of(continuous::kRuleNames) : std::nullopt;
    if (!kind) {
        return std::nullopt;
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
            objects->strings(0, continuous::kObjectTypesMax, limits.name_characters_max)
                .value_or(std::vector<std::string>());
    }
    if (continuous::has_region(constraint.rule)) {
        constraint.region = read_metre_region(reader, limits);
    }
    reader.finish();
    return constraint;
}

std::vector<Constraint> read_solid_constraints(const Value& value, const RequestLimits& limits) {
    std::vector<Constraint> constraints;
    if (const auto values = value.array(0, limits.constraints_max)) {
        for (const Value& one : *values) {
            if (auto constraint = read_constraint(one, limits)) {
                constraints.push_back(std::move(*constraint));
            }
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
        parameters.spacing = spacing->number_above(0, kMetresMax);
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
        {"spacing", *parameters.spacing},
        {"blocks", write_blocks(*parameters.blocks)},
        {"density", *parameters.density},
        {"weights", std::move(weights)},
        {"constraints", std::move(constraints)}};
}

}  // namespace modelsynth::proto
