#include "solver/continuous/reading/solids.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace modelsynth::continuous {

namespace {

// The solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
double solid_angle(const Point& a, const Point& b, const Point& c) {
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    const double spanned = a.dot(b.cross(c));
    const double rest = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    return 2 * std::atan2(spanned, rest);
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Point along = b - a;
    const double length = along.squaredNorm();
    const double t = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0;
    return (a + t * along - p).norm();
}

}  // namespace

Solids::Solids(const Example& example) : example_(example) {
    for (const Polyhedron& solid : example.polyhedra) {
        Box box = {solid.corners.front(), solid.corners.front()};
        for (const Point& corner : solid.corners) {
            box.min = box.min.cwiseMin(corner);
            box.max = box.max.cwiseMax(corner);
        }
        boxes_.push_back(box);
    }
}

double Solids::winding(std::size_t solid, const Point& point) const {
    const Polyhedron& polyhedron = example_.polyhedra[solid];
    double sum = 0;
    for (const Face& face : polyhedron.faces) {
        const Point origin = polyhedron.corners[face.front()] - point;
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            sum += solid_angle(
                origin, polyhedron.corners[face[i]] - point, polyhedron.corners[face[i + 1]] - point
            );
        }
    }
    return sum / (4 * std::numbers::pi);
}

ObjectId Solids::at(const Point& point) const {
    for (std::size_t solid = example_.polyhedra.size(); solid-- > 0;) {
        const Box& box = boxes_[solid];
        const bool may_hold =
            (point.array() > box.min.array()).all() && (point.array() < box.max.array()).all();
        if (may_hold && winding(solid, point) > 0.5) {
            return example_.polyhedra[solid].object;
        }
    }
    return example_.ground && point.y() < 0 ? *example_.ground : kEmpty;
}

double Solids::distance(std::size_t solid, std::size_t face, const Point& point) const {
    const Polyhedron& polyhedron = example_.polyhedra[solid];
    const Face& corners = polyhedron.faces[face];
    const Point normal = area_vector(polyhedron, corners).normalized();
    const Point right = normal.unitOrthogonal();
    const Point up = normal.cross(right);
    // Crossings of the face's border with a ray to the right of the point's foot.
    bool is_inside = false;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point& a = polyhedron.corners[corners[i]];
        const Point& b = polyhedron.corners[corners[(i + 1) % corners.size()]];
        nearest = std::min(nearest, distance_to_segment(point, a, b));
        const double ay = (a - point).dot(up);
        const double by = (b - point).dot(up);
        if ((ay > 0) != (by > 0)) {
            const double ax = (a - point).dot(right);
            const double bx = (b - point).dot(right);
            is_inside = is_inside != (ax + (bx - ax) * ay / (ay - by) > 0);
        }
    }
    const double height = std::abs((point - polyhedron.corners[corners.front()]).dot(normal));
    return is_inside ? std::min(nearest, height) : nearest;
}

}  // namespace modelsynth::continuous
