// Constraints of solids, looked at in the polygons of what is made.

#include "solver/continuous/problem.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/core/weight_tables.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/solid_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using testing::SolidPlaces;

using Reading = std::shared_ptr<const ExampleReading>;

class Silent final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport&) override {}
};

// Boxes of two kinds on grass, and one on another.
Reading read_boxes() {
    Example example;
    example.name = "boxes";
    example.materials = {{"grass", {}}, {"a", {}}, {"b", {}}};
    example.objects = {{"grass", 0}, {"a", 1}, {"b", 2}};
    example.ground = 1;
    example.polyhedra = {
        box(2, {0, 0, 0}, {3, 2, 4}),
        box(3, {0, 0, 6}, {2, 3, 9}),
        // Two-storeyed and with a wing: corners of every kind.
        box(2, {6, 0, 0}, {10, 1, 4}),
        box(2, {6, 1, 0}, {8, 2, 2}),
        box(3, {12, 0, 0}, {16, 1, 4}),
        box(3, {12, 0, 4}, {14, 1, 6})};
    example.density = 0.8;
    return ExampleReading::make(std::move(example)).value();
}

Parameters asking(
    const Reading& reading, const std::array<double, 3>& size, std::vector<Constraint> constraints
) {
    Parameters parameters;
    parameters.size = size;
    parameters.constraints = std::move(constraints);
    return fill_defaults(parameters, reading->example());
}

// A model, to be asked what is where.
struct Made {
    Surface surface;
    SolidPlaces places;
};

Made make(const Reading& reading, const Parameters& parameters, std::uint64_t seed) {
    const Problem problem = make_problem(reading, parameters).value();
    Silent silent;
    const Synthesis made = synthesise(problem, parameters, seed, silent, {}).value();
    Surface surface = make_surface(problem, made.labels);
    const Bounds& box = problem.arrangement.frame().box;
    SolidPlaces places(surface, reading->example().objects.size(), {box.min, box.max});
    return {std::move(surface), std::move(places)};
}

// Calls visit(place) for points beside the planes, eight of them a metre of every direction.
template <class Visit>
void for_each_place(const MetreBox& box, Visit visit) {
    constexpr double kStep = 0.5;
    for (double x = box.min[0] + 0.26; x < box.max[0]; x += kStep) {
        for (double y = box.min[1] + 0.23; y < box.max[1]; y += kStep) {
            for (double z = box.min[2] + 0.27; z < box.max[2]; z += kStep) {
                visit(Point(x, y, z));
            }
        }
    }
}

std::size_t count_in(const Made& made, const MetreBox& box, ObjectId object) {
    std::size_t count = 0;
    for_each_place(box, [&](const Point& place) {
        count += made.places.at(place) == object ? 1U : 0U;
    });
    return count;
}

std::size_t places_in(const MetreBox& box) {
    std::size_t count = 0;
    for_each_place(box, [&](const Point& /*place*/) { ++count; });
    return count;
}

// --- what hangs together

struct Network {
    const char* example;
    std::array<double, 3> size;
};

class BuiltInNetworks : public ::testing::TestWithParam<Network> {
  protected:
    [[nodiscard]] static std::size_t pieces(std::uint64_t seed, bool is_connected) {
        const Reading reading = examples::find_solids(GetParam().example);
        Parameters parameters;
        parameters.size = GetParam().size;
        parameters = fill_defaults(parameters, reading->example());
        if (!is_connected) {
            std::erase_if(*parameters.constraints, [](const Constraint& constraint) {
                return std::holds_alternative<ConnectedRule>(constraint.rule);
            });
        }
        return make(reading, parameters, seed).places.pieces(reading->example().connected.front());
    }
};

TEST_P(BuiltInNetworks, AreOnePiece) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        EXPECT_EQ(pieces(seed, true), 1U) << "seed " << seed;
    }
}

TEST_P(BuiltInNetworks, ComeInPiecesOtherwise) {
    std::size_t most = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        most = std::max(most, pieces(seed, false));
    }
    EXPECT_GT(most, 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    BuiltInNetworks,
    ::testing::Values(
        Network{"roads", {60, 9, 60}},
        Network{"plumbing", {16, 10, 16}},
        Network{"spaceships", {24, 9, 24}}
    ),
    [](const auto& tested) { return std::string(tested.param.example); }
);

