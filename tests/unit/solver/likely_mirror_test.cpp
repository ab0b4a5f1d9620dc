// Maps of pieces that are found for symmetries, held against the example by plain counting.

#include "solver/discrete/likely_mirror.h"

#include "solver/discrete/faults.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::make_example;
using testing::RecordingObserver;

using Kind = Symmetry::Kind;
using Names = std::map<std::string, std::string>;

constexpr std::array<Kind, 4> kMotions = {
    Kind::kReflectX, Kind::kReflectZ, Kind::kHalfTurn, Kind::kQuarterTurn};

// Where a motion takes a step in the plane; in the middle of a square of side n, a cell.
std::pair<int, int> moved(Kind kind, int x, int z) {
    switch (kind) {
        case Kind::kReflectX:
            return {-x, z};
        case Kind::kReflectZ:
            return {x, -z};
        case Kind::kHalfTurn:
            return {-x, -z};
        case Kind::kQuarterTurn:
            return {z, -x};
        case Kind::kTranslate:
            break;
    }
    return {x, z};
}

Names full(const Example& example, const NamePairs& mirror) {
    Names names(mirror.begin(), mirror.end());
    for (const auto& [piece, image] : mirror) {
        names.emplace(image, piece);  // a pair is named once
    }
    for (const Piece& piece : example.pieces) {
        names.emplace(piece.name, piece.name);
    }
    return names;
}

// "b stands so far from a": each pair of neighbours both ways.
using Beside = std::set<std::tuple<std::string, std::string, int, int, int>>;

Beside neighbours_of(const Example& example) {
    Beside beside;
    const auto add = [&](Label a, Label b, int x, int y, int z) {
        beside.emplace(example.pieces[a].name, example.pieces[b].name, x, y, z);
        beside.emplace(example.pieces[b].name, example.pieces[a].name, -x, -y, -z);
    };
    const GridSize& size = example.size;
    const auto at = [&](int x, int y, int z) { return example.cells[size.index({x, y, z})]; };
    for (int x = 0; x < size.x; ++x) {
        for (int y = 0; y < size.y; ++y) {
            for (int z = 0; z < size.z; ++z) {
                if (x + 1 < size.x) {
                    add(at(x, y, z), at(x + 1, y, z), 1, 0, 0);
                }
                if (y + 1 < size.y) {
                    add(at(x, y, z), at(x, y + 1, z), 0, 1, 0);
                }
                if (z + 1 < size.z) {
                    add(at(x, y, z), at(x, y, z + 1), 0, 0, 1);
                }
            }
        }
    }
    for (const AdjacentPair& pair : example.adjacency) {
        add(pair.lower, pair.upper, pair.axis == 0, pair.axis == 1, pair.axis == 2);
    }
    return beside;
}

// How many pairs of neighbours have images that are neighbours, and of how many.
std::pair<std::size_t, std::size_t> kept(const Example& example, Kind kind, const Names& images) {
    const Beside beside = neighbours_of(example);
    const auto has_image = [&](const auto& pair) {
        const auto& [a, b, x, y, z] = pair;
        const auto [to_x, to_z] = moved(kind, x, z);
        return beside.contains({images.at(a), images.at(b), to_x, y, to_z});
    };
    return {
        static_cast<std::size_t>(std::count_if(beside.begin(), beside.end(), has_image)) / 2,
        beside.size() / 2};
}

std::size_t kept_by(const Example& example, Kind kind, const NamePairs& mirror) {
    return kept(example, kind, full(example, mirror)).first;
}

std::string image_after(const Names& images, std::string piece, int steps) {
    for (int i = 0; i < steps; ++i) {
        piece = images.at(piece);
    }
    return piece;
}

Parameters asking(const Example& example, const GridSize& size, std::vector<Symmetry> symmetries) {
    Parameters parameters;
    parameters.size = size;
    for (Symmetry& symmetry : symmetries) {
        parameters.constraints.push_back({std::move(symmetry)});
    }
    return fill_defaults(parameters, example);
}

