#pragma once

#include "solver/continuous/example.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace modelsynth::testing {

// { p : normal . p <= offset }
struct HalfSpace {
    continuous::Point normal;
    double offset = 0;
};

// The convex solid that some half-spaces have in common; nothing when it is empty, flat or reaches
// farther than `reach` from the origin along an axis. Half-spaces that make no face are no harm.
inline std::optional<continuous::Polyhedron> make_hull(
    continuous::ObjectId object, std::span<const HalfSpace> given, double reach = 100
) {
    using continuous::Point;
    constexpr double kNear = 1e-9;
    std::vector<HalfSpace> spaces;
    const auto add = [&](const Point& normal, double offset) {
        const double length = normal.norm();
        const HalfSpace space = {normal / length, offset / length};
        const bool is_new = std::none_of(spaces.begin(), spaces.end(), [&](const HalfSpace& other) {
            return (other.normal - space.normal).norm() < kNear &&
                   std::abs(other.offset - space.offset) < kNear;
        });
        if (is_new) {
            spaces.push_back(space);
        }
    };
    for (const HalfSpace& space : given) {
        add(space.normal, space.offset);
    }
    for (int axis = 0; axis < 3; ++axis) {
        add(Point::Unit(axis), reach);
        add(-Point::Unit(axis), reach);
    }

    continuous::Polyhedron hull;
    hull.object = object;
    std::vector<Point>& corners = hull.corners;
    const auto add_corner = [&](const Point& point) {
        const bool is_corner =
            std::all_of(spaces.begin(), spaces.end(), [&](const HalfSpace& space) {
                return space.normal.dot(point) <= space.offset + kNear;
            });
        const bool is_known = std::any_of(corners.begin(), corners.end(), [&](const Point& other) {
            return (other - point).norm() < 2 * kNear;
        });
        if (is_corner && !is_known) {
            corners.push_back(point);
        }
    };
    for (std::size_t a = 0; a < spaces.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            for (std::size_t c = 0; c < b; ++c) {
                Eigen::Matrix3d normals;
                normals << spaces[a].normal.transpose(), spaces[b].normal.transpose(),
                    spaces[c].normal.transpose();
                if (std::abs(normals.determinant()) > 1e-7) {
                    const Point offsets(spaces[a].offset, spaces[b].offset, spaces[c].offset);
                    add_corner(normals.inverse() * offsets);
                }
            }
        }
    }
    for (const Point& corner : corners) {
        if (corner.cwiseAbs().maxCoeff() > reach - 1) {
            return std::nullopt;
        }
    }

    for (const HalfSpace& space : spaces) {
        continuous::Face face;
        Point middle = Point::Zero();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            if (std::abs(space.normal.dot(corners[i]) - space.offset) < 2 * kNear) {
                face.push_back(static_cast<std::uint32_t>(i));
                middle += corners[i];
            }
        }
        if (face.size() < 3) {
            continue;
        }
        middle /= static_cast<double>(face.size());
        const Point right = space.normal.unitOrthogonal();
        const Point up = space.normal.cross(right);
        const auto angle = [&](std::uint32_t corner) {
            const Point away = corners[corner] - middle;
            return std::atan2(away.dot(up), away.dot(right));
        };
        std::sort(face.begin(), face.end(), [&](std::uint32_t a, std::uint32_t b) {
            return angle(a) < angle(b);
        });
        hull.faces.push_back(std::move(face));
    }
    if (hull.faces.size() < 4) {
        return std::nullopt;
    }
    return hull;
}

}  // namespace modelsynth::testing
