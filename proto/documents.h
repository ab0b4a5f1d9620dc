#pragma once

#include <string>

namespace modelsynth::proto {

// The documents that describe the service, made of the skeletons in proto/documents and of
// proto/schemas:
//   - a $ref to a file of schemas/ becomes one to components/schemas; the file is put there, and
//     what it refers to in turn, so that the document stands alone;
//   - the type of a problem lists all that there are.
// In openapi.json besides:
//   - `x-problems` of an operation, names of problem_kinds(), become its responses by status;
//   - `x-tagged` of a response says that it has an entity tag: its headers are added, and to the
//     operation the parameters and responses of codings, conditions and ranges;
//   - every operation has the response `default`, and what is got can be asked for by HEAD.

// GET /openapi.json, OpenAPI 3.1.
[[nodiscard]] std::string openapi_json();

// GET /asyncapi.json, AsyncAPI 3.0.
[[nodiscard]] std::string asyncapi_json();

}  // namespace modelsynth::proto
