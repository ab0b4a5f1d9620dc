#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "solver/continuous/example.h"

#include <initializer_list>
#include <memory>

namespace modelsynth::proto {

// What stands under `shape` of an object of solids; what is wrong goes to the value's faults.
[[nodiscard]] std::shared_ptr<const continuous::Shape> read_shape(const Value& given);

// One whose fields stand beside these, which are read elsewhere.
[[nodiscard]] std::shared_ptr<const continuous::Shape> read_shape(
    const Value& given, std::initializer_list<const char*> other_fields
);

// A closed mesh by itself, as the shape's is: without `even`.
[[nodiscard]] std::shared_ptr<const continuous::Shape> read_mesh(const Value& given);

[[nodiscard]] OrderedJson write_shape(const continuous::Shape& shape);  // a mesh, too

}  // namespace modelsynth::proto
