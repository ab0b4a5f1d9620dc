#include "proto/constraint_codec.h"

#include "proto/image_mask.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace modelsynth::proto {

namespace {

using discrete::Constraint;
using discrete::Region;
using discrete::Rule;

constexpr std::size_t kCellsMax = 100'000;
constexpr double kWeightMax = 1e6;
constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

std::optional<Box> read_box(const Value& value, const RequestLimits& limits) {
    ObjectReader reader(value);
    const auto min_value = reader.required("min");
    const auto max_value = reader.required("max");
    reader.finish();
    const auto min = min_value ? min_value->cell(0, limits.extent_max) : std::nullopt;
    const auto max = max_value ? max_value->cell(0, limits.extent_max) : std::nullopt;
    if (!min || !max) {
        return std::nullopt;
    }
    if (max->x <= min->x || max->y <= min->y || max->z <= min->z) {
        value.fault("max is exclusive and must be above min along every axis");
        return std::nullopt;
    }
    return Box{*min, *max};
}

std::vector<Cell> read_cells(const Value& value, const RequestLimits& limits) {
    std::vector<Cell> cells;
    if (const auto values = value.array(1, kCellsMax)) {
        for (const Value& cell : *values) {
            if (const auto place = cell.cell(0, limits.extent_max)) {
                cells.push_back(*place);
            }
        }
    }
    return cells;
}

std::optional<discrete::Voxels> read_voxels(const Value& value, const RequestLimits& limits) {
    ObjectReader reader(value);
    const auto size_value = reader.required("size");
    const auto values_value = reader.required("values");
    reader.finish();
    const auto size = size_value ? size_value->cell(1, limits.extent_max) : std::nullopt;
    const auto values = values_value ? values_value->array(1, limits.voxels_max) : std::nullopt;
    if (!size || !values) {
        return std::nullopt;
    }
    discrete::Voxels voxels = {{size->x, size->y, size->z}, {}};
    if (values->size() != voxels.size.cell_count()) {
        values_value->fault(
            "has " + std::to_string(values->size()) + " values; its size asks for " +
            std::to_string(voxels.size.cell_count())
        );
        return std::nullopt;
    }
    voxels.values.reserve(values->size());
    for (const Value& one : *values) {
        voxels.values.push_back(one.number(0, 1).value_or(0));
    }
    return voxels;
}

std::optional<discrete::Mask> read_mask(const Value& value, const RequestLimits& limits) {
    if (!value.json().is_string()) {
        value.fault("must be an image: a data: URI of a PNG");
        return std::nullopt;
    }
    const auto& text = value.json().get_ref<const std::string&>();
    auto image = decode_mask(text, limits.mask);
    if (!image) {
        value.fault(image.error().message, image.error().code == ErrorCode::kTooLarge);
        return std::nullopt;
    }
    return discrete::Mask{image->width, image->height, std::move(image->values), text};
}

Region read_region(ObjectReader& reader, const RequestLimits& limits) {
    Region region;
    if (const auto box = reader.optional("box")) {
        region.box = read_box(*box, limits);
    }
    if (const auto cells = reader.optional("cells")) {
        region.cells = read_cells(*cells, limits);
    }
    if (const auto mask = reader.optional("mask")) {
        region.mask = read_mask(*mask, limits);
    }
    if (const auto voxels = reader.optional("voxels")) {
        region.voxels = read_voxels(*voxels, limits);
    }
    return region;
}

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

OrderedJson write_cell(const Cell& cell) { return OrderedJson::array({cell.x, cell.y, cell.z}); }

void write_region(const Region& region, OrderedJson& written) {
    if (region.box) {
        written["box"] = {
            {"min", write_cell(region.box->min)}, {"max", write_cell(region.box->max)}};
    }
    if (!region.cells.empty()) {
        OrderedJson cells = OrderedJson::array();
        for (const Cell& cell : region.cells) {
            cells.push_back(write_cell(cell));
        }
        written["cells"] = std::move(cells);
    }
    if (region.mask) {
        written["mask"] = region.mask->source;
    }
    if (region.voxels) {
        const GridSize size = region.voxels->size;
        written["voxels"] = {
            {"size", OrderedJson::array({size.x, size.y, size.z})},
            {"values", region.voxels->values}};
    }
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
