#pragma once

#include "solver/continuous/reading.h"

#include <memory>
#include <vector>

namespace modelsynth::examples {

// The built-in examples of continuous model synthesis, read on first use and kept. Their names are
// their ids. Thread-safe.
[[nodiscard]] const std::vector<std::shared_ptr<const continuous::ExampleReading>>& built_in_solids(
);

// Each of them, made anew.
[[nodiscard]] continuous::Example make_arches();
[[nodiscard]] continuous::Example make_buildings();
[[nodiscard]] continuous::Example make_fractals();
[[nodiscard]] continuous::Example make_houses();
[[nodiscard]] continuous::Example make_pentagons();
[[nodiscard]] continuous::Example make_skyscrapers();
[[nodiscard]] continuous::Example make_stairs();
[[nodiscard]] continuous::Example make_terrain();

}  // namespace modelsynth::examples
