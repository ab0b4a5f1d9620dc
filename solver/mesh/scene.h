#pragma once

#include "solver/mesh/mesh.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace modelsynth {

// Instance::mesh of something that has a place and a name but nothing to draw.
inline constexpr std::uint32_t kNoMesh = 0xFFFFFFFF;

// One mesh of the kit put somewhere.
struct Instance {
    std::uint32_t mesh = 0;
    std::uint32_t name = 0;          // index into Scene::names
    Vec3 position;                   // where the mesh's origin goes
    std::uint8_t quarter_turns = 0;  // about the vertical axis, counter-clockwise from above
};

// Instances that lie together, so that a viewer can cull them as one. A group without a name is
// no group: its instances stand alone.
struct SceneGroup {
    std::string name;
    std::vector<Instance> instances;
};

// A model as pieces that are placed many times. Frame: metres, right-handed, y up.
// Invariant: every index is within its list.
struct Scene {
    std::shared_ptr<const Kit> kit = std::make_shared<Kit>();
    std::vector<std::string> names;  // of the pieces
    std::vector<SceneGroup> groups;
};

}  // namespace modelsynth
