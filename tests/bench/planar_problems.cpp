#include "tests/bench/planar_problems.h"

#include "tests/bench/tile_set.h"

#include <cstddef>
#include <utility>

namespace modelsynth::bench {

namespace {

using ExamplePointer = std::shared_ptr<const discrete::Example>;

ExamplePointer share(discrete::Example example) {
    return std::make_shared<const discrete::Example>(std::move(example));
}

// Every way in which pipes can meet.
ExamplePointer make_pipes() {
    const std::vector<Tile> tiles = {
        {"nothing", {"   ", "   ", "   ", "   "}},
        {"end", {" o ", "   ", "   ", "   "}},
        {"pipe", {" o ", "   ", " o ", "   "}},
        {"bend", {" o ", " o ", "   ", "   "}},
        {"fork", {" o ", " o ", " o ", "   "}},
        {"cross", {" o ", " o ", " o ", " o "}},
        {"overpass", {" o ", " o ", " o ", " o "}}};
    return share(make_tile_example("pipes", tiles, Variants::kTurned));
}

// Bare board (b), chips (c) with a rim (k) and a pin at every part of it, thin tracks (t) that end
// nowhere but at pins, thick ones (T) that end in few places.
ExamplePointer make_board() {
    const std::vector<Tile> tiles = {
        {"bare", {"bbb", "bbb", "bbb", "bbb"}, 2},
        {"chip", {"ccc", "ccc", "ccc", "ccc"}, 12},
        {"pin", {"btb", "bkc", "ccc", "ckb"}, 6},
        {"corner", {"bbb", "bkc", "ckb", "bbb"}, 6},
        {"track", {"btb", "bbb", "btb", "bbb"}, 1},
        {"bend", {"btb", "btb", "bbb", "bbb"}, 1},
        {"fork", {"btb", "btb", "btb", "bbb"}, 0.2},
        {"under", {"bTb", "btb", "bTb", "btb"}, 1},
        {"thick", {"bTb", "bbb", "bTb", "bbb"}, 0.5},
        {"step", {"bTb", "bbb", "btb", "bbb"}, 0.5},
        {"terminal", {"bTb", "bbb", "bbb", "bbb"}, 0.1}};
    return share(make_tile_example("board", tiles, Variants::kTurnedAndMirrored));
}

// Water (w) with a shore (s), grass (g), high ground (h) above a cliff (c); a road (r) that ends
// nowhere, climbs the cliff straight on and crosses water on a bridge (B).
ExamplePointer make_hills() {
    const std::vector<Tile> tiles = {
        {"water", {"www", "www", "www", "www"}, 2},
        {"grass", {"ggg", "ggg", "ggg", "ggg"}, 2},
        {"high ground", {"hhh", "hhh", "hhh", "hhh"}, 2},
        {"shore", {"ggg", "gsw", "www", "wsg"}},
        {"bay", {"gsw", "www", "www", "wsg"}},
        {"cape", {"ggg", "gsw", "wsg", "ggg"}},
        {"cliff", {"ggg", "gch", "hhh", "hcg"}},
        {"hollow", {"gch", "hhh", "hhh", "hcg"}},
        {"spur", {"ggg", "gch", "hcg", "ggg"}},
        {"road", {"grg", "ggg", "grg", "ggg"}},
        {"bend", {"grg", "grg", "ggg", "ggg"}},
        {"fork", {"grg", "grg", "grg", "ggg"}, 0.1},
        {"ramp", {"grg", "gch", "hrh", "hcg"}},
        {"high road", {"hrh", "hhh", "hrh", "hhh"}},
        {"bridgehead", {"grg", "gsw", "wBw", "wsg"}},
        {"bridge", {"wBw", "www", "wBw", "www"}}};
    return share(make_tile_example("hills", tiles, Variants::kTurnedAndMirrored));
}

// Meadows (m) and courts (c) parted by walls (W), roads (r) through gates, rivers (w) under bridges
// and water gates. Nothing ends but at the border of the model.
ExamplePointer make_fortress() {
    const std::vector<Tile> tiles = {
        {"meadow", {"mmm", "mmm", "mmm", "mmm"}, 2},
        {"court", {"ccc", "ccc", "ccc", "ccc"}, 2},
        {"wall", {"mmm", "mWc", "ccc", "cWm"}},
        {"outer tower", {"mmm", "mWc", "cWm", "mmm"}},
        {"inner tower", {"cWm", "mWc", "ccc", "ccc"}},
        {"gate", {"mrm", "mWc", "crc", "cWm"}},
        {"water gate", {"mwm", "mWc", "cwc", "cWm"}, 0.5},
        {"road", {"mrm", "mmm", "mrm", "mmm"}},
        {"bend", {"mrm", "mrm", "mmm", "mmm"}},
        {"fork", {"mrm", "mrm", "mrm", "mmm"}, 0.2},
        {"street", {"crc", "ccc", "crc", "ccc"}},
        {"river", {"mwm", "mmm", "mwm", "mmm"}},
        {"meander", {"mwm", "mwm", "mmm", "mmm"}},
        {"canal", {"cwc", "ccc", "cwc", "ccc"}, 0.5},
        {"bridge", {"mrm", "mwm", "mrm", "mwm"}, 0.5}};
    return share(make_tile_example("fortress", tiles, Variants::kTurnedAndMirrored));
}

// Rectangular rooms (f) with a wall (w) in the rock (r), and passages (p) from door to door.
ExamplePointer make_rooms() {
    const std::vector<Tile> tiles = {
        {"rock", {"rrr", "rrr", "rrr", "rrr"}, 1},
        {"floor", {"fff", "fff", "fff", "fff"}, 2},
        {"wall", {"rrr", "rwf", "fff", "fwr"}},
        {"corner", {"rrr", "rwf", "fwr", "rrr"}},
        {"door", {"rpr", "rwf", "fff", "fwr"}, 0.5},
        {"passage", {"rpr", "rrr", "rpr", "rrr"}, 0.5},
        {"bend", {"rpr", "rpr", "rrr", "rrr"}, 0.2}};
    return share(make_tile_example("rooms", tiles, Variants::kTurned));
}

// A Wang set of three colours either way: whatever stands north and west, two tiles fit.
ExamplePointer make_wang() {
    std::vector<Tile> tiles;
    for (int north = 0; north < 3; ++north) {
        for (int west = 0; west < 3; ++west) {
            for (int choice = 0; choice < 2; ++choice) {
                const auto colour = [](int number) { return std::to_string(number % 3); };
                tiles.push_back(
                    {"tile",
                     {colour(north),
                      colour(north + west + choice),
                      colour(north + 2 * west + 2 * choice),
                      colour(west)}}
                );
            }
        }
    }
    return share(make_tile_example("wang", tiles, Variants::kAsDrawn));
}

const Image kOrchard = {
    "................",
    "..ooo.....oo....",
    ".ooooo...oooo...",
    ".ooxoo...oxoo...",
    "..ooo.....oo....",
    "...|......|.....",
    "...|......|.....",
    "================",
    "................",
    ".....oo....ooo..",
    "....oooo..ooxoo.",
    "....oxoo..ooooo.",
    ".....oo....ooo..",
    "......|.....|...",
    "......|.....|...",
    "================"};

const Image kIslands = {
    "~~~~~~~~~~~~~~~~",
    "~~~::~~~~~~~~~~~",
    "~~:,,:~~~~::~~~~",
    "~:,,,:~~~:,,:~~~",
    "~:,,,,:~~:,,:~~~",
    "~~:,,:~~~~::~~~~",
    "~~~::~~~~~~~~~~~",
    "~~~~~~~~~~~~~~~~",
    "~~~~~~~:::~~~~~~",
    "~~~~~~:,,,:~~~~~",
    "~~::~:,,,,,:~~~~",
    "~:,,:~:,,,:~~~~~",
    "~~::~~~:::~~~~~~",
    "~~~~~~~~~~~~~~~~"};

const Image kMaze = {
    "################",
    "#...#.......#..#",
    "#.#.#.#####.#.##",
    "#.#...#...#....#",
    "#.#####.#.####.#",
    "#.......#....#.#",
    "###.#######.##.#",
    "#...#.....#....#",
    "#.###.###.####.#",
    "#.#.....#......#",
    "#.#.###.####.#.#",
    "#...#........#.#",
    "################"};

const Image kStreets = {
    "..#....#......#.",
    "..#.BB.#.BBBB.#.",
    "..#.BB.#.BBBB.#.",
    "..#....#......#.",
    "################",
    "..#......#....#.",
    "..#.BBBB.#.BB.#.",
    "..#.BBBB.#.BB.#.",
    "..#.BBBB.#.BB.#.",
    "..#......#....#.",
    "################",
    "..#....#......#."};

}  // namespace

std::vector<ExamplePointer> make_planar_tilesets() {
    return {make_wang(), make_pipes(), make_rooms(), make_board(), make_hills(), make_fortress()};
}

std::vector<PlanarSample> make_planar_samples() {
    return {
        {"orchard", kOrchard, {3, false, true}},
        {"streets", kStreets, {3, true, true}},
        {"maze", kMaze, {3, true, false}},
        {"islands", kIslands, {3, true, true}},
        {"islands 4", kIslands, {4, true, true}},
        {"islands 5", kIslands, {5, true, true}}};
}

}  // namespace modelsynth::bench
