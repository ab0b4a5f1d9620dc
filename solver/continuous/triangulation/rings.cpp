#include "solver/continuous/triangulation/rings.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace modelsynth::continuous::rings {

namespace {

// An edge at a place: the corner from which it leaves, here or at its other end.
struct Spoke {
    double angle = 0;  // grows with the angle, 0 ... 4
    bool leaves = false;
    std::uint32_t corner = kNone;
};

Spoke make_spoke(const Point2& hub, const Point2& end, bool leaves, std::uint32_t corner) {
    const double x = end[0] - hub[0];
    const double y = end[1] - hub[1];
    const double share = x / (std::abs(x) + std::abs(y));
    return {y >= 0 ? 1 - share : 3 + share, leaves, corner};
}

// Links the edges that arrive at a place to those that leave it so that corners face the inside:
// counter-clockwise, an edge that leaves is followed by the one that arrives at the same corner.
// Shape: `spokes` has as many of one kind as of the other.
void link_facing(std::vector<Spoke>& spokes, Corners& corners) {
    std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
        return std::tie(a.angle, a.leaves, a.corner) < std::tie(b.angle, b.leaves, b.corner);
    });
    std::vector<std::uint32_t> open;
    // Once more for what is before the first edge that leaves.
    for (const bool is_first : {true, false}) {
        for (Spoke& spoke : spokes) {
            if (spoke.leaves && is_first) {
                open.push_back(spoke.corner);
            } else if (!spoke.leaves && spoke.corner != kNone && !open.empty()) {
                link(corners, spoke.corner, open.back());
                open.pop_back();
                spoke.corner = kNone;
            }
        }
    }
}

}  // namespace

double tolerance_for(std::span<const Point2> points, const Loop& vertices) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    Point2 min = {kLargest, kLargest};
    Point2 max = {-kLargest, -kLargest};
    for (const std::uint32_t vertex : vertices) {
        for (const std::size_t axis : {0U, 1U}) {
            min[axis] = std::min(min[axis], points[vertex][axis]);
            max[axis] = std::max(max[axis], points[vertex][axis]);
        }
    }
    const double largest = std::max({1e4, -min[0], -min[1], max[0], max[1]});
    const double extent = std::max(max[0] - min[0], max[1] - min[1]);
    return std::min(1e-12 * largest, 1e-6 * extent);
}

std::vector<std::uint32_t> find_places(
    std::span<const Point2> points, const Loop& vertices, Places& places
) {
    std::vector<std::uint32_t> order(vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(points[vertices[a]], a) < std::tie(points[vertices[b]], b);
    });
    std::vector<std::uint32_t> result(vertices.size());
    for (const std::uint32_t i : order) {
        const Point2& point = points[vertices[i]];
        std::size_t place = places.at.size();
        bool is_known = false;
        while (!is_known && place > 0 && point[0] - places.at[place - 1][0] <= places.tolerance) {
            --place;
            is_known = std::abs(point[1] - places.at[place][1]) <= places.tolerance;
        }
        if (!is_known) {
            place = places.at.size();
            places.at.push_back(point);
            places.number.push_back(vertices[i]);
        }
        places.number[place] = std::min(places.number[place], vertices[i]);
        result[i] = static_cast<std::uint32_t>(place);
    }
    return result;
}

void add_ring(std::span<const std::uint32_t> places, Corners& corners) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] != places[(i + 1) % places.size()]) {
            corners.push_back({places[i], kNone, kNone});
        }
    }
    const auto end = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t corner = first; corner < end; ++corner) {
        link(corners, corner, corner + 1 < end ? corner + 1 : first);
    }
}

void face_inside(const Places& places, Corners& corners) {
    const Corners before = corners;
    std::vector<std::vector<std::uint32_t>> corners_at(places.at.size());
    for (std::uint32_t corner = 0; corner < corners.size(); ++corner) {
        corners_at[before[corner].place].push_back(corner);
    }
    std::vector<Spoke> spokes;
    for (std::size_t place = 0; place < places.at.size(); ++place) {
        if (corners_at[place].size() < 2) {
            continue;
        }
        spokes.clear();
        const auto add = [&](std::uint32_t other, bool leaves, std::uint32_t corner) {
            const Point2& end = places.at[before[other].place];
            spokes.push_back(make_spoke(places.at[place], end, leaves, corner));
        };
        for (const std::uint32_t corner : corners_at[place]) {
            add(before[corner].next, true, corner);
            add(before[corner].prev, false, before[corner].prev);
        }
        link_facing(spokes, corners);
    }
}
}  // namespace modelsynth::continuous::rings
