#include "solver/continuous/import/node_places.h"

#include "solver/continuous/import/import_objects.h"

#include <Eigen/LU>

#include <array>
#include <utility>

namespace modelsynth::continuous {

namespace {

const Mesh& mesh_of(const GlbScene& scene, std::size_t node) {
    return scene.kit.meshes[scene.nodes[node].mesh];
}

}  // namespace

std::string_view name_of(const GlbScene& scene, std::size_t node) {
    const std::string& own = scene.nodes[node].name;
    return own.empty() ? mesh_of(scene, node).name : own;
}

std::vector<Point> places_of(const GlbScene& scene, std::size_t node) {
    Eigen::Matrix3d turn;
    const auto& frame = scene.nodes[node].frame;
    for (Eigen::Index column = 0; column < 3; ++column) {
        const auto& image = frame[static_cast<std::size_t>(column)];
        turn.col(column) = Point(image[0], image[1], image[2]);
    }
    const Point origin(frame[3][0], frame[3][1], frame[3][2]);
    // A mirrored mesh is inside out.
    const bool is_mirrored = turn.determinant() < 0;
    std::vector<Point> places;
    for (const Primitive& primitive : mesh_of(scene, node).primitives) {
        for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
            const std::size_t corner = is_mirrored ? i - i % 3 + (3 - i % 3) % 3 : i;
            const Vec3& place = primitive.positions[primitive.indices[corner]];
            places.emplace_back(turn * Point(place.x, place.y, place.z) + origin);
        }
    }
    return places;
}

Source source_of(const GlbScene& scene, std::size_t node, std::string in_example) {
    return {
        std::move(in_example),
        "/nodes/" + std::to_string(scene.nodes[node].number),
        "node " + quoted(name_of(scene, node))};
}

Source extras_of(const GlbScene& scene, std::size_t node, std::string in_example) {
    Source source = source_of(scene, node, std::move(in_example));
    source.in_file += "/extras";
    return source;
}

}  // namespace modelsynth::continuous
