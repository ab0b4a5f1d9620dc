#pragma once

#include "solver/continuous/import/imported_example.h"

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

using SharedExtra = std::shared_ptr<const Extra>;

// What extras have of these fields. `place`: where the extras are, and what they are said of.
[[nodiscard]] std::vector<SaidField> said_fields(
    const SharedExtra& extras, std::span<const std::string_view> names, const Source& place
);

// What the extras of nodes and materials say of the objects that are made of them.
class ObjectFields {
  public:
    // What is said of an object twice, not alike, is refused.
    explicit ObjectFields(RefuseSource refuse) : refuse_(std::move(refuse)) {}

    // `place`: where the extras are.
    void read_node(ObjectId object, const SharedExtra& extras, const Source& place) {
        read(object, extras, place, of_nodes_);
    }

    // Where a node tells a field, too, the node is right.
    void read_material(ObjectId object, const SharedExtra& extras, const Source& place) {
        read(object, extras, place, of_materials_);
    }

    // All of it, by object.
    [[nodiscard]] std::vector<SaidField> fields() const;

  private:
    using ByField = std::map<std::string, SaidField>;  // by the place in the example

    void read(ObjectId object, const SharedExtra& extras, Source place, ByField& fields);

    RefuseSource refuse_;
    ByField of_nodes_;
    ByField of_materials_;
};

}  // namespace modelsynth::continuous
