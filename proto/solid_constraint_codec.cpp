#include "proto/solid_constraint_codec.h"

#include "proto/constraint_codec.h"
#include "proto/continuous_codec.h"
#include "proto/region_codec.h"
#include "proto/shape_codec.h"

#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace modelsynth::proto {

namespace {

constexpr std::size_t kBoundingVolume = 6;  // of kRuleNames
static_assert(std::is_same_v<
              std::variant_alternative_t<kBoundingVolume, continuous::Rule>,
              continuous::BoundingVolumeRule>);

using continuous::BoundingVolumeRule;
using continuous::ConnectedRule;
using continuous::Constraint;
using continuous::DimensionRule;
using continuous::FixedRule;
using continuous::ForbiddenRule;
using continuous::MetreBox;
using continuous::Point;
using continuous::ProbabilityRule;
using continuous::Region;
using continuous::Rule;
using continuous::SymmetryRule;

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

// It has the fields of a shape, and the object.
Constraint read_bounding_volume(
    ObjectReader& reader, const Value& whole, Constraint nothing, const RequestLimits& limits
) {
    Faults faults;
    const Value alone(whole.json(), whole.pointer(), faults);
    Constraint constraint = {BoundingVolumeRule{read_shape(alone, {"kind", "object"})}};
    const bool is_sound = faults.empty();
    whole.faults().add_all("", faults.take());
    const auto object = reader.required("object");
    const auto name = object ? object->string(limits.name_characters_max) : std::nullopt;
    if (!name || !is_sound) {
        return nothing;
    }
    constraint.objects = {*name};
    return constraint;
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
    if (*kind == kBoundingVolume) {
        return read_bounding_volume(reader, value, nothing, limits);
    }
    Constraint constraint;
    constraint.rule = read_rule(*kind, reader, value, limits);
    const bool is_connected = std::holds_alternative<ConnectedRule>(constraint.rule);
    if (std::holds_alternative<DimensionRule>(constraint.rule)) {
        if (const auto object = reader.required("object")) {
            constraint.objects = {object->string(limits.name_characters_max).value_or("")};
        }
    } else if (std::holds_alternative<SymmetryRule>(constraint.rule)) {
        reader.finish();
        return constraint;  // of the whole model, whatever it is made of
    } else if (const auto objects = reader.required("objects")) {
        constraint.objects =
            objects
                ->strings(
                    is_connected ? 0 : 1, continuous::kObjectTypesMax, limits.name_characters_max
                )
                .value_or(std::vector<std::string>());
    }
    if (continuous::has_region(constraint.rule)) {
        constraint.region = read_metre_region(reader, limits);
    }
    reader.finish();
    return constraint.objects.empty() && !is_connected ? nothing : constraint;
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
    if (rule.mirror) {
        written["mirror"] = OrderedJson::object();
        for (const auto& [object, image] : *rule.mirror) {
            written["mirror"][object] = image;
        }
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
    if (const auto* volume = std::get_if<BoundingVolumeRule>(&constraint.rule)) {
        written["object"] = constraint.objects.front();
        written.update(write_shape(*volume->shape));
        return written;
    }
    written["objects"] = constraint.objects;
    if (const auto* connected = std::get_if<ConnectedRule>(&constraint.rule)) {
        written["components"] = connected->components;
    } else if (const auto* probability = std::get_if<ProbabilityRule>(&constraint.rule)) {
        written["weight"] = probability->weight;
    }
    write_region(constraint.region, written);
    return written;
}

}  // namespace

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

void write_region(const Region& region, OrderedJson& written) {
    if (const auto& box = region.box) {
        written["box"] = {{"min", box->min}, {"max", box->max}};
    }
    write_fields(region.mask, region.voxels, written);
}

std::vector<Constraint> read_solid_constraints(const Value& value, const RequestLimits& limits) {
    std::vector<Constraint> constraints;
    const auto values = constraint_values(value, limits);
    if (!values) {
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

OrderedJson write_constraints(const std::vector<Constraint>& constraints) {
    OrderedJson written = OrderedJson::array();
    for (const Constraint& constraint : constraints) {
        written.push_back(write_constraint(constraint));
    }
    return written;
}

}  // namespace modelsynth::proto
