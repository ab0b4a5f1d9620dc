#include "solver/continuous/import/triangle_solids.h"

#include "solver/continuous/import/face_merging.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/reading/solids.h"
#include "solver/core/disjoint_sets.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace modelsynth::continuous {

namespace {

// More hollows than this in one soup are left as solids that look inwards.
constexpr std::size_t kHollowsMax = 64;

double volume_of(const Polyhedron& solid) {
    const Point& origin = solid.corners.front();
    double sum = 0;
    for (const Face& face : solid.faces) {
        sum += area_vector(solid, face).dot(solid.corners[face.front()] - origin) / 3;
    }
    return sum;
}

void append(const TriangleSolid& hollow, TriangleSolid& solid) {
    Polyhedron& into = solid.polyhedron;
    const auto first = static_cast<std::uint32_t>(into.corners.size());
    const Polyhedron& from = hollow.polyhedron;
    into.corners.insert(into.corners.end(), from.corners.begin(), from.corners.end());
    for (Face face : from.faces) {
        for (std::uint32_t& corner : face) {
            corner += first;
        }
        into.faces.push_back(std::move(face));
    }
    solid.triangles.insert(solid.triangles.end(), hollow.triangles.begin(), hollow.triangles.end());
}

// Gives every hollow to the smallest solid around it.
void place_hollows(std::vector<TriangleSolid>& solids) {
    std::vector<double> volumes;
    Example example;
    for (const TriangleSolid& solid : solids) {
        volumes.push_back(volume_of(solid.polyhedron));
        example.polyhedra.push_back(solid.polyhedron);
    }
    const auto hollows = static_cast<std::size_t>(
        std::count_if(volumes.begin(), volumes.end(), [](double volume) { return volume < 0; })
    );
    if (hollows == 0 || hollows > kHollowsMax) {
        return;
    }
    const Solids shapes(example);
    std::vector<bool> is_placed(solids.size());
    for (std::size_t hollow = 0; hollow < solids.size(); ++hollow) {
        if (volumes[hollow] >= 0) {
            continue;
        }
        const Point& place = example.polyhedra[hollow].corners.front();
        std::optional<std::size_t> around;
        for (std::size_t solid = 0; solid < solids.size(); ++solid) {
            if (volumes[solid] > -volumes[hollow] &&
                (!around || volumes[solid] < volumes[*around]) &&
                shapes.winding(solid, place) > 0.5) {
                around = solid;
            }
        }
        if (around) {
            append(solids[hollow], solids[*around]);
            is_placed[hollow] = true;
        }
    }
    std::size_t kept = 0;
    for (std::size_t solid = 0; solid < solids.size(); ++solid) {
        if (!is_placed[solid]) {
            if (kept != solid) {
                solids[kept] = std::move(solids[solid]);
            }
            ++kept;
        }
    }
    solids.resize(kept);
}

}  // namespace

TriangleSolids find_triangle_solids(
    std::span<const Point> points, std::span<const Triangle> triangles, double tolerance
) {
    TriangleSolids found;
    const std::vector<HalfEdge> mates = find_mates(points, triangles);
    for (HalfEdge half = 0; half < mates.size(); ++half) {
        if (mates[half] == kNoHalfEdge) {
            found.open.push_back(half);
        }
    }
    if (!found.open.empty()) {
        return found;
    }
    const std::vector<std::uint32_t> corners = corners_of(mates);
    DisjointSets parts(triangles.size());
    for (HalfEdge half = 0; half < mates.size(); ++half) {
        parts.join(half / 3, mates[half] / 3);
    }
    std::vector<std::size_t> solid_of(triangles.size());              // by a part's least triangle
    std::vector<std::uint32_t> number_of(mates.size(), kNoHalfEdge);  // in the solid
    for (std::uint32_t triangle = 0; triangle < triangles.size(); ++triangle) {
        if (parts.find(triangle) == triangle) {
            solid_of[triangle] = found.solids.size();
            found.solids.emplace_back();
        }
    }
    for (const MergedFace& merged : merge_faces(points, triangles, mates, corners, tolerance)) {
        TriangleSolid& solid = found.solids[solid_of[parts.find(merged.triangles.front())]];
        Face& face = solid.polyhedron.faces.emplace_back();
        for (const HalfEdge half : merged.border) {
            std::uint32_t& number = number_of[corners[half]];
            if (number == kNoHalfEdge) {
                number = static_cast<std::uint32_t>(solid.polyhedron.corners.size());
                solid.polyhedron.corners.push_back(points[triangles[half / 3][half % 3]]);
            }
            face.push_back(number);
        }
        solid.triangles.push_back(merged.triangles.front());
    }
    place_hollows(found.solids);
    return found;
}

}  // namespace modelsynth::continuous