TEST(SolidsConnected, ComeInAsManyPiecesAsAllowed) {
    const Reading reading = read_boxes();
    std::size_t most = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Parameters parameters =
            asking(reading, {20, 4, 20}, {{ConnectedRule{3}, {"a"}}, {ConnectedRule{1}, {"b"}}});
        const Made made = make(reading, parameters, seed);
        EXPECT_LE(made.places.pieces({2}), 3U) << "seed " << seed;
        EXPECT_EQ(made.places.pieces({3}), 1U) << "seed " << seed;
        most = std::max(most, made.places.pieces({2}));
    }
    EXPECT_GT(most, 1U);
    EXPECT_GT(make(reading, asking(reading, {20, 4, 20}, {}), 1).places.pieces({2}), 3U);
}

// What is fixed apart is joined while something else begins, and tries of it are taken back.
TEST(SolidsConnected, WhatIsFixedApartIsJoinedOrGivenUp) {
    const Reading reading = read_boxes();
    const auto fixed_at = [](double x) {
        return Constraint{FixedRule{}, {"b"}, {MetreBox{{x, 0, 4}, {x + 1, 1, 5}}}};
    };
    std::size_t joined = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Parameters parameters = asking(
            reading,
            {10, 4, 10},
            {{ConnectedRule{1}, {"a"}}, {ConnectedRule{1}, {"b"}}, fixed_at(3), fixed_at(6)}
        );
        const Problem problem = make_problem(reading, parameters).value();
        Silent silent;
        const auto made = synthesise(problem, parameters, seed, silent, {});
        if (!made) {
            EXPECT_EQ(made.error().code, ErrorCode::kGaveUp) << made.error().message;
            continue;
        }
        ++joined;
        const Surface surface = make_surface(problem, made->labels);
        const Bounds& frame = problem.arrangement.frame().box;
        const SolidPlaces places(surface, 3, {frame.min, frame.max});
        EXPECT_EQ(places.pieces({3}), 1U);
        EXPECT_EQ(places.at(Point(3.4, 0.4, 4.4)), 3);
        EXPECT_EQ(places.at(Point(6.4, 0.4, 4.4)), 3);
    }
    EXPECT_GT(joined, 0U);
}

TEST(SolidPlaces, CountPiecesThatTouchAtACornerAsOneAndHollowsAsNone) {
    Example example;
    example.name = "pair";
    example.materials = {{"a", {}}, {"b", {}}};
    example.objects = {{"a", 0}, {"b", 1}};
    example.polyhedra = {box(1, {0, 0, 0}, {1, 1, 1}), box(1, {1, 1, 1}, {2, 2, 2})};
    const Reading reading = ExampleReading::make(std::move(example)).value();
    const auto with = [&](const std::vector<Polyhedron>& solids) {
        Surface surface;
        for (const Polyhedron& solid : solids) {
            const auto first = static_cast<std::uint32_t>(surface.points.size());
            surface.points.insert(surface.points.end(), solid.corners.begin(), solid.corners.end());
            for (const Face& face : solid.faces) {
                SurfacePolygon& polygon = surface.polygons.emplace_back();
                polygon.object = solid.object;
                std::vector<std::uint32_t>& loop = polygon.loops.emplace_back(face);
                for (std::uint32_t& corner : loop) {
                    corner += first;
                }
            }
        }
        return SolidPlaces(surface, 2, {Point(-1, -1, -1), Point(9, 9, 9)}).pieces({1, 2});
    };
    const Polyhedron cube = box(1, {0, 0, 0}, {3, 3, 3});
    EXPECT_EQ(with({cube}), 1U);
    EXPECT_EQ(with({cube, box(1, {3, 3, 3}, {4, 4, 4})}), 1U);
    EXPECT_EQ(with({cube, box(1, {3.001, 3, 3}, {4, 4, 4})}), 2U);
    // Edges that cross, and a face within a face.
    EXPECT_EQ(with({cube, box(2, {1, 3, -1}, {2, 4, 4})}), 1U);
    EXPECT_EQ(with({cube, box(2, {1, 3, 1}, {2, 4, 2})}), 1U);
    Polyhedron hollow = box(1, {1, 1, 1}, {2, 2, 2});
    for (Face& face : hollow.faces) {
        std::reverse(face.begin(), face.end());
    }
    EXPECT_EQ(with({cube, hollow}), 1U);
    EXPECT_EQ(with({cube, hollow, box(2, {1.2, 1.2, 1.2}, {1.8, 1.8, 1.8})}), 2U);
}

// --- what stands where

