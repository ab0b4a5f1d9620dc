#include "proto/constraint_codec.h"

#include "proto/region_codec.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace modelsynth::proto {

namespace {

using discrete::Constraint;
using discrete::Rule;

constexpr double kWeightMax = 1e6;
constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

std::uint32_t read_count(const Value& value, const RequestLimits& limits, std::uint32_t least) {
    const auto most = static_cast<std::int64_t>(limits.model_cells_max);
    return static_cast<std::uint32_t>(value.integer(least, most).value_or(least));
}

Rule read_count_rule(ObjectReader& reader, const Value& whole, const RequestLimits& limits) {
    discrete::Count count;
    const auto min = reader.optional("min");
    const auto max = reader.optional("max");
    if (!min && !max) {
        whole.fault("count needs \"min\", \"max\" or both");
    }
    if (min) {
        count.min = read_count(*min, limits, 0);
    }
    if (max) {
        count.max = read_count(*max, limits, 0);
    }
    return count;
}

Rule read_max_run(ObjectReader& reader, const RequestLimits& limits) {
    discrete::MaxRun run;
    if (const auto max = reader.required("max")) {
        run.max = static_cast<std::int32_t>(max->integer(1, limits.extent_max).value_or(1));
    }
    if (const auto axis = reader.optional("axis")) {
        if (const auto index = axis->one_of({"x", "y", "z"})) {
            run.axis = static_cast<std::uint8_t>(*index);
        }
    }
    return run;
}

Rule read_path(ObjectReader& reader, const RequestLimits& limits) {
    discrete::Path path;
    for (const auto& [name, cell] : {std::pair("from", &path.from), std::pair("to", &path.to)}) {
        if (const auto value = reader.required(name)) {
            *cell = value->cell(0, limits.extent_max).value_or(Cell{});
        }
    }
    return path;
}

// The further fields of the kind.
Rule read_rule(
    const std::string& kind, ObjectReader& reader, const Value& whole, const RequestLimits& limits
) {
    if (kind == "forbidden") {
        return discrete::Forbidden{};
    }
    if (kind == "probability") {
        const auto weight = reader.required("weight");
        return discrete::Probability{weight ? weight->number(0, kWeightMax).value_or(1) : 1};
    }
    if (kind == "count") {
        return read_count_rule(reader, whole, limits);
    }
    if (kind == "separation") {
        const auto distance = reader.required("distance");
        const auto most = limits.separation_max;
        return discrete::Separation{
            distance ? static_cast<std::int32_t>(distance->integer(1, most).value_or(1)) : 1};
    }
    if (kind == "max_run") {
        return read_max_run(reader, limits);
    }
    if (kind == "connected") {
        return discrete::Connected{};
    }
    if (kind == "acyclic") {
        return discrete::Acyclic{};
    }
    if (kind == "path") {
        return read_path(reader, limits);
    }
    return discrete::Fixed{};
}

Constraint read_constraint(const Value& value, const RequestLimits& limits) {
    Constraint constraint;
    ObjectReader reader(value);
    const auto kind_value = reader.required("kind");
    const auto kind = kind_value ? kind_value->one_of(discrete::kRuleNames) : std::nullopt;
    if (kind) {
        constraint.rule = read_rule(discrete::kRuleNames.at(*kind), reader, value, limits);
    }
    if (const auto pieces = reader.required("pieces")) {
        constraint.pieces = pieces->strings(1, limits.pieces_max, limits.name_characters_max)
                                .value_or(constraint.pieces);
    }
    constraint.region = read_region(reader, limits);
    if (kind || !kind_value) {
        reader.finish();  // of an unknown kind no field can be called unknown
    }
    return constraint;
}

// Writes the further fields of a rule.
struct RuleWriter {
    OrderedJson& written;

    void operator()(const discrete::Fixed& /*rule*/) const {}

    void operator()(const discrete::Forbidden& /*rule*/) const {}

    void operator()(const discrete::Connected& /*rule*/) const {}

    void operator()(const discrete::Acyclic& /*rule*/) const {}

    void operator()(const discrete::Probability& rule) const { written["weight"] = rule.weight; }

    void operator()(const discrete::Count& rule) const {
        written["min"] = rule.min;
        if (rule.max) {
            written["max"] = *rule.max;
        }
    }

    void operator()(const discrete::Separation& rule) const { written["distance"] = rule.distance; }

    void operator()(const discrete::MaxRun& rule) const {
        written["max"] = rule.max;
        if (rule.axis) {
            written["axis"] = kAxisNames.at(*rule.axis);
        }
    }

    void operator()(const discrete::Path& rule) const {
        written["from"] = write_cell(rule.from);
        written["to"] = write_cell(rule.to);
    }
};

}  // namespace

std::vector<Constraint> read_constraints(const Value& value, const RequestLimits& limits) {
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
        Constraint& constraint = constraints.emplace_back(read_constraint(one, limits));
        if (is_member_rule(constraint.rule) && ++member_rules == limits.member_rules_max + 1) {
            value.fault(
                "has more than " + std::to_string(limits.member_rules_max) +
                    " constraints other than fixed, forbidden and probability; the limit is "
                    "member_rules_max",
                true
            );
        }
    }
    return constraints;
}

OrderedJson write_constraints(const std::vector<Constraint>& constraints) {
    OrderedJson list = OrderedJson::array();
    for (const Constraint& constraint : constraints) {
        OrderedJson written = {
            {"kind", discrete::kRuleNames.at(constraint.rule.index())},
            {"pieces", constraint.pieces}};
        std::visit(RuleWriter{written}, constraint.rule);
        write_region(constraint.region, written);
        list.push_back(std::move(written));
    }
    return list;
}

}  // namespace modelsynth::proto