// The pieces of the castle that face north or east, as a person would name them.
NamePairs half_turn_of_castle() {
    NamePairs mirror;
    for (const char* piece :
         {"cottage",    "field_corner", "field_side",    "meadow_edge",     "court",
          "court_edge", "shed",         "wall",          "wall_corner",     "wall_nook",
          "gate",       "turret",       "turret_corner", "turret_nook",     "foot_corner",
          "foot_side",  "door",         "storey_corner", "storey_side",     "roof_corner",
          "roof_side",  "roof_valley",  "keep_shaft",    "keep_battlement", "keep_spire",
          "path_bend"}) {
        const std::string name = piece;
        mirror.emplace_back(name + "_e", name + "_w");
        mirror.emplace_back(name + "_n", name + "_s");
    }
    return mirror;
}

TEST(LikelyMirror, OfTheCastleIsAsGoodAsOneMadeByHand) {
    const Example castle = examples::make_castle();
    const std::size_t by_hand = kept_by(castle, Kind::kHalfTurn, half_turn_of_castle());
    const std::size_t found =
        kept_by(castle, Kind::kHalfTurn, likely_mirror(castle, Kind::kHalfTurn));
    EXPECT_GE(found, by_hand);
    EXPECT_GT(by_hand, kept_by(castle, Kind::kHalfTurn, {}));
}

TEST(LikelyMirror, KeepsMostOfTheBuiltInExamples) {
    for (const auto& example : examples::built_in()) {
        for (const Kind kind : kMotions) {
            const NamePairs mirror = likely_mirror(*example, kind);
            const auto [found, all] = kept(*example, kind, full(*example, mirror));
            const std::size_t unmoved = kept_by(*example, kind, {});
            EXPECT_GE(found, unmoved) << example->name;
            EXPECT_GE(found * 4, all * 3) << example->name;
        }
    }
}

TEST(LikelyMirror, ComesBackAsTheCellsDo) {
    for (const auto& example : examples::built_in()) {
        for (const Kind kind : kMotions) {
            const Names images = full(*example, likely_mirror(*example, kind));
            std::set<std::string> reached;
            for (const auto& [piece, image] : images) {
                const int order = kind == Kind::kQuarterTurn ? 4 : 2;
                EXPECT_EQ(image_after(images, piece, order), piece) << example->name;
                EXPECT_TRUE(reached.insert(image).second) << image;
            }
            EXPECT_TRUE(find_faults(*example, asking(*example, {8, 6, 8}, {{kind}})).empty());
            Parameters filled = asking(*example, {8, 6, 8}, {{kind}});
            fill_mirrors(*example, filled);
            EXPECT_TRUE(find_faults(*example, filled).empty()) << example->name;
        }
    }
}

TEST(LikelyMirror, TurnsWhatIsBuiltInFourTurns) {
    const Names images =
        full(examples::make_castle(), likely_mirror(examples::make_castle(), Kind::kQuarterTurn));
    EXPECT_EQ(images.at("cottage_e"), "cottage_n");
    EXPECT_EQ(images.at("cottage_n"), "cottage_w");
    EXPECT_EQ(images.at("gate_s"), "gate_e");
}

TEST(LikelyMirror, IsNothingForATranslation) {
    for (const auto& example : examples::built_in()) {
        EXPECT_EQ(likely_mirror(*example, Kind::kTranslate), NamePairs());
    }
}

TEST(LikelyMirror, ExchangesTheEndsOfAWall) {
    // a a a a a    b is the western end of a wall, c its middle, d its eastern end.
    // a b c c d
    const Example wall =
        make_example({6, 1, 3}, {0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 3, 0, 0, 0, 0, 0, 0, 0}, 4);
    EXPECT_EQ(likely_mirror(wall, Kind::kReflectX), (NamePairs{{"b", "d"}, {"d", "b"}}));
    EXPECT_EQ(likely_mirror(wall, Kind::kReflectZ), NamePairs());
    EXPECT_EQ(likely_mirror(wall, Kind::kHalfTurn), (NamePairs{{"b", "d"}, {"d", "b"}}));
}

