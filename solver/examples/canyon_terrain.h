#pragma once

#include "solver/examples/canyon_rock.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::examples {

// The letters of the plain pieces in the canyon's floors.
inline constexpr char kAir = ' ';
inline constexpr char kSolid = '#';
inline constexpr char kValley = '.';
inline constexpr char kTurf = ',';
// In a stack: what the terrain has there anyway.
inline constexpr char kAsIs = '*';

// The letter of a cliff piece; they are too many for the keyboard.
[[nodiscard]] char cliff_letter(CliffKind kind, CliffShape shape, int quarter_turns);
// The four of them, in the order ExampleBuilder::add_turned wants.
[[nodiscard]] std::string cliff_letters(CliffKind kind, CliffShape shape);

// What a character of the map of things stands for.
struct Thing {
    // The letters that replace those of the terrain, from the cell that the ground lies in
    // upwards.
    std::string stack;
    // For a thing in a cliff: the letters of its four turns instead, likewise; the cliff's own
    // turn says which is used.
    std::vector<std::string> turned_stack = {};
};

// Heights are those of the corners of cells, in levels, a digit each; things those of the cells,
// '.' for none. Both have a row per line from north to south. Gives the floors for ExampleBuilder,
// from the bottom up. A cell whose corners have more than two heights, or whose two heights lie
// crosswise, ends the program.
[[nodiscard]] std::vector<std::vector<std::string>> lay_out_terrain(
    const std::vector<std::string_view>& heights,
    const std::vector<std::string_view>& things,
    const std::map<char, Thing>& meaning
);

}  // namespace modelsynth::examples
