#include "solver/continuous/parameters.h"

#include "solver/continuous/example.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

// Blocks reach through the whole height up to so many spacings.
constexpr std::int32_t kFullHeightMax = 16;

std::vector<Constraint> constraints_of(const Example& example) {
    std::vector<Constraint> constraints = example.constraints;
    for (const Dimension& dimension : example.dimensions) {
        const Point& n = dimension.normal;
        constraints.push_back(
            {DimensionRule{{n.x(), n.y(), n.z()}}, {example.objects[dimension.object - 1U].name}}
        );
    }
    for (const std::vector<ObjectId>& objects : example.connected) {
        Constraint& constraint = constraints.emplace_back(Constraint{ConnectedRule{}});
        for (const ObjectId object : objects) {
            constraint.objects.push_back(example.objects[object - 1U].name);
        }
    }
    return constraints;
}

// Those of the example whose kind the request does not speak of.
void add_constraints_of(const Example& example, Parameters& parameters) {
    const std::vector<Constraint> given =
        parameters.constraints.value_or(std::vector<Constraint>());
    parameters.constraints = given;
    for (Constraint& own : constraints_of(example)) {
        const bool is_spoken_of = std::any_of(given.begin(), given.end(), [&](const auto& other) {
            return other.rule.index() == own.rule.index();
        });
        if (!is_spoken_of) {
            parameters.constraints->push_back(std::move(own));
        }
    }
}

}  // namespace

GridSize cells_of(const Parameters& parameters) {
    const auto cells = [&](double length) {
        const double count = std::ceil(length / *parameters.spacing - 1e-6);
        return static_cast<std::int32_t>(std::clamp(count, 1.0, 1e9));
    };
    const std::array<double, 3>& size = *parameters.size;
    return {cells(size[0]), cells(size[1]), cells(size[2])};
}

Parameters fill_defaults(Parameters parameters, const Example& example) {
    if (!parameters.size) {
        parameters.size = example.size;
    }
    if (!parameters.spacing) {
        parameters.spacing = example.spacing;
    }
    if (!parameters.density) {
        parameters.density = example.density;
    }
    if (!parameters.constraints || !parameters.constraints->empty()) {
        add_constraints_of(example, parameters);
    }
    if (!parameters.blocks) {
        Blocks blocks = kDefaultBlocks;
        const std::int32_t height = cells_of(parameters).y;
        blocks.layout.size.y = height <= kFullHeightMax ? height : blocks.layout.size.y;
        parameters.blocks = blocks;
    }
    return parameters;
}

}  // namespace modelsynth::continuous