TEST(LikelyMirror, TurnsARing) {
    // a a a a a    Corners and sides of a yard f: corners b c h g, sides d e i j go round.
    // a b d c a
    // a e f i a
    // a g j h a
    // a a a a a
    const Example yard = make_example(
        {5, 1, 5}, {0, 0, 0, 0, 0, 0, 1, 3, 2, 0, 0, 4, 5, 8, 0, 0, 6, 9, 7, 0, 0, 0, 0, 0, 0}, 10
    );
    // East to north, north to west.
    const Names images = full(yard, likely_mirror(yard, Kind::kQuarterTurn));
    EXPECT_EQ(images.at("i"), "d");
    EXPECT_EQ(images.at("d"), "e");
    EXPECT_EQ(images.at("e"), "j");
    EXPECT_EQ(images.at("j"), "i");
    EXPECT_EQ(images.at("c"), "b");
    EXPECT_EQ(images.at("b"), "g");
    const auto [found, all] = kept(yard, Kind::kQuarterTurn, images);
    EXPECT_EQ(found, all);
}

TEST(LikelyMirror, LeavesPiecesOnTheirSide) {
    // What may stand on the bottom has images that may; c could be b's image but for that.
    Example example = make_example({0, 0, 0}, {}, 3);
    for (const std::uint8_t axis : {std::uint8_t{0}, std::uint8_t{2}}) {
        for (Label a = 0; a < 3; ++a) {
            example.adjacency.push_back({axis, a, a});
        }
    }
    example.boundary[static_cast<std::size_t>(Direction::kDown)] = {
        BoundaryKind::kPieces, {"a", "b"}};
    const Names images = full(example, likely_mirror(example, Kind::kReflectX));
    EXPECT_EQ(images.at("c"), "c");
}

TEST(LikelyMirror, IsFoundInExamplesOfThousandsOfPieces) {
    // A row of pieces that each stand but once: more of them than can be held against each other.
    constexpr std::size_t kCount = 4096;
    std::vector<Label> cells(kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        cells[i] = static_cast<Label>(i);
    }
    Example row = make_example({kCount, 1, 1}, cells, 1);
    row.pieces.clear();
    for (std::size_t i = 0; i < kCount; ++i) {
        row.pieces.push_back({"piece " + std::to_string(i), {}, 0, 1});
    }
    const NamePairs found = likely_mirror(row, Kind::kQuarterTurn);
    EXPECT_EQ(found, likely_mirror(row, Kind::kQuarterTurn));
    const Names images = full(row, found);
    for (const auto& [piece, image] : images) {
        EXPECT_EQ(image_after(images, piece, 4), piece);
    }
}

TEST(LikelyMirror, IsWhatAModelWithoutOneHolds) {
    for (const auto& example : examples::built_in()) {
        for (const Kind kind : kMotions) {
            constexpr GridSize kSize = {16, 8, 16};
            const Parameters parameters = asking(*example, kSize, {{kind}});
            RecordingObserver observer;
            const auto made = synthesise(*example, parameters, 5, observer, {});
            ASSERT_TRUE(made) << example->name << ": " << made.error().message;
            const Names images = full(*example, likely_mirror(*example, kind));
            const auto name_at = [&](int x, int y, int z) {
                return example->pieces[made->labels[kSize.index({x, y, z})]].name;
            };
            std::size_t wrong = 0;
            for (int x = 0; x < kSize.x; ++x) {
                for (int y = 0; y < kSize.y; ++y) {
                    for (int z = 0; z < kSize.z; ++z) {
                        const int last = kSize.x - 1;
                        const auto [to_x, to_z] = moved(kind, 2 * x - last, 2 * z - last);
                        wrong += name_at((to_x + last) / 2, y, (to_z + last) / 2) !=
                                 images.at(name_at(x, y, z));
                    }
                }
            }
            EXPECT_EQ(wrong, 0U) << example->name;
            EXPECT_GT(made->stats.changed, 0U) << example->name;
        }
    }
}

}  // namespace
}  // namespace modelsynth::discrete
