#pragma once

#include "solver/continuous/import/imported_example.h"
#include "solver/mesh/glb_scene.h"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// The object that a node's mesh is the shape of, or decorates; "" when it is none. Either node is
// no solid. A shape that begins with a brace is one written out, of the node's own object.
[[nodiscard]] std::string shaped_object(const GlbNode& node);
[[nodiscard]] std::string decorated_object(const GlbNode& node);

// The nodes of a scene that are how objects look in models, and no solids; see mesh_import.h.
class Attachments {
  public:
    Attachments(std::shared_ptr<const GlbScene> scene, RefuseSource refuse)
        : scene_(std::move(scene)), refuse_(std::move(refuse)) {}

    // Nodes, by index. `look`: the object whose material a decoration has, kEmpty for its own.
    void add_shape(std::size_t node) { shapes_.push_back({node, kEmpty}); }

    void add_decoration(std::size_t node, ObjectId look) { decorations_.push_back({node, look}); }

    // Gives them to the objects of an example, in the order in which they were added; what cannot
    // be is refused. Requires: the example has all objects.
    void give_to(ImportedExample& made) const;

  private:
    struct Attachment {
        std::size_t node;
        ObjectId look;
    };

    void give_shape(std::size_t node, ImportedExample& made) const;
    void give_decoration(const Attachment& attachment, ImportedExample& made) const;
    // kEmpty, and refused, when there is none.
    [[nodiscard]] ObjectId object_named(
        const std::string& name, std::size_t node, const char* property, const Example& example
    ) const;

    void say(
        std::size_t node,
        std::span<const std::string_view> fields,
        const std::string& of,
        ImportedExample& made
    ) const;

    std::shared_ptr<const GlbScene> scene_;
    RefuseSource refuse_;
    std::vector<Attachment> shapes_;
    std::vector<Attachment> decorations_;
};

}  // namespace modelsynth::continuous
