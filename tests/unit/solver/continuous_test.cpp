// Continuous synthesis: what is read of an example, where planes lie, and what is made.

#include "solver/continuous/faults.h"
#include "solver/continuous/planes/spacing.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/problem_cache.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/shapes.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <memory>
#include <set>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using examples::Outline;
using examples::prism_along_z;
using examples::pyramid;

using Reading = std::shared_ptr<const ExampleReading>;

Example plain(std::vector<Polyhedron> solids, std::optional<ObjectId> ground = std::nullopt) {
    Example example;
    example.name = "plain";
    example.materials = {{"a", {}}, {"b", {}}, {"c", {}}};
    example.objects = {{"a", 0}, {"b", 1}, {"c", 2}};
    example.polyhedra = std::move(solids);
    example.ground = ground;
    return example;
}

Polyhedron tetrahedron(ObjectId object) {
    Polyhedron solid;
    solid.object = object;
    solid.corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    solid.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return solid;
}

Reading read(Example example) { return ExampleReading::make(std::move(example)).value(); }

Parameters of_size(const Example& example, const std::array<double, 3>& size) {
    Parameters parameters;
    parameters.size = size;
    return fill_defaults(parameters, example);
}

class Silent final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport&) override {}
};

std::size_t count_at(const Figures& figures, FamilySet families) {
    std::size_t count = 0;
    for (std::size_t label = 0; label < figures.count(); ++label) {
        count += std::size_t{(figures.relevant(static_cast<Label>(label)) & ~families) == 0};
    }
    return count;
}

TEST(Topes, AreAsManyAsRegionsOfTheSphere) {
    // Of m planes in general position m (m - 1) + 2; fewer where several meet in one line.
    const auto count = [](std::vector<Point> normals) {
        for (Point& normal : normals) {
            normal.normalize();
        }
        return Topes::make(std::move(normals))->count();
    };
    EXPECT_EQ(count({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}), 8U);
    EXPECT_EQ(count({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}), 14U);
    EXPECT_EQ(count({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}), 12U);
    EXPECT_EQ(count({{1, 2, 3}, {3, 1, 0}, {0, 1, 5}, {1, -1, 1}, {2, 0, -1}}), 22U);
}

TEST(Topes, LieOnTheSidesThatTheySay) {
    const Reading reading = read(plain({tetrahedron(1)}));
    const Topes& topes = reading->topes();
    for (std::size_t t = 0; t < topes.count(); ++t) {
        const auto tope = static_cast<Tope>(t);
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            const double height = topes.normals()[family].dot(topes.inside(tope));
            EXPECT_EQ(height > 0, (topes.sides(tope) >> family & 1) != 0);
            EXPECT_GT(std::abs(height), 1e-3);
        }
        EXPECT_EQ(topes.tope_of(topes.sides(tope)), tope);
    }
}

TEST(Topes, RefusePlanesThatDoNotSpanSpace) {
    EXPECT_FALSE(Topes::make({{1, 0, 0}, {0, 1, 0}}));
    EXPECT_FALSE(Topes::make({{1, 0, 0}, {0, 1, 0}, Point(1, 1, 0).normalized()}));
    // Nor those of which it cannot be said whether they do.
    EXPECT_FALSE(Topes::make({{1, 0, 0}, {0, 1, 0}, Point(1, 1, 2e-6).normalized()}));
}

TEST(Figures, OfATetrahedronAreTheThesissSixteen) {
    const Reading reading = read(plain({tetrahedron(1)}));
    EXPECT_EQ(reading->topes().family_count(), 4U);
    EXPECT_EQ(reading->figures().count(), 16U);
    EXPECT_EQ(count_at(reading->figures(), 0b0111), 9U);
    EXPECT_EQ(count_at(reading->figures(), 0b1011), 9U);
    EXPECT_EQ(count_at(reading->figures(), 0b0011), 5U);
}

TEST(Figures, LookTheSameFromBothEndsOfAnEdge) {
    const Reading reading = read(plain(
        {box(2, {0, 0, 0}, {2, 1, 3}), prism_along_z(3, {{0, 1}, {2, 1}, {1, 2}}, 0, 3)},
        ObjectId{1}
    ));
    const Figures& figures = reading->figures();
    for (std::size_t l = 0; l < figures.count(); ++l) {
        const auto label = static_cast<Label>(l);
        for (std::size_t h = 0; h < reading->topes().heading_count(); ++h) {
            const auto heading = static_cast<Heading>(h);
            const Label edge = figures.along(label, heading);
            EXPECT_EQ(figures.along(edge, heading), edge);
            EXPECT_EQ(figures.along(edge, opposite(heading)), edge);
            EXPECT_EQ(figures.relevant(edge) & ~reading->topes().lines()[h / 2].families, 0U);
            EXPECT_TRUE(reading->relations().allows(heading, label, edge));
        }
    }
}

