#include "proto/region_codec.h"

#include "proto/image_mask.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::proto {

namespace {

using discrete::Region;

constexpr std::size_t kCellsMax = 100'000;

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

}  // namespace

std::optional<Voxels> read_voxels(const Value& value, const RequestLimits& limits) {
    ObjectReader reader(value);
    const auto size_value = reader.required("size");
    const auto values_value = reader.required("values");
    reader.finish();
    const auto size = size_value ? size_value->cell(1, limits.extent_max) : std::nullopt;
    const auto values = values_value ? values_value->array(1, limits.voxels_max) : std::nullopt;
    if (!size || !values) {
        return std::nullopt;
    }
    Voxels voxels = {{size->x, size->y, size->z}, {}};
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

std::optional<Mask> read_mask(const Value& value, const RequestLimits& limits) {
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
    return Mask{image->width, image->height, std::move(image->values), text};
}

std::optional<std::vector<Value>> constraint_values(
    const Value& list, const RequestLimits& limits
) {
    auto values = list.array(0, limits.constraints_max);
    const auto more_than = [&](std::size_t most, const char* what, const char* limit, auto is_one) {
        const bool is_more = values && std::count_if(values->begin(), values->end(), is_one) >
                                           static_cast<std::ptrdiff_t>(most);
        if (is_more) {
            list.fault(
                "has more than " + std::to_string(most) + " " + what + "; the limit is " + limit,
                true
            );
        }
        return is_more;
    };
    const auto has_mask = [](const Value& one) {
        return one.json().is_object() && one.json().contains("mask");
    };
    const auto is_symmetry = [](const Value& one) {
        return one.json().is_object() && one.json().value("kind", Json()) == "symmetry";
    };
    if (more_than(limits.masks_max, "masks", "masks_max", has_mask) ||
        more_than(limits.symmetries_max, "symmetries", "symmetries_max", is_symmetry)) {
        return std::nullopt;
    }
    return values;
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
    write_fields(region.mask, region.voxels, written);
}

void write_fields(
    const std::optional<Mask>& mask, const std::optional<Voxels>& voxels, OrderedJson& written
) {
    if (mask) {
        written["mask"] = mask->source;
    }
    if (voxels) {
        written["voxels"] = {
            {"size", OrderedJson::array({voxels->size.x, voxels->size.y, voxels->size.z})},
            {"values", voxels->values}};
    }
}

}  // namespace modelsynth::proto
