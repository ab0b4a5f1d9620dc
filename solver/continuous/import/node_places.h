#pragma once

#include "solver/continuous/import/imported_example.h"
#include "solver/mesh/glb_scene.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::continuous {

// Of a node of a scene, by its index into GlbScene::nodes.

// Its own name, or else that of its mesh.
[[nodiscard]] std::string_view name_of(const GlbScene& scene, std::size_t node);

// The places of the corners of its triangles in the scene, three by three, metres.
[[nodiscard]] std::vector<Point> places_of(const GlbScene& scene, std::size_t node);

// As what a part of an example comes from, ...
[[nodiscard]] Source source_of(
    const GlbScene& scene, std::size_t node, std::string in_example = ""
);

// ... or its extras.
[[nodiscard]] Source extras_of(
    const GlbScene& scene, std::size_t node, std::string in_example = ""
);

}  // namespace modelsynth::continuous