TEST(Figures, SeeWhereEdgesTouch) {
    // Two boxes that share a part of one edge and nothing else: no corner of the one tells so.
    const Reading apart = read(plain({box(1, {0, 0, 0}, {1, 1, 1}), box(1, {3, 3, 0}, {4, 4, 1})}));
    const Reading touching =
        read(plain({box(1, {0, 0, 0}, {1, 1, 2}), box(1, {1, 1, 1}, {2, 2, 3})}));
    EXPECT_GT(touching->figures().count(), apart->figures().count());
}

TEST(Spacings, LetFourPlanesMeet) {
    // Slopes of 45 degrees over a square: all four meet in the apex.
    const Outline square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const Reading reading = read(plain({pyramid(2, square, 0, {1, 1, -1})}, ObjectId{1}));
    const std::vector<double> free(reading->topes().family_count(), 0);
    const Spacings solved = solve_spacings(reading->figures(), 1, free);
    EXPECT_TRUE(solved.conflicts.empty());
    for (std::size_t family = 0; family < solved.of_family.size(); ++family) {
        const bool is_slanted = std::abs(reading->topes().normals()[family].y()) < 0.9;
        EXPECT_NEAR(solved.of_family[family], is_slanted ? std::sqrt(0.5) : 1, 1e-9);
    }
    const Problem problem = make_problem(reading, of_size(reading->example(), {8, 4, 8})).value();
    EXPECT_TRUE(problem.homeless.empty());
}

TEST(ProblemCache, KeepsNothingThatWasStopped) {
    const Outline square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    const Reading reading = read(plain({pyramid(2, square, 0, {1, 1, -1})}, ObjectId{1}));
    const Parameters parameters = of_size(reading->example(), {8, 4, 8});
    ProblemCache cache;
    std::stop_source stop;
    stop.request_stop();
    const auto stopped = cache.find_or_make(reading, parameters, stop.get_token());
    ASSERT_FALSE(stopped.has_value());
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    const auto made = cache.find_or_make(reading, parameters).value();
    EXPECT_EQ(cache.find_or_make(reading, parameters).value(), made);
}

TEST(Spacings, TellWhatCannotMeet) {
    // Five slopes that meet in one point: no spacings of five families do that everywhere.
    Outline pentagon;
    for (int i = 0; i < 5; ++i) {
        const double angle = 2 * 3.14159265358979323846 * i / 5;
        pentagon.push_back({std::cos(angle), std::sin(angle)});
    }
    const Reading reading = read(plain({pyramid(2, pentagon, 0, {0, 1, 0})}, ObjectId{1}));
    const std::vector<double> free(reading->topes().family_count(), 0);
    EXPECT_FALSE(solve_spacings(reading->figures(), 1, free).conflicts.empty());
}

TEST(Arrangement, OfCubesIsAGrid) {
    const Reading reading = read(plain({box(1, {0, 0, 0}, {1, 1, 1})}));
    const Problem problem = make_problem(reading, of_size(reading->example(), {4, 3, 5})).value();
    EXPECT_EQ(problem.arrangement.vertex_count(), 3U * 2U * 4U);
    for (std::size_t i = 0; i < problem.arrangement.vertex_count(); ++i) {
        const auto site = static_cast<Site>(i);
        EXPECT_EQ(problem.arrangement.edges(site).size(), 6U);
        EXPECT_EQ(problem.arrangement.families(site), 7U);
    }
}

TEST(Arrangement, HasEveryEdgeFromBothEnds) {
    const Reading reading = read(plain({tetrahedron(1)}));
    const Problem problem = make_problem(reading, of_size(reading->example(), {5, 4, 5})).value();
    const Arrangement& arrangement = problem.arrangement;
    for (std::size_t i = 0; i < arrangement.vertex_count(); ++i) {
        const auto site = static_cast<Site>(i);
        for (const ArrangementEdge& edge : arrangement.edges(site)) {
            if (edge.end == kNoSite) {
                continue;
            }
            const Point way = arrangement.position(edge.end) - arrangement.position(site);
            EXPECT_NEAR(way.normalized().dot(reading->topes().direction(edge.heading)), 1, 1e-9);
            std::size_t back = 0;
            for (const ArrangementEdge& other : arrangement.edges(edge.end)) {
                back += other.heading == opposite(edge.heading) && other.end == site ? 1U : 0U;
            }
            EXPECT_EQ(back, 1U);
        }
    }
}

TEST(Continuous, StartsAgainFromACheckpoint) {
    const Reading reading = read(plain({box(2, {0, 0, 0}, {2, 1, 3})}, ObjectId{1}));
    Parameters parameters = of_size(reading->example(), {14, 5, 14});
    const Problem problem = make_problem(reading, parameters).value();

    class Keeper final : public Observer {
      public:
        void on_start(std::uint32_t, std::span<const Label>) override {}

        void on_block(const BlockReport& report) override {
            kept.push_back(
                {report.index + 1, report.tally, {report.model.begin(), report.model.end()}}
            );
        }

        std::vector<Checkpoint> kept;
    };

    Keeper keeper;
    const auto whole = synthesise(problem, parameters, 5, keeper, {}).value();
    ASSERT_GT(keeper.kept.size(), 3U);
    for (const Checkpoint& checkpoint : keeper.kept) {
        Silent silent;
        EXPECT_EQ(
            synthesise(problem, parameters, 5, silent, {}, &checkpoint)->labels, whole.labels
        );
    }
}

