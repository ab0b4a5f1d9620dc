#pragma once

#include <string>
#include <string_view>
#include <vector>

// The castle is drawn as a plan, a character per cell; which piece a cell gets, how it is turned
// and what stands above it follows from its neighbours.
namespace modelsynth::examples::castle {

// The letters of pieces in the floors. Pieces that come in turns have four letters in a row, from
// the one given; they are too many for the keyboard.
enum Letter : unsigned char {
    kAir = ' ',
    // What stands in the plan under its own letter.
    kGrass = '.',
    kWild = ',',
    kTree = 't',
    kCypress = 'y',
    kPlace = 'o',
    kBarrels = 'b',
    kWell = 'w',
    kInnerWallX = '=',
    kInnerWallZ = '"',
    kInnerGateX = 'n',
    kInnerGateZ = 'u',
    // Pieces above the ground.
    kTurretStorey = 'l',
    kTurretWindows = 'I',
    kTurretBattlement = 'M',
    kTurretRoof = '^',
    kTurretFlag = 'v',
    kInside = '@',
    kUpper = '+',
    kChimney = '?',
    // Pieces in two or four turns.
    kPathX = 0x80,
    kPathZ,
    kCottageMiddleX,
    kCottageMiddleZ,
    kPathBend,
    kCottage = kPathBend + 4,
    kFieldCorner = kCottage + 4,
    kFieldSide = kFieldCorner + 4,
    kMeadowEdge = kFieldSide + 4,
    kCourt = kMeadowEdge + 4,  // by the edges it may touch: west and north, and so on round
    kCourtEdge = kCourt + 4,
    kShed = kCourtEdge + 4,
    kCurtain = kShed + 4,
    kCurtainConvex = kCurtain + 4,
    kCurtainConcave = kCurtainConvex + 4,
    kGate = kCurtainConcave + 4,
    kTurret = kGate + 4,
    kTurretConvex = kTurret + 4,
    kTurretConcave = kTurretConvex + 4,
    kFootCorner = kTurretConcave + 4,
    kFootSide = kFootCorner + 4,
    kDoor = kFootSide + 4,
    kStoreyCorner = kDoor + 4,
    kStoreySide = kStoreyCorner + 4,
    kRoofCorner = kStoreySide + 4,
    kRoofSide = kRoofCorner + 4,
    kRoofValley = kRoofSide + 4,
    kKeepShaft = kRoofValley + 4,
    kKeepBattlement = kKeepShaft + 4,
    kKeepSpire = kKeepBattlement + 4,
};

[[nodiscard]] constexpr char letter_of(Letter first, int quarter_turns = 0) {
    return static_cast<char>(static_cast<int>(first) + quarter_turns % 4);
}

[[nodiscard]] std::string letters_of(Letter first, int count = 4);

// Rows from north to south. Besides the letters above:
//   # curtain wall, 1 ... 6 turrets in it, G gate, with a place before it
//   A a hall of one storey (a: its door), B d of two; K L M N keeps, two by two
//   C cottage, f field, two cells wide, p path, s shed against a wall
// Gives the floors for ExampleBuilder, from the bottom up. A plan that breaks the rules of the
// pieces ends the program.
[[nodiscard]] std::vector<std::vector<std::string>> build_plan(
    const std::vector<std::string_view>& rows, std::size_t floor_count
);

// A square plan and its three turns about their common corner: whatever the plan shows in one
// direction the example then shows in all four.
[[nodiscard]] std::vector<std::string> in_four_turns(const std::vector<std::string_view>& rows);

}  // namespace modelsynth::examples::castle
