#include "solver/examples/solids/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace modelsynth::examples {

namespace {

using continuous::Face;
using continuous::ObjectId;
using continuous::Point;
using continuous::Polyhedron;

// `place(u, v, w)` puts a point of the outline at depth w. Requires: (u, v, w) is right-handed as
// placed.
template <class Place>
Polyhedron prism(ObjectId object, const Outline& outline, double w0, double w1, Place place) {
    Polyhedron solid;
    solid.object = object;
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double w : {w0, w1}) {
        for (const auto& [u, v] : outline) {
            solid.corners.push_back(place(u, v, w));
        }
    }
    Face near;
    Face far;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        solid.faces.push_back({i, next, count + next, count + i});
        near.push_back(count - 1 - i);
        far.push_back(count + i);
    }
    solid.faces.push_back(std::move(near));
    solid.faces.push_back(std::move(far));
    return solid;
}

float linear(std::uint32_t part) {
    const double srgb = part / 255.0;
    return static_cast<float>(
        srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4)
    );
}

}  // namespace

Polyhedron box(ObjectId object, const Point& min, const Point& max) {
    const Outline outline = {
        {min.x(), min.y()}, {max.x(), min.y()}, {max.x(), max.y()}, {min.x(), max.y()}};
    return prism_along_z(object, outline, min.z(), max.z());
}

Polyhedron prism_along_z(ObjectId object, const Outline& outline, double z0, double z1) {
    return prism(object, outline, z0, z1, [](double u, double v, double w) {
        return Point(u, v, w);
    });
}

Polyhedron prism_along_x(ObjectId object, const Outline& outline, double x0, double x1) {
    return prism(object, outline, -x1, -x0, [](double u, double v, double w) {
        return Point(-w, v, u);
    });
}

Polyhedron prism_upwards(ObjectId object, const Outline& outline, double y0, double y1) {
    return prism(object, outline, y0, y1, [](double u, double v, double w) {
        return Point(u, w, -v);
    });
}

Polyhedron pyramid(ObjectId object, const Outline& outline, double y0, const Point& apex) {
    Polyhedron solid;
    solid.object = object;
    const auto count = static_cast<std::uint32_t>(outline.size());
    Face base;
    for (std::uint32_t i = 0; i < count; ++i) {
        solid.corners.emplace_back(outline[i][0], y0, -outline[i][1]);
        solid.faces.push_back({i, (i + 1) % count, count});
        base.push_back(count - 1 - i);
    }
    solid.corners.push_back(apex);
    solid.faces.push_back(std::move(base));
    return solid;
}

Polyhedron tapered(ObjectId object, const Point& min, const Point& max, const Insets& insets) {
    Polyhedron solid = box(object, min, max);
    for (Point& corner : solid.corners) {
        if (corner.y() == max.y()) {
            corner.x() += corner.x() == min.x() ? insets.west : -insets.east;
            corner.z() += corner.z() == min.z() ? insets.north : -insets.south;
        }
    }
    return solid;
}

Polyhedron hip_roof(ObjectId object, const Point& min, const Point& max) {
    const double length = max.x() - min.x();
    const double depth = max.z() - min.z();
    const double rise = std::min(length, depth) / 2;
    const double top = min.y() + rise;
    if (length == depth) {
        const Outline square = {
            {min.x(), -max.z()}, {max.x(), -max.z()}, {max.x(), -min.z()}, {min.x(), -min.z()}};
        return pyramid(object, square, min.y(), {min.x() + rise, top, min.z() + rise});
    }
    Polyhedron solid;
    solid.object = object;
    solid.corners = {
        {min.x(), min.y(), min.z()},
        {min.x(), min.y(), max.z()},
        {max.x(), min.y(), max.z()},
        {max.x(), min.y(), min.z()},
        {min.x() + rise, top, min.z() + rise},
        {max.x() - rise, top, max.z() - rise}};
    if (length > depth) {
        solid.faces = {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 5, 4}, {2, 3, 5}, {3, 0, 4, 5}};
    } else {
        solid.faces = {{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 5}, {2, 3, 4, 5}, {3, 0, 4}};
    }
    return solid;
}

Polyhedron moved(Polyhedron solid, const Point& by) {
    for (Point& corner : solid.corners) {
        corner += by;
    }
    return solid;
}

void Blocks::add(ObjectId object, const Point& min, const Point& max) {
    std::vector<Block> kept;
    for (Block block : blocks_) {
        const bool overlaps =
            (block.min.array() < max.array()).all() && (min.array() < block.max.array()).all();
        // What is left of it is cut off side by side.
        for (int axis = 0; overlaps && axis < 3; ++axis) {
            if (block.min[axis] < min[axis]) {
                kept.push_back(block);
                kept.back().max[axis] = block.min[axis] = min[axis];
            }
            if (max[axis] < block.max[axis]) {
                kept.push_back(block);
                kept.back().min[axis] = block.max[axis] = max[axis];
            }
        }
        if (!overlaps) {
            kept.push_back(block);
        }
    }
    kept.push_back({object, min, max});
    blocks_ = std::move(kept);
}

void Blocks::append_to(std::vector<Polyhedron>& solids) const {
    for (const Block& block : blocks_) {
        solids.push_back(box(block.object, block.min, block.max));
    }
}

Color color(std::uint32_t srgb) {
    return {linear(srgb >> 16 & 0xFF), linear(srgb >> 8 & 0xFF), linear(srgb & 0xFF)};
}

}  // namespace modelsynth::examples