TEST(SolidsFixed, FillTheirBox) {
    const Reading reading = read_boxes();
    const MetreBox tower = {{3, 0, 4}, {6, 3, 6}};
    const MetreBox square = {{7, 0, 1}, {11, 4, 9}};
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Made made = make(
            reading,
            asking(
                reading,
                {12, 5, 12},
                {{FixedRule{}, {"b"}, {tower}}, {FixedRule{}, {"empty"}, {square}}}
            ),
            seed
        );
        EXPECT_EQ(count_in(made, tower, 3), places_in(tower));
        EXPECT_EQ(count_in(made, square, kEmpty), places_in(square));
        const MetreBox all = {{0, 0, 0}, {12, 5, 12}};
        EXPECT_GT(count_in(made, all, 2), 0U);
    }
}

TEST(SolidsFixed, OneOfSeveralObjectsFillsTheBox) {
    const Reading reading = read_boxes();
    const MetreBox place = {{3, 0, 3}, {8, 1, 8}};
    const Made made =
        make(reading, asking(reading, {12, 5, 12}, {{FixedRule{}, {"a", "b"}, {place}}}), 1);
    EXPECT_EQ(count_in(made, place, kEmpty), 0U);
}

TEST(SolidsForbidden, LeaveTheirRegion) {
    const Reading reading = read_boxes();
    const MetreBox all = {{0, 0, 0}, {16, 5, 16}};
    const MetreBox west = {{0, 0, 0}, {8, 5, 16}};
    const MetreBox east = {{8, 0, 0}, {16, 5, 16}};
    const MetreBox south = {{0, 0, 8}, {16, 5, 16}};
    Region mask;
    mask.mask = Mask{1, 2, {0, 255}, ""};  // white in the south
    Region voxels;
    voxels.voxels = Voxels{{2, 1, 1}, {1, 0.5}};  // the west
    std::size_t in_east = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto made = [&](const Rule& rule, const Region& region) {
            return make(reading, asking(reading, {16, 5, 16}, {{rule, {"a"}, region}}), seed);
        };
        EXPECT_EQ(count_in(made(ForbiddenRule{}, {west}), west, 2), 0U);
        EXPECT_EQ(count_in(made(ForbiddenRule{}, mask), south, 2), 0U);
        const Made by_voxels = made(ProbabilityRule{0}, voxels);
        EXPECT_EQ(count_in(by_voxels, west, 2), 0U);
        in_east += count_in(by_voxels, east, 2);
        EXPECT_EQ(count_in(made(ForbiddenRule{}, {}), all, 2), 0U);
        EXPECT_GT(count_in(made(ProbabilityRule{1}, voxels), west, 2), 0U);
    }
    EXPECT_GT(in_east, 0U);
}

// Roads lie below y = 0.
// However near to it other planes are.
TEST(SolidsForbidden, StandBesideTheirRegion) {
    const Reading reading = read_boxes();
    const MetreBox region = {{0.5, 0, 0}, {1.5, 3, 6}};
    Parameters parameters;
    parameters.density = 1;
    parameters.spacings = {{{1, 0, 0}, 0.1}};
    parameters.size = {2, 3, 6};
    parameters.constraints = {{ForbiddenRule{}, {"a", "b"}, {region}}};
    parameters = fill_defaults(parameters, reading->example());
    std::size_t beside = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Made made = make(reading, parameters, seed);
        for (double z = 0.5; z < 6; ++z) {
            for (const double x : {0.45, 1.55}) {
                beside += made.places.at({x, 0.5, z}) > 1 ? 1U : 0U;
            }
            for (const double x : {0.55, 1.05, 1.45}) {
                EXPECT_EQ(made.places.at({x, 0.5, z}), kEmpty) << "seed " << seed;
            }
        }
    }
    EXPECT_GT(beside, 5U);
}

