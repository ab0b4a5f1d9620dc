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
    Axial car{};
    Turned zebra{};  // the side with the junction
    char crossing = 0;
    Turned fork{};  // the side without an arm
    Turned turn{};  // arms to the side and to the next one counter-clockwise
    Turned end{};   // the side with the only arm; with it a street can grow from block to block
};

// Places to walk: lanes between buildings, yards, which fit between whatever there is, and verges
// between a street (on their side) and the buildings along it.
struct LaneLetters {
    Axial plain{};
    Axial tree{};
    char yard = 0;
    char yard_tree = 0;
    char yard_bench = 0;
    Turned verge{};
};

// An open place three cells deep.
struct PlaceLetters {
    Turned edge{};
    Turned corner{};  // ends at the side and at the next one counter-clockwise
    Axial middle{};
    char feature = 0;
};

// Stone-faced blocks under mansard roofs, three cells deep. The core on the ground has letters for
// the two ways it can run, so that no block grows in both.
struct BlockLetters {
    Turned shop{};
    Turned ground_corner{};
    Axial ground_core{};
    Turned wall{};
    Turned balcony{};
    Turned corner{};
    Turned mint_wall{};
    Turned mint_corner{};
    Turned brick_wall{};
    Turned brick_corner{};
    char core = 0;
    Turned mansard{};
    Turned mansard_corner{};
    Turned mansard_dormer{};
    Turned tile_mansard{};
    Turned tile_mansard_corner{};
    char roof = 0;
    char roof_cupola = 0;
    char roof_garden = 0;
    char roof_light = 0;
};

// Houses two cells deep under a gable roof, with a row of garden behind.
struct HouseLetters {
    Turned front{};
    Turned back{};  // always with a garden
    Turned ground_corner{};
    Turned garden{};        // the side away from the house
    Turned garden_left{};   // ... that ends counter-clockwise of it
    Turned garden_right{};  // ... clockwise of it
    Turned wall{};
    Turned corner{};
    Turned timber_wall{};  // the third storey
    Turned timber_corner{};
    Turned slope{};
    Turned dormer{};
    Turned gable_left{};   // a slope that ends counter-clockwise of it
    Turned gable_right{};  // ... clockwise of it
};

// The four quarters of a tower two cells wide, each named by the sides it faces as corners are.
struct TowerLetters {
    Turned ground{};
    Turned shaft{};
    Turned belfry{};
    Turned spire{};
};

struct CityLetters {
    char air = 0;
    StreetLetters street;
    LaneLetters lane;
    PlaceLetters park;
    PlaceLetters square;
    BlockLetters block;
    HouseLetters house;
    TowerLetters tower;
};

// Turns a plan (one character a column of cells) into floors of letters. In the plan
//   # street; what it is follows from the neighbours
//   : lane, y yard, v verge between a street and a building
//   p park, q square; three cells deep
//   1 ... 8 stone block of so many storeys, A ... H brick one, J ... Q mint one, three cells deep
//   a b c house of 1, 2, 3 storeys, two cells deep; g its garden, one cell deep, on its back
//   t clock tower, two cells by two
// The plan is laid out four times, each a quarter turn on, about the cell south of its
// south-eastern one, so that whatever it shows in one direction the example shows in all. That
// cell is a street.
// Requires: a plan one column wider than it is deep.
[[nodiscard]] std::vector<std::vector<std::string>> lay_out_city(
    const std::vector<std::string_view>& plan, int floor_count, const CityLetters& letters
);

}  // namespace modelsynth::examples
