#include "solver/continuous/decoration/decoration.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

double cross(const ProfilePoint& origin, const ProfilePoint& a, const ProfilePoint& b) {
    return (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
}

struct Segment {
    ProfilePoint from;
    ProfilePoint to;
};

double distance_to(const Segment& segment, const ProfilePoint& point) {
    const double x = segment.to[0] - segment.from[0];
    const double y = segment.to[1] - segment.from[1];
    const double squared_length = x * x + y * y;
    const double along =
        squared_length > 0
            ? ((point[0] - segment.from[0]) * x + (point[1] - segment.from[1]) * y) / squared_length
            : 0;
    const double share = std::clamp(along, 0.0, 1.0);
    return std::hypot(
        segment.from[0] + share * x - point[0], segment.from[1] + share * y - point[1]
    );
}

bool is_near(const Segment& a, const Segment& b, double tolerance) {
    const bool crosses_a = (cross(a.from, a.to, b.from) > 0) != (cross(a.from, a.to, b.to) > 0);
    const bool crosses_b = (cross(b.from, b.to, a.from) > 0) != (cross(b.from, b.to, a.to) > 0);
    return (crosses_a && crosses_b) || distance_to(a, b.from) <= tolerance ||
           distance_to(a, b.to) <= tolerance || distance_to(b, a.from) <= tolerance ||
           distance_to(b, a.to) <= tolerance;
}

}  // namespace

double signed_area(const std::vector<ProfilePoint>& profile) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
        area += cross(profile[0], profile[i], profile[i + 1]) / 2;
    }
    return area;
}

bool is_simple(const std::vector<ProfilePoint>& profile) {
    const std::size_t count = profile.size();
    double extent = 0;
    for (const ProfilePoint& point : profile) {
        extent = std::max(
            {extent, std::abs(point[0] - profile[0][0]), std::abs(point[1] - profile[0][1])}
        );
    }
    const double tolerance = 1e-6 * extent;
    const auto side = [&](std::size_t i) {
        return Segment{profile[i % count], profile[(i + 1) % count]};
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Segment here = side(i);
        const Segment next = side(i + 1);
        // Neighbours have one point in common, and nothing else.
        if (distance_to(next, here.from) <= tolerance || distance_to(here, next.to) <= tolerance) {
            return false;
        }
        for (std::size_t k = i + 2; k < count && k + 1 < count + i; ++k) {
            if (is_near(here, side(k), tolerance)) {
                return false;
            }
        }
    }
    return count >= 3 && std::abs(signed_area(profile)) > tolerance * extent;
}

}  // namespace modelsynth::continuous
