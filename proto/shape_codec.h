#pragma once

// Private to proto's sources.

#include "proto/json.h"
#include "solver/continuous/example.h"

#include <memory>

namespace modelsynth::proto {

// What stands under `shape` of an object of solids; what is wrong goes to the value's faults.
[[nodiscard]] std::shared_ptr<const continuous::Shape> read_shape(const Value& given);

// A closed mesh by itself, as the shape's is: without `even`.
[[nodiscard]] std::shared_ptr<const continuous::Shape> read_mesh(const Value& given);

[[nodiscard]] OrderedJson write_shape(const continuous::Shape& shape);  // a mesh, too

}  // namespace modelsynth::proto
