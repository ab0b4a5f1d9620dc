#include "proto/continuous_codec.h"

#include "proto/blocks_codec.h"

#include <utility>

namespace modelsynth::proto {

namespace {

using continuous::DimensionRule;
using continuous::Parameters;
using continuous::Point;

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

void read_constraints(const Value& value, const RequestLimits& limits, Parameters& parameters) {
    parameters.dimensions.emplace();
    const auto values = value.array(0, limits.constraints_max);
    if (!values) {
        return;
    }
    for (const Value& constraint : *values) {
        DimensionRule rule;
        ObjectReader reader(constraint);
        if (const auto kind = reader.required("kind")) {
            static_cast<void>(kind->one_of({"dimension"}));
        }
        if (const auto object = reader.required("object")) {
            rule.object = object->string(limits.name_characters_max).value_or("");
        }
        if (const auto normal = reader.required("normal")) {
            const auto direction = read_point(*normal, kMetresMax);
            if (direction && direction->norm() < 1e-9) {
                normal->fault("must have a length");
            }
            if (direction) {
                rule.normal = {direction->x(), direction->y(), direction->z()};
            }
        }
        reader.finish();
        parameters.dimensions->push_back(std::move(rule));
    }
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
        read_constraints(*constraints, limits, parameters);
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
    for (const DimensionRule& rule : *parameters.dimensions) {
        constraints.push_back(
            {{"kind", "dimension"}, {"object", rule.object}, {"normal", rule.normal}}
        );
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
