#pragma once

#include <string>

namespace modelsynth::examples {

// What modelsynth-examples shows of the examples made of solids; see make_examples.cpp.
// `name` empty: all; `size` as of the command line, empty: no model is made.
void show_solids(
    const std::string& directory, const std::string& name, const std::string& size, int seeds
);

}  // namespace modelsynth::examples
