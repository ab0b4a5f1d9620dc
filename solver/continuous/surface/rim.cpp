#include "solver/continuous/surface/rim.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <optional>

namespace modelsynth::continuous {

namespace {

// Corner i is at the larger end of axis a where bit a of i is set.
Point corner_of(const Bounds& box, unsigned corner) {
    Point point;
    for (unsigned axis = 0; axis < 3; ++axis) {
        point[axis] = (corner >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
    }
    return point;
}

struct BoxEdge {
    unsigned low = 0;  // its corner at the smaller end of its axis
    unsigned axis = 0;

    friend bool operator==(const BoxEdge&, const BoxEdge&) = default;
};

constexpr BoxSide side_of(unsigned corner, unsigned axis) {
    return static_cast<BoxSide>(2 * axis + (corner >> axis & 1));
}

// The edges of a side.
std::array<BoxEdge, 4> edges_of(BoxSide side) {
    const unsigned axis = side / 2U;
    const unsigned a = (axis + 1) % 3;
    const unsigned b = (axis + 2) % 3;
    const unsigned base = (side & 1U) << axis;
    return {
        BoxEdge{base, a}, BoxEdge{base, b}, BoxEdge{base | 1U << a, b}, BoxEdge{base | 1U << b, a}};
}

BoxSide other_side(const BoxEdge& edge, BoxSide side) {
    const unsigned a = (edge.axis + 1) % 3;
    const unsigned b = (edge.axis + 2) % 3;
    const BoxSide first = side_of(edge.low, a);
    return first == side ? side_of(edge.low, b) : first;
}

double twice_area(const std::vector<Point>& corners, const Point& normal) {
    Point sum = Point::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    }
    return sum.dot(normal);
}

}  // namespace

Point normal_of(BoxSide side) {
    Point normal = Point::Zero();
    normal[side / 2] = side % 2 == 0 ? -1 : 1;
    return normal;
}

Rim rim_of(const Bounds& box, BoxSide side) {
    const unsigned axis = side / 2U;
    const unsigned a = (axis + 1) % 3;
    const unsigned b = (axis + 2) % 3;
    const unsigned base = (side & 1U) << axis;
    std::array<unsigned, 4> around = {
        base, base | 1U << a, base | 1U << a | 1U << b, base | 1U << b};
    if (side % 2 == 0) {
        std::reverse(around.begin(), around.end());
    }
    Rim rim;
    for (std::size_t i = 0; i < around.size(); ++i) {
        const unsigned both = around[i] & around[(i + 1) % 4];
        const unsigned either = around[i] | around[(i + 1) % 4];
        rim.corners.push_back(corner_of(box, around[i]));
        // Beside the side's own axis there is one along which both lie at the same end.
        const unsigned same = (either & ~both) == 1U << a ? b : a;
        rim.sides.push_back(side_of(around[i], same));
    }
    return rim;
}

Rim rim_of(const Bounds& box, const Point& normal, double offset) {
    // A corner on the plane counts as above it: so a rim is whole, though it may have equal
    // corners.
    const double tolerance = 1e-9 * (box.max - box.min).maxCoeff();
    std::array<double, 8> heights = {};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const double height = normal.dot(corner_of(box, corner)) - offset;
        heights[corner] = std::abs(height) <= tolerance ? 0 : height;
    }
    const auto is_crossed = [&](const BoxEdge& edge) {
        return (heights[edge.low] < 0) != (heights[edge.low | 1U << edge.axis] < 0);
    };
    const auto crossing = [&](const BoxEdge& edge) {
        const double low = heights[edge.low];
        const double high = heights[edge.low | 1U << edge.axis];
        Point point = corner_of(box, edge.low);
        const double share = low / (low - high);
        point[edge.axis] += share * (box.max[edge.axis] - box.min[edge.axis]);
        return point;
    };
    for (BoxSide side = 0; side < kBoxSides; ++side) {
        const std::array<BoxEdge, 4> edges = edges_of(side);
        const bool is_this = std::all_of(edges.begin(), edges.end(), [&](const BoxEdge& edge) {
            return heights[edge.low] == 0 && heights[edge.low | 1U << edge.axis] == 0;
        });
        if (is_this) {
            return {};
        }
    }
    std::optional<BoxEdge> first;
    BoxSide side = 0;
    for (BoxSide s = 0; s < kBoxSides && !first; ++s) {
        for (const BoxEdge& edge : edges_of(s)) {
            if (!first && is_crossed(edge)) {
                first = edge;
                side = s;
            }
        }
    }
    Rim rim;
    if (!first) {
        return rim;
    }
    BoxEdge at = *first;
    do {
        BoxEdge next = at;
        for (const BoxEdge& edge : edges_of(side)) {
            next = is_crossed(edge) && !(edge == at) ? edge : next;
        }
        rim.corners.push_back(crossing(at));
        rim.sides.push_back(side);
        side = other_side(next, side);
        at = next;
    } while (!(at == *first));
    const double area = twice_area(rim.corners, normal);
    if (std::abs(area) <= tolerance * (box.max - box.min).maxCoeff()) {
        return {};
    }
    if (area < 0) {
        std::reverse(rim.corners.begin(), rim.corners.end());
        // The side after a corner was the one before it.
        std::reverse(rim.sides.begin(), rim.sides.end());
        std::rotate(rim.sides.begin(), rim.sides.begin() + 1, rim.sides.end());
    }
    return rim;
}

}  // namespace modelsynth::continuous
