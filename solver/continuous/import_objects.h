#pragma once

#include "solver/continuous/example.h"
#include "solver/core/result.h"
#include "solver/mesh/glb_scene.h"

#include <string>
#include <vector>

namespace modelsynth::continuous {

// The object type of a primitive of a node: what the node's extras say ("object"), or else the name
// of its material, or else "object".
[[nodiscard]] std::string object_name(
    const GlbNode& node, const Kit& kit, const Primitive& primitive
);

// The object types of an example that is imported, and their materials.
class ImportObjects {
  public:
    // The number of the object type of a name, a new one when it is named first.
    // Fails: kInvalidArgument when it has another material than before; kTooLarge when the name is
    // too long or there are more than kObjectTypesMax.
    [[nodiscard]] Result<ObjectId> number_of(const std::string& name, const Material& material);

    [[nodiscard]] const std::vector<ObjectType>& types() const { return types_; }

    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

  private:
    std::vector<ObjectType> types_;
    std::vector<Material> materials_;
};

// A name as errors have it: in quotes, and cut to what one reads.
[[nodiscard]] std::string quoted(const std::string& name);

}  // namespace modelsynth::continuous
