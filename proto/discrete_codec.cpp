#include "proto/discrete_codec.h"

#include "proto/blocks_codec.h"
#include "proto/constraint_codec.h"

#include <algorithm>
#include <utility>

namespace modelsynth::proto {

namespace {

using discrete::BoundaryKind;
using discrete::Parameters;
using discrete::SideBoundary;

void read_size(const Value& value, const RequestLimits& limits, Parameters& parameters) {
    const auto size = value.cell(1, limits.extent_max);
    if (!size) {
        return;
    }
    parameters.size = GridSize{size->x, size->y, size->z};
    if (parameters.size->cell_count() > limits.model_cells_max) {
        value.fault(
            "asks for " + std::to_string(parameters.size->cell_count()) +
                " cells; the limit model_cells_max is " + std::to_string(limits.model_cells_max),
            true
        );
    }
}

void read_weights(const Value& value, const RequestLimits& limits, Parameters& parameters) {
    if (!value.json().is_object()) {
        if (value.json().is_string()) {
            if (const auto rule = value.one_of({"uniform", "example"})) {
                parameters.weights =
                    *rule == 0 ? discrete::WeightRule::kUniform : discrete::WeightRule::kExample;
            }
        } else {
            value.fault("must be \"uniform\", \"example\" or an object of weights by piece");
        }
        return;
    }
    discrete::WeightList list;
    for (const auto& [name, json] : value.json().items()) {
        const Value weight(json, value.pointer() + "/" + pointer_part(name), value.faults());
        if (count_characters(name) > limits.name_characters_max) {
            weight.fault("the name is too long");
        } else if (const auto number = weight.number(0, 1e6)) {
            list.emplace_back(name, *number);
        }
    }
    parameters.weights = std::move(list);
}

// The names of orders; "scan" is by columns, the others by the axes from the slowest to the
// fastest.
struct NamedOrder {
    const char* name;
    discrete::CellOrder order;
};

constexpr std::array<NamedOrder, 11> kOrders = {{
    {"scan", {Order::kScan}},
    {"min_entropy", {Order::kMinEntropy}},
    {"random", {Order::kRandom}},
    {"fewest_labels", {Order::kFewestLabels}},
    {"growth", {Order::kGrowth}},
    {"auto", {Order::kScan, discrete::kColumns, true}},
    {"scan_xyz", {Order::kScan, {0, 1, 2}}},
    {"scan_yxz", {Order::kScan, {1, 0, 2}}},
    {"scan_yzx", {Order::kScan, {1, 2, 0}}},
    {"scan_zxy", {Order::kScan, {2, 0, 1}}},
    {"scan_zyx", {Order::kScan, {2, 1, 0}}},
}};

discrete::CellOrder read_order(const Value& value) {
    std::array<const char*, kOrders.size()> names = {};
    std::transform(kOrders.begin(), kOrders.end(), names.begin(), [](const NamedOrder& order) {
        return order.name;
    });
    return kOrders.at(value.one_of(names).value_or(0)).order;
}

OrderedJson write_weights(const discrete::Weights& weights) {
    if (const auto* rule = std::get_if<discrete::WeightRule>(&weights)) {
        return *rule == discrete::WeightRule::kUniform ? "uniform" : "example";
    }
    OrderedJson list = OrderedJson::object();
    for (const auto& [name, weight] : std::get<discrete::WeightList>(weights)) {
        list[name] = weight;
    }
    return list;
}

}  // namespace

const char* order_name(const discrete::CellOrder& order) {
    const auto named = std::find_if(kOrders.begin(), kOrders.end(), [&](const NamedOrder& one) {
        return one.order == order;
    });
    check(named != kOrders.end(), "an order without a name");
    return named->name;
}

std::optional<SideBoundary> read_side(const Value& value, const RequestLimits& limits) {
    if (value.json().is_array()) {
        auto pieces = value.strings(1, limits.pieces_max, limits.name_characters_max);
        if (!pieces) {
            return std::nullopt;
        }
        return SideBoundary{BoundaryKind::kPieces, std::move(*pieces)};
    }
    auto text = value.string(limits.name_characters_max);
    if (!text) {
        return std::nullopt;
    }
    if (*text == "free") {
        return SideBoundary{BoundaryKind::kFree, {}};
    }
    if (*text == "example") {
        return SideBoundary{BoundaryKind::kExample, {}};
    }
    if (*text == "periodic") {
        return SideBoundary{BoundaryKind::kPeriodic, {}};
    }
    return SideBoundary{BoundaryKind::kPieces, {std::move(*text)}, false};
}

OrderedJson write_side(const SideBoundary& side) {
    switch (side.kind) {
        case BoundaryKind::kFree:
            return "free";
        case BoundaryKind::kExample:
            return "example";
        case BoundaryKind::kPeriodic:
            return "periodic";
        case BoundaryKind::kPieces:
            return side.pieces;
    }
    return "free";
}

Parameters read_parameters(const Value& value, const RequestLimits& limits, Parameters parameters) {
    ObjectReader reader(value);
    if (const auto size = reader.optional("size")) {
        read_size(*size, limits, parameters);
    }
    if (const auto blocks = reader.optional("blocks")) {
        parameters.blocks.emplace(read_blocks(*blocks, limits, {}));
    }
    if (const auto boundary = reader.optional("boundary")) {
        ObjectReader sides(*boundary);
        for (std::size_t side = 0; side < kDirectionCount; ++side) {
            if (const auto given = sides.optional(discrete::kSideNames[side])) {
                parameters.boundary[side] = read_side(*given, limits);
            }
        }
        sides.finish();
    }
    if (const auto order = reader.optional("order")) {
        parameters.order = read_order(*order);
    }
    if (const auto weights = reader.optional("weights")) {
        read_weights(*weights, limits, parameters);
    }
    if (const auto constraints = reader.optional("constraints")) {
        parameters.constraints = read_constraints(*constraints, limits);
    }
    reader.finish();
    return parameters;
}

OrderedJson write_parameters(const Parameters& parameters) {
    const GridSize size = *parameters.size;
    OrderedJson boundary = OrderedJson::object();
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        boundary[discrete::kSideNames[side]] = write_side(*parameters.boundary[side]);
    }
    return {
        {"size", OrderedJson::array({size.x, size.y, size.z})},
        {"blocks", write_blocks(*parameters.blocks)},
        {"boundary", std::move(boundary)},
        {"order", order_name(parameters.order)},
        {"weights", write_weights(*parameters.weights)},
        {"constraints", write_constraints(parameters.constraints)}};
}

}  // namespace modelsynth::proto