TEST(SolidsForbidden, AreNotSunkIntoTheGroundEither) {
    const Reading roads = examples::find_solids("roads");
    const std::vector<ObjectId>& network = roads->example().connected.front();
    std::vector<std::string> names;
    for (const ObjectId road : network) {
        names.push_back(roads->example().objects[road - 1U].name);
    }
    const auto corners = [&](const Rule& rule, const Region& region) {
        const Made made = make(roads, asking(roads, {60, 5, 60}, {{rule, names, region}}), 4);
        std::array<std::size_t, 2> of_halves = {};
        for (const SurfacePolygon& polygon : made.surface.polygons) {
            if (std::find(network.begin(), network.end(), polygon.object) != network.end()) {
                for (const std::uint32_t point : polygon.loops.front()) {
                    ++of_halves.at(made.surface.points[point].x() < 30 - 1e-9 ? 0 : 1);
                }
            }
        }
        return of_halves;
    };
    Region west;
    west.voxels = Voxels{{2, 1, 1}, {1, 0}};
    for (const Rule& rule : {Rule(ForbiddenRule{}), Rule(ProbabilityRule{0})}) {
        EXPECT_EQ(corners(rule, {}), (std::array<std::size_t, 2>{0, 0}));
        const auto in_halves = corners(rule, west);
        EXPECT_EQ(in_halves[0], 0U);
        EXPECT_GT(in_halves[1], 0U);
    }
    EXPECT_GT(corners(ProbabilityRule{1}, west)[0], 0U);
}

TEST(SolidsForbidden, EmptySpaceMeansThatSomethingIsThere) {
    const Reading reading = read_boxes();
    const MetreBox place = {{4, 0, 4}, {6, 2, 6}};
    const Made made =
        make(reading, asking(reading, {12, 5, 12}, {{ForbiddenRule{}, {"empty"}, {place}}}), 1);
    EXPECT_EQ(count_in(made, place, kEmpty), 0U);
}

TEST(SolidsProbable, AreMoreWhereTheirWeightIsHigh) {
    const Reading reading = read_boxes();
    const MetreBox west = {{0, 0, 0}, {8, 4, 16}};
    const MetreBox east = {{8, 0, 0}, {16, 4, 16}};
    Region in_west;
    in_west.voxels = Voxels{{2, 1, 1}, {1, 0}};
    const auto counts = [&](double weight) {
        std::array<std::size_t, 2> of_halves = {};
        for (std::uint64_t seed = 1; seed <= 12; ++seed) {
            Parameters parameters =
                asking(reading, {16, 4, 16}, {{ProbabilityRule{weight}, {"a"}, in_west}});
            parameters.density = 0.2;
            const Made made = make(reading, parameters, seed);
            of_halves[0] += count_in(made, west, 2);
            of_halves[1] += count_in(made, east, 2);
        }
        return of_halves;
    };
    const auto rare = counts(0.1);
    const auto frequent = counts(10);
    EXPECT_LT(2 * rare[0], rare[1]);
    EXPECT_GT(2 * frequent[0], 3 * frequent[1]);
}

// --- how wide

TEST(SolidsDimension, OfThreeSpacingsIsHowWideTheyAre) {
    const Reading reading = read_boxes();
    std::size_t extents = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Made made = make(
            reading, asking(reading, {17, 5, 17}, {{DimensionRule{{-1, 0, 0}, 3}, {"a"}}}), seed
        );
        for (double y = 0.5; y < 5; ++y) {
            for (double z = 0.5; z < 17; ++z) {
                int length = 0;
                for (int x = 0; x <= 17; ++x) {
                    const bool is_there =
                        x < 17 && made.places.at(Point(x + 0.5, y, z + 0.01)) == 2;
                    // The second of two that stand side by side begins at a plane, too.
                    if (length > 0 && (!is_there || x % 3 == 0)) {
                        EXPECT_EQ(length, 3) << "ends at " << x << ", " << y << ", " << z;
                        EXPECT_EQ(x % 3, 0);
                        ++extents;
                        length = 0;
                    }
                    length += is_there ? 1 : 0;
                }
            }
        }
        // What stands side by side has a face between.
        for (const SurfacePolygon& polygon : made.surface.polygons) {
            double low = 1e9;
            double high = -1e9;
            for (const std::uint32_t point : polygon.loops.front()) {
                low = std::min(low, made.surface.points[point].x());
                high = std::max(high, made.surface.points[point].x());
            }
            EXPECT_TRUE(polygon.object != 2 || high - low <= 3 + 1e-9);
        }
    }
    EXPECT_GT(extents, 20U);
}

// --- what cannot be

Error error_of(const Reading& reading, const Parameters& parameters) {
    const auto problem = make_problem(reading, parameters);
    EXPECT_FALSE(problem);
    return problem ? Error{} : problem.error();
}

