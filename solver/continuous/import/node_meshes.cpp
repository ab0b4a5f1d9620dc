#include "solver/continuous/import/node_meshes.h"

#include "solver/continuous/check/flat.h"
#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/import/face_merging.h"
#include "solver/continuous/import/half_edges.h"
#include "solver/continuous/import/import_tolerances.h"
#include "solver/continuous/import/welding.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/triangulation/triangulation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace modelsynth::continuous {

namespace {

// More corners than this a face of a shape may not have.
constexpr std::size_t kShapeFaceCornersMax = 64;

struct Welded {
    std::vector<Point> points;
    std::vector<Triangle> triangles;  // those with three different corners
    double extent = 1;

    [[nodiscard]] const Point& start_of(HalfEdge half) const {
        return points[triangles[half / 3][half % 3]];
    }
};

Welded welded(std::vector<Point> places) {
    Welded made;
    Eigen::AlignedBox3d box;
    for (const Point& place : places) {
        box.extend(place);
    }
    made.extent = extent_of(box);
    made.points = std::move(places);
    const std::vector<std::uint32_t> numbers = weld(made.points, kWeldTolerance * made.extent);
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
        const Triangle triangle = {numbers[i], numbers[i + 1], numbers[i + 2]};
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] &&
            triangle[2] != triangle[0]) {
            made.triangles.push_back(triangle);
        }
    }
    return made;
}

bool is_convex(const std::vector<Point2>& corners, double tolerance) {
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 before = minus(corners[(i + 1) % count], corners[i]);
        const Point2 after = minus(corners[(i + 2) % count], corners[(i + 1) % count]);
        if (cross(before, after) < -tolerance * std::hypot(before[0], before[1])) {
            return false;
        }
    }
    return true;
}

// The face, or triangles that fill it where a shape may not have it.
std::vector<Face> convex_faces(const Polyhedron& solid, const Face& face, double tolerance) {
    const Point normal = area_vector(solid, face);
    std::vector<Point2> corners;
    for (const std::uint32_t corner : face) {
        corners.push_back(flattened(solid.corners[corner], normal));
    }
    if (face.size() <= kShapeFaceCornersMax && is_convex(corners, tolerance)) {
        return {face};
    }
    Loop loop(face.size());
    std::iota(loop.begin(), loop.end(), 0U);
    std::vector<Face> faces;
    for (const auto& [a, b, c] : triangulate(corners, loop, {})) {
        faces.push_back({face[a], face[b], face[c]});
    }
    return faces;
}

// A corner within a face is there on purpose.
bool has_inner_corner(const MergedFace& face) {
    return face.triangles.size() > face.border.size() - 2;
}

std::string edge_text(const Point& from, const Point& to) {
    return "the edge from " + place_text(from) + " to " + place_text(to);
}

}  // namespace

FromMesh<Shape> shape_of_mesh(std::vector<Point> places) {
    const Welded mesh = welded(std::move(places));
    const std::vector<HalfEdge> mates = find_mates(mesh.points, mesh.triangles);
    const auto open = std::find(mates.begin(), mates.end(), kNoHalfEdge);
    if (open != mates.end() || mates.empty()) {
        const auto half = static_cast<HalfEdge>(open - mates.begin());
        return tl::unexpected(
            mates.empty()
                ? std::string(" has no triangle with an area")
                : " is not closed: " +
                      edge_text(mesh.start_of(half), mesh.start_of(next_in_triangle(half))) +
                      " is open"
        );
    }
    const double tolerance = kMergeTolerance * mesh.extent;
    const std::vector<std::uint32_t> corners = corners_of(mates);
    Polyhedron solid;
    std::vector<std::uint32_t> number_of(mates.size(), kNoHalfEdge);
    const auto face_along = [&](std::span<const HalfEdge> border) {
        Face face;
        for (const HalfEdge half : border) {
            std::uint32_t& number = number_of[corners[half]];
            if (number == kNoHalfEdge) {
                number = static_cast<std::uint32_t>(solid.corners.size());
                solid.corners.push_back(mesh.start_of(half));
            }
            face.push_back(number);
        }
        return face;
    };
    std::vector<std::pair<std::uint32_t, Face>> faces;  // by a triangle of theirs
    for (const MergedFace& merged :
         merge_faces(mesh.points, mesh.triangles, mates, corners, tolerance)) {
        if (has_inner_corner(merged)) {
            for (const std::uint32_t t : merged.triangles) {
                faces.emplace_back(t, face_along(std::array{3 * t, 3 * t + 1, 3 * t + 2}));
            }
            continue;
        }
        for (Face& face : convex_faces(solid, face_along(merged.border), tolerance)) {
            faces.emplace_back(merged.triangles.front(), std::move(face));
        }
    }
    std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) {
        return a.first < b.first;
    });
    Shape shape;
    for (auto& [triangle, face] : faces) {
        shape.faces.push_back(std::move(face));
    }
    shape.corners = std::move(solid.corners);
    return shape;
}

FromMesh<std::vector<ProfilePoint>> profile_of_mesh(std::vector<Point> places) {
    const Welded mesh = welded(std::move(places));
    Eigen::AlignedBox3d box;
    for (const Point& point : mesh.points) {
        box.extend(point);
    }
    if (mesh.triangles.empty() || box.sizes().z() > 2 * kWeldTolerance * mesh.extent) {
        return tl::unexpected<std::string>(
            " is to be swept along edges, but is no flat mesh that faces along z of glTF"
        );
    }
    // Edges that no triangle has the other way round, in the order of the triangles.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& triangle : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangle[i];
            const std::uint32_t to = triangle[(i + 1) % 3];
            edges.emplace_back(from, to);
            ++balance[{from, to}];
            --balance[{to, from}];
        }
    }
    std::map<std::uint32_t, std::uint32_t> next;
    bool is_line = true;
    std::erase_if(edges, [&](const auto& edge) { return balance[edge] <= 0; });
    for (const auto& [from, to] : edges) {
        is_line = is_line && next.emplace(from, to).second;
    }
    std::vector<ProfilePoint> profile;
    if (is_line && !edges.empty()) {
        std::uint32_t at = edges.front().first;
        do {
            profile.push_back({mesh.points[at].x(), mesh.points[at].y()});
            const auto step = next.find(at);
            is_line = step != next.end() && profile.size() <= edges.size();
            at = is_line ? step->second : at;
        } while (is_line && at != edges.front().first);
    }
    if (!is_line || profile.empty() || profile.size() != edges.size()) {
        return tl::unexpected<std::string>(
            " is to be swept along edges, but its outline is not one line without holes"
        );
    }
    return profile;
}

}  // namespace modelsynth::continuous
