#include "solver/continuous/parameters.h"

#include "solver/continuous/reading.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

// Blocks reach through the whole height up to so many spacings.
constexpr std::int32_t kFullHeightMax = 16;

// So many places where three planes meet, some of them the same, are looked at.
constexpr double kMeetingsMax = 32e6;

std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}

// How often three planes meet in the model, counted by volumes.
double meetings(const ExampleReading& reading, const Parameters& parameters) {
    const std::span<const Point> n = reading.topes().normals();
    const std::array<double, 3>& size = *parameters.size;
    const double s = *parameters.spacing;
    double sum = 0;
    for (std::size_t a = 0; a < n.size(); ++a) {
        for (std::size_t b = a + 1; b < n.size(); ++b) {
            for (std::size_t c = b + 1; c < n.size(); ++c) {
                sum += std::abs(n[a].dot(n[b].cross(n[c])));
            }
        }
    }
    return sum * size[0] * size[1] * size[2] / (s * s * s);
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
    if (!parameters.dimensions) {
        parameters.dimensions.emplace();
        for (const Dimension& dimension : example.dimensions) {
            parameters.dimensions->push_back(
                {example.objects[dimension.object - 1U].name,
                 {dimension.normal.x(), dimension.normal.y(), dimension.normal.z()}}
            );
        }
    }
    if (!parameters.blocks) {
        Blocks blocks;
        const std::int32_t height = cells_of(parameters).y;
        blocks.layout.size.y = height <= kFullHeightMax ? height : blocks.layout.size.y;
        parameters.blocks = blocks;
    }
    return parameters;
}

std::vector<Fault> find_faults(const ExampleReading& reading, const Parameters& parameters) {
    std::vector<Fault> faults;
    const auto check_object = [&](const std::string& pointer, const std::string& name) {
        if (find_object(reading.example(), name) == kEmpty) {
            faults.push_back({pointer, "the example has no object \"" + name + "\""});
        }
    };
    for (const auto& [name, weight] : parameters.weights) {
        check_object("/weights", name);
    }
    for (std::size_t i = 0; i < parameters.dimensions->size(); ++i) {
        const DimensionRule& rule = (*parameters.dimensions)[i];
        const std::string pointer = "/constraints/" + std::to_string(i);
        check_object(pointer + "/object", rule.object);
        const Point normal(rule.normal[0], rule.normal[1], rule.normal[2]);
        const bool has_length = normal.norm() > 1e-9;  // else that is a fault of its own
        if (has_length && !reading.topes().find_family(normal)) {
            faults.push_back(
                {pointer + "/normal", "no face of the example has this normal or its opposite"}
            );
        }
    }
    const GridSize cells = cells_of(parameters);
    const std::int32_t longest = std::max({cells.x, cells.y, cells.z});
    const double count = meetings(reading, parameters);
    if (longest > kCellsAlongMax) {
        faults.push_back(
            {"/size",
             "is more than " + std::to_string(kCellsAlongMax) + " times the spacing of " +
                 number(*parameters.spacing) + " metres",
             true}
        );
    } else if (count > kMeetingsMax) {
        faults.push_back(
            {"/size",
             "the planes of the model would meet in some " + number(std::round(count / 1e6)) +
                 " million points, more than " + number(kMeetingsMax / 1e6) +
                 " million; a wider spacing or a smaller size helps",
             true}
        );
    }
    return faults;
}

}  // namespace modelsynth::continuous
