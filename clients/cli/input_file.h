#pragma once

#include "clients/cli/failure.h"

#include <string>

namespace modelsynth::cli {

// All bytes of a file; "-" is standard input. Fails: kWrongUsage.
[[nodiscard]] Outcome<std::string> read_input(const std::string& path);

// The text of an example file, ready to be sent: where `meshes` names a GLB file beside it, that
// file stands in its place as a data: URI.
// Fails: kWrongUsage when it is not JSON or a file cannot be read.
[[nodiscard]] Outcome<std::string> read_example_file(const std::string& path);

}  // namespace modelsynth::cli
