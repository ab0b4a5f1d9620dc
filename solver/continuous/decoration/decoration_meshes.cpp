#include "solver/continuous/decoration/decoration_meshes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

namespace modelsynth::continuous {

namespace {

Point normal_of(const SweptMesh& mesh, const Face& face) {
    const Point& origin = mesh.corners[face.front()];
    Point area = Point::Zero();
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        area += (mesh.corners[face[i]] - origin).cross(mesh.corners[face[i + 1]] - origin);
    }
    return area.normalized();
}

}  // namespace

SweptMesh mesh_of(const Sweep& sweep) {
    std::vector<ProfilePoint> profile = sweep.decoration->profile;
    if (signed_area(profile) < 0) {
        std::reverse(profile.begin(), profile.end());
    }
    SweptMesh mesh;
    for (const SweepEnd& end : sweep.ends) {
        for (const auto& [p, q] : profile) {
            mesh.corners.push_back(end.at + (p * end.of_p + q * end.of_q));
        }
    }
    const auto count = static_cast<std::uint32_t>(profile.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        mesh.faces.push_back({i, next, count + next, count + i});
    }
    Face cap(count);
    if (!sweep.ends[1].is_mitred) {
        std::iota(cap.begin(), cap.end(), count);
        mesh.faces.push_back(cap);
    }
    if (!sweep.ends[0].is_mitred) {
        std::iota(cap.rbegin(), cap.rend(), 0U);
        mesh.faces.push_back(cap);
    }
    for (const Face& face : mesh.faces) {
        mesh.normals.push_back(normal_of(mesh, face));
    }
    return mesh;
}

std::size_t triangle_count(const Sweep& sweep) {
    const std::size_t count = sweep.decoration->profile.size();
    std::size_t triangles = 2 * count;
    for (const SweepEnd& end : sweep.ends) {
        triangles += end.is_mitred ? 0 : count - 2;
    }
    return triangles;
}

std::vector<ShapeCorner> triangles_of(const PlacedMesh& mesh) {
    std::vector<ShapeCorner> corners = triangles_of(*mesh.decoration->mesh);
    const Point& x = mesh.outwards;
    const Point z = x.cross(Point::UnitY());
    const auto turned = [&](const Point& p) {
        return Point(p.x() * x + p.y() * Point::UnitY() + p.z() * z);
    };
    for (ShapeCorner& corner : corners) {
        corner.place = mesh.at + turned(corner.place);
        corner.normal = turned(corner.normal);
    }
    return corners;
}

Point place_of(const Sweep& sweep) { return (sweep.ends[0].at + sweep.ends[1].at) / 2; }

bool is_in_part(const Point& place, const Bounds& part) {
    return (place.array() >= part.min.array()).all() && (place.array() < part.max.array()).all();
}

}  // namespace modelsynth::continuous
