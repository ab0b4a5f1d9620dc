#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::examples {

// The letters of one piece in its four turns: facing east, north, west, south.
using Turned = std::array<char, 4>;
// The letters of one piece along x and along z.
using Axial = std::array<char, 2>;

// Streets: a letter for each kind of junction and each way it lies.
struct StreetLetters {
    Axial plain{};
    Axial lamps{};
    Axial zebra{};
    Axial car{};
    char crossing = 0;
    Turned fork{};  // the side without an arm
    Turned turn{};  // arms to the side and to the next one counter-clockwise
};

struct OpenLetters {
    char air = 0;
    char paving = 0;
    char lamp = 0;
    char tree = 0;
    char bench = 0;
    char puddle = 0;
    char lawn = 0;
    Turned lawn_edge{};
    Turned lawn_corner{};
    char lawn_tree = 0;
    char lawn_shrubs = 0;
    char fountain = 0;
};

// Stone-faced blocks with flat roofs, two or more cells wide. A terrace wall is the lowest storey
// of a part that rises above its neighbour's roof; it has letters of its own so that such steps
// are as rare as their weight says.
struct BlockLetters {
    Turned shop{};
    Turned door{};
    Turned ground_corner{};
    char ground_core = 0;
    Turned wall{};
    Turned lit_wall{};
    Turned corner{};
    Turned brick_wall{};
    Turned lit_brick_wall{};
    Turned brick_corner{};
    char core = 0;
    Turned terrace{};
    Turned terrace_left{};   // ends in a facade counter-clockwise of it
    Turned terrace_right{};  // ... clockwise of it
    Turned parapet{};
    Turned parapet_corner{};
    Turned parapet_tank{};
    Turned parapet_stack{};
    char roof = 0;
    char roof_tank = 0;
    char roof_mast = 0;
    char roof_light = 0;
};

// Brick houses two cells deep under a gable roof.
struct HouseLetters {
    Turned front{};
    Turned door{};
    Turned ground_corner{};
    Turned wall{};
    Turned corner{};
    Turned slope{};
    Turned dormer{};
    Turned gable_left{};   // a slope that ends counter-clockwise of it
    Turned gable_right{};  // ... clockwise of it
};

struct CityLetters {
    OpenLetters open;
    StreetLetters street;
    BlockLetters block;
    HouseLetters house;
};

// Turns a plan (one character a column of cells) into floors of letters. In the plan
//   # street, = with lamps, z zebra crossing, k with a car; arms follow from the neighbours
//   . paving, l lamp, t tree, n bench, p puddle
//   g lawn, T with a tree, S with shrubs, O fountain; hedges follow from the neighbours
//   1 ... 8 stone block of so many storeys, A ... H brick one; a b c house of 1, 2, 3 storeys and a
//   gable roof
// The plan is laid out four times, each a quarter turn on, about its south-eastern corner, so that
// whatever it shows in one direction the example shows in all.
// Requires: a square plan; what leaves its eastern side in a row leaves its southern side in the
// column of the same number.
[[nodiscard]] std::vector<std::vector<std::string>> lay_out_city(
    const std::vector<std::string_view>& plan, int floor_count, const CityLetters& letters
);

}  // namespace modelsynth::examples
