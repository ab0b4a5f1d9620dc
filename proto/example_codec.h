#pragma once

#include "proto/limits.h"
#include "proto/problem.h"
#include "solver/registry/task.h"

#include <string>
#include <string_view>

namespace modelsynth::proto {

// An example as it came over the wire.
struct ExampleUpload {
    Example example;
    std::string canonical;  // the JSON text with sorted keys: equal content, equal text
};

// Reads an example object of any kind, its meshes included, and checks all of it.
// Fails: malformed-json, invalid-request with every fault found.
[[nodiscard]] Parsed<ExampleUpload> parse_example(
    std::string_view text, const RequestLimits& limits
);

// The same of a binary glTF file of closed meshes, see solver/continuous/import/mesh_import.h.
// Fails: invalid-request, too-large.
[[nodiscard]] Parsed<ExampleUpload> parse_example_glb(
    std::string_view bytes, const RequestLimits& limits
);

// What GET /v1/examples lists of an example.
[[nodiscard]] std::string example_summary(
    const Example& example, const std::string& id, bool built_in
);

// The resource /v1/examples/{id}: the summary and all of the example but its meshes.
[[nodiscard]] std::string example_resource(
    const Example& example, const std::string& id, bool built_in
);

}  // namespace modelsynth::proto