TEST(SolidConstraintFaults, AContradictionTellsItsPlace) {
    const Reading reading = read_boxes();
    const Error at_border = error_of(
        reading,
        asking(reading, {12, 5, 12}, {{FixedRule{}, {"a"}, {MetreBox{{9, 0, 4}, {12, 2, 6}}}}})
    );
    EXPECT_EQ(at_border.code, ErrorCode::kContradiction);
    double x = 0;
    double y = 0;
    double z = 0;
    const std::size_t at = at_border.message.find('[');
    ASSERT_NE(at, std::string::npos) << at_border.message;
    ASSERT_EQ(
        std::sscanf(at_border.message.c_str() + at, "[%lf, %lf, %lf] (metres)", &x, &y, &z), 3
    ) << at_border.message;
    EXPECT_TRUE(x >= 8 && x <= 12 && z >= 3 && z <= 7) << at_border.message;

    const Error apart = error_of(
        reading,
        asking(
            reading,
            {12, 5, 12},
            {{FixedRule{}, {"a"}, {MetreBox{{4, 0, 4}, {6, 2, 6}}}},
             {ForbiddenRule{}, {"a"}, {MetreBox{{5, 0, 5}, {7, 2, 7}}}}}
        )
    );
    EXPECT_EQ(apart.code, ErrorCode::kContradiction);
    EXPECT_NE(apart.message.find("(metres)"), std::string::npos) << apart.message;
}

TEST(SolidConstraintFaults, TooManyTablesOfWeightsAreTooLarge) {
    const Reading reading = read_boxes();
    const auto asking_for = [&](std::int32_t values) {
        Region region;
        Voxels& voxels = region.voxels.emplace();
        voxels.size = {100, 1, 50};
        for (std::int32_t i = 0; i < 5000; ++i) {
            voxels.values.push_back((1 + i % values) / 5001.0);
        }
        return asking(reading, {100, 2, 50}, {{ProbabilityRule{2}, {"a"}, region}});
    };
    EXPECT_EQ(error_of(reading, asking_for(5000)).code, ErrorCode::kTooLarge);
    EXPECT_TRUE(make_problem(reading, asking_for(static_cast<std::int32_t>(kWeightTablesMax) / 2)));
}

// --- what holds when nothing is said

TEST(SolidConstraintDefaults, AreTheExamplesForKindsThatAreNotSpokenOf) {
    const Reading roads = examples::find_solids("roads");
    const Example& example = roads->example();
    const auto filled = [&](std::optional<std::vector<Constraint>> constraints) {
        Parameters parameters;
        parameters.constraints = std::move(constraints);
        return *fill_defaults(parameters, example).constraints;
    };
    const auto count = [](const std::vector<Constraint>& constraints, std::size_t kind) {
        return static_cast<std::size_t>(std::count_if(
            constraints.begin(),
            constraints.end(),
            [&](const Constraint& constraint) { return constraint.rule.index() == kind; }
        ));
    };
    constexpr std::size_t kDimension = 0;
    constexpr std::size_t kConnected = 1;
    const auto all = filled(std::nullopt);
    EXPECT_EQ(count(all, kDimension), example.dimensions.size());
    ASSERT_EQ(count(all, kConnected), 1U);
    EXPECT_EQ(all.back().objects.size(), example.connected.front().size());
    EXPECT_TRUE(filled(std::vector<Constraint>()).empty());

    const Constraint forbidden = {ForbiddenRule{}, {"tree"}};
    const auto beside = filled({{forbidden}});
    EXPECT_EQ(beside.size(), all.size() + 1);
    EXPECT_EQ(beside.front(), forbidden);

    const Constraint dimension = {DimensionRule{{0, 1, 0}, 2}, {"wall"}};
    const auto other_dimension = filled({{dimension}});
    EXPECT_EQ(count(other_dimension, kDimension), 1U);
    EXPECT_EQ(count(other_dimension, kConnected), 1U);

    const Constraint connected = {ConnectedRule{4}, {"tree"}};
    const auto other_connected = filled({{connected}});
    EXPECT_EQ(count(other_connected, kConnected), 1U);
    EXPECT_EQ(count(other_connected, kDimension), example.dimensions.size());

    // Of no objects: nothing has to hang together, and the rest is the example's.
    const Constraint let_go = {ConnectedRule{}, {}};
    const auto loose = filled({{let_go}});
    EXPECT_EQ(count(loose, kConnected), 1U);
    EXPECT_EQ(loose.front(), let_go);
    EXPECT_EQ(count(loose, kDimension), example.dimensions.size());

    // What is filled in stays as it is.
    Parameters again;
    again.constraints = other_connected;
    EXPECT_EQ(*fill_defaults(again, example).constraints, other_connected);
}

}  // namespace
}  // namespace modelsynth::continuous