TEST(Continuous, AnObjectEndsWhereItsDimensionSays) {
    Example example = plain({box(2, {0, 0, 0}, {1, 1, 5})}, ObjectId{1});
    example.dimensions = {{2, {1, 0, 0}}};
    example.density = 1;
    const Reading reading = read(std::move(example));
    const Parameters parameters = of_size(reading->example(), {12, 6, 12});
    const Problem problem = make_problem(reading, parameters).value();
    Silent silent;
    const auto made = synthesise(problem, parameters, 1, silent, {}).value();
    const Surface surface = make_surface(problem, made.labels);
    std::size_t walls = 0;
    for (const SurfacePolygon& polygon : surface.polygons) {
        if (polygon.object != 2) {
            continue;
        }
        ++walls;
        double low = 1e9;
        double high = -1e9;
        for (const std::uint32_t point : polygon.loops.front()) {
            low = std::min(low, surface.points[point].x());
            high = std::max(high, surface.points[point].x());
        }
        EXPECT_LE(high - low, 1 + 1e-9);
    }
    EXPECT_GT(walls, 10U);
}

TEST(Continuous, RefusesTooManyPlanes) {
    const Reading reading = read(plain({tetrahedron(1)}));
    Parameters parameters = of_size(reading->example(), {500, 500, 500});
    const auto faults = find_faults(*reading, parameters);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults.front().pointer, "/size");
    EXPECT_TRUE(faults.front().over_limit);
    const auto problem = Arrangement::make(
        reading->topes(),
        std::vector<PlaneOffsets>(4, {0.5, 1.5, 2.5, 3.5}),
        {{{0, 0, 0}, {4, 4, 4}}, {4, 4, 4}, 1},
        10
    );
    ASSERT_FALSE(problem);
    EXPECT_EQ(problem.error().code, ErrorCode::kTooLarge);
}

TEST(Continuous, StopsWhenItIsAskedTo) {
    const Reading reading = read(plain({box(1, {0, 0, 0}, {1, 1, 1})}));
    const Parameters parameters = of_size(reading->example(), {9, 9, 9});
    const Problem problem = make_problem(reading, parameters).value();
    std::stop_source stop;
    stop.request_stop();
    Silent silent;
    const auto made = synthesise(problem, parameters, 1, silent, stop.get_token());
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::kCancelled);
}

TEST(Figures, AreNotMoreThanAllowed) {
    const Reading reading = read(plain({tetrahedron(1)}));
    std::vector<Figure> all;
    for (std::size_t label = 0; label < reading->figures().count(); ++label) {
        all.push_back(reading->figures().at(static_cast<Label>(label)));
    }
    EXPECT_TRUE(Figures::make(reading->topes(), all, 16));
    const auto fewer = Figures::make(reading->topes(), all, 15);
    ASSERT_FALSE(fewer);
    EXPECT_EQ(fewer.error().code, ErrorCode::kTooLarge);
}

TEST(Reading, RefusesWhatItCannotBeginWithOrIsTooMuch) {
    Example covered = plain({box(2, {-5, 0, -5}, {5, 1, 5}), tetrahedron(3)}, ObjectId{1});
    covered.bounds = Bounds{{-2, -2, -2}, {2, 2, 2}};
    const auto no_ground = ExampleReading::make(std::move(covered));
    ASSERT_FALSE(no_ground);
    EXPECT_EQ(no_ground.error().code, ErrorCode::kInvalidArgument);

    Outline round;
    for (int i = 0; i < 80; ++i) {
        const double angle = 2 * 3.14159265358979323846 * i / 80;
        round.push_back({std::cos(angle), std::sin(angle)});
    }
    const auto many = ExampleReading::make(plain({examples::prism_upwards(1, round, 0, 1)}));
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().code, ErrorCode::kTooLarge);
}

TEST(Arrangement, RefusesPlanesThatNearlyMeet) {
    const Reading reading = read(plain({tetrahedron(1)}));
    const Topes& topes = reading->topes();
    const auto meets = [&](double miss) {
        const Point middle(2, 2, 2);
        std::vector<PlaneOffsets> planes;
        for (const Point& normal : topes.normals()) {
            planes.push_back({normal.dot(middle)});
        }
        planes.back().front() += miss;
        return Arrangement::make(topes, planes, {{{0, 0, 0}, {4, 4, 4}}, {4, 4, 4}, 1}, 100);
    };
    ASSERT_TRUE(meets(0));
    EXPECT_EQ(meets(0)->vertex_count(), 1U);
    ASSERT_TRUE(meets(1e-3));
    EXPECT_EQ(meets(1e-3)->vertex_count(), 4U);
    const auto unclear = meets(1e-8);
    ASSERT_FALSE(unclear);
    EXPECT_EQ(unclear.error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace modelsynth::continuous
