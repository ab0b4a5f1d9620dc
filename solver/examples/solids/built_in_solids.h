#pragma once

#include "solver/continuous/reading/reading.h"

#include <memory>
#include <string_view>
#include <vector>

namespace modelsynth::examples {

// The built-in examples of continuous model synthesis. Each is read on first use, which takes up to
// some tenths of a second, and kept. Their names are their ids. Thread-safe.

// Null when there is none of that name.
[[nodiscard]] std::shared_ptr<const continuous::ExampleReading> find_solids(std::string_view name);

// All of them.
[[nodiscard]] std::vector<std::shared_ptr<const continuous::ExampleReading>> built_in_solids();

// Each of them, made anew.
[[nodiscard]] continuous::Example make_arches();
[[nodiscard]] continuous::Example make_buildings();
[[nodiscard]] continuous::Example make_domes();
[[nodiscard]] continuous::Example make_fractals();
[[nodiscard]] continuous::Example make_houses();
[[nodiscard]] continuous::Example make_letters();
[[nodiscard]] continuous::Example make_oil_platform();
[[nodiscard]] continuous::Example make_pentagons();
[[nodiscard]] continuous::Example make_plumbing();
[[nodiscard]] continuous::Example make_roads();
[[nodiscard]] continuous::Example make_roller_coaster();
[[nodiscard]] continuous::Example make_skyscrapers();
[[nodiscard]] continuous::Example make_spaceships();
[[nodiscard]] continuous::Example make_stairs();
[[nodiscard]] continuous::Example make_terrain();

}  // namespace modelsynth::examples
