#pragma once

#include "solver/continuous/example.h"
#include "solver/core/result.h"
#include "solver/mesh/glb_scene.h"

#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::continuous {

// The object type of a primitive of a node: what the node's extras say ("object"), or else the name
// of its material, or else "object". A part of the node or the kit.
[[nodiscard]] std::string_view object_name(
    const GlbNode& node, const Kit& kit, const Primitive& primitive
);

// The object types of an example that is imported, and their materials.
class ImportObjects {
  public:
    // The number of the object type of a name, a new one when it is named first.
    // Fails: kInvalidArgument when it has another material than before; kTooLarge when the name is
    // too long or there are more than kObjectTypesMax.
    [[nodiscard]] Result<ObjectId> number_of(std::string_view name, const Material& material);

    [[nodiscard]] const std::vector<ObjectType>& types() const { return types_; }

    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

  private:
    std::vector<ObjectType> types_;
    std::vector<Material> materials_;
};

// A name cut to what one reads. Names in a file may be as long as the file, and one may be that of
// thousands of things.
[[nodiscard]] std::string shortened(std::string_view name);

// A name as errors have it: in quotes, and shortened.
[[nodiscard]] std::string quoted(std::string_view name);

}  // namespace modelsynth::continuous
