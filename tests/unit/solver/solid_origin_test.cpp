// Solids that start from a model made before, looked at in the polygons of what is made.

#include "solver/continuous/faults.h"
#include "solver/continuous/origin.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "tests/support/examples.h"
#include "tests/support/solid_places.h"
#include "tests/support/surface_checker.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::find_solids;
using testing::RecordingObserver;
using testing::SolidPlaces;
using testing::SurfaceChecker;

using Reading = std::shared_ptr<const ExampleReading>;
using Size = std::array<double, 3>;

Parameters asking(
    const Reading& reading,
    const Size& size,
    std::optional<std::vector<Constraint>> constraints = std::nullopt
) {
    Parameters parameters;
    parameters.size = size;
    parameters.constraints = std::move(constraints);
    return fill_defaults(parameters, reading->example());
}

struct Made {
    std::vector<Label> labels;
    SynthesisStats stats;
    SolidPlaces places;
    std::vector<std::string> inconsistent;
};

Result<Made> try_to_make(
    const Reading& reading,
    const Parameters& parameters,
    std::uint64_t seed,
    const Origin* origin = nullptr
) {
    auto problem = make_problem(reading, parameters, origin);
    if (!problem) {
        return tl::unexpected(std::move(problem.error()));
    }
    RecordingObserver observer;
    auto made = synthesise(*problem, parameters, seed, observer, {});
    if (!made) {
        return tl::unexpected(std::move(made.error()));
    }
    const Surface surface = make_surface(*problem, made->labels);
    const Bounds& box = problem->arrangement.frame().box;
    SolidPlaces places(surface, reading->example().objects.size(), {box.min, box.max});
    std::vector<std::string> faults =
        SurfaceChecker(reading->example()).find_faults(surface, places.set().frame().clip);
    return Made{std::move(made->labels), made->stats, std::move(places), std::move(faults)};
}

Made make(
    const Reading& reading,
    const Parameters& parameters,
    std::uint64_t seed,
    const Origin* origin = nullptr
) {
    Made made = try_to_make(reading, parameters, seed, origin).value();
    EXPECT_EQ(made.inconsistent, std::vector<std::string>());
    return made;
}

bool holds(const MetreBox& box, const Point& place) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = place[static_cast<Eigen::Index>(axis)];
        if (along < box.min[axis] || along > box.max[axis]) {
            return false;
        }
    }
    return true;
}

// How many of random places of the newer model that `is_asked` for hold something else than the
// older one at the same place of its own, and how many there are.
struct Compared {
    std::size_t places = 0;
    std::size_t different = 0;
};

template <class IsAsked>
Compared compare(const Made& older, const Made& newer, const Size& at, IsAsked is_asked) {
    const Eigen::AlignedBox3d& box = older.places.set().frame().clip;
    std::mt19937_64 random(5);
    const auto share = [&] { return static_cast<double>(random() % 1'000'003) / 1'000'003; };
    Compared compared;
    for (int i = 0; i < 6000; ++i) {
        const Point there = box.min() + Point(share(), share(), share()).cwiseProduct(box.sizes());
        const Point place = there + Point(at[0], at[1], at[2]);
        if (is_asked(place)) {
            ++compared.places;
            compared.different += older.places.at(there) == newer.places.at(place) ? 0U : 1U;
        }
    }
    return compared;
}

bool everywhere(const Point& /*place*/) { return true; }

TEST(SolidOrigin, MakesABoxAnewAndLeavesTheRest) {
    // Islands want room.
    const std::vector<std::pair<const char*, double>> examples = {
        {"houses", 16}, {"skyscrapers", 16}, {"terrain", 32}, {"arches", 16}, {"pentagons", 22}};
    for (const auto& [name, extent] : examples) {
        SCOPED_TRACE(name);
        const MetreBox box = {{4, 0, 3}, {extent - 2, 9, extent - 4}};
        const Reading reading = find_solids(name);
        const Parameters parameters = asking(reading, {extent, 9, extent});
        const Made before = make(reading, parameters, 1);
        Origin origin = {*parameters.size, before.labels, {}, {box}};
        const Made after = make(reading, parameters, 2, &origin);
        const auto outside = [&](const Point& place) { return !holds(box, place); };
        const auto inside = [&](const Point& place) { return holds(box, place); };
        EXPECT_EQ(compare(before, after, {}, outside).different, 0U);
        EXPECT_GT(compare(before, after, {}, inside).different, 20U);
        EXPECT_GT(after.stats.changed, 0);
        EXPECT_EQ(make(reading, parameters, 2, &origin).labels, after.labels);
    }
}

TEST(SolidOrigin, MakesWhatLiesBelowThePlaceAnewWithIt) {
    // Roads are sunk into the ground.
    const Reading reading = find_solids("roads");
    const Parameters parameters = asking(reading, {48, 3, 48}, std::vector<Constraint>());
    const Made before = make(reading, parameters, 1);
    const MetreBox box = {{6, 0, 6}, {42, 3, 42}};
    const Origin origin = {*parameters.size, before.labels, {}, {box}};
    const Made after = make(reading, parameters, 2, &origin);
    const auto in_the_middle = [](const Point& place) {
        return place.x() > 6 && place.x() < 42 && place.z() > 6 && place.z() < 42;
    };
    const auto outside = [&](const Point& place) { return !in_the_middle(place); };
    EXPECT_EQ(compare(before, after, {}, outside).different, 0U);
    EXPECT_GT(compare(before, after, {}, in_the_middle).different, 20U);
}

TEST(SolidOrigin, MakesAllAnewWhenNoPlaceIsNamed) {
    const Reading reading = find_solids("houses");
    const Parameters parameters = asking(reading, {18, 9, 16});
    const Made before = make(reading, parameters, 1);
    const Origin origin = {*parameters.size, before.labels, {}, {}};
    const Compared compared =
        compare(before, make(reading, parameters, 2, &origin), {}, everywhere);
    EXPECT_GT(compared.different, compared.places / 20);
}

TEST(SolidOrigin, GrowsBeyondTheOlderModel) {
    for (const char* name : {"houses", "skyscrapers", "fractals", "spaceships"}) {
        SCOPED_TRACE(name);
        const Reading reading = find_solids(name);
        const bool is_in_space = !reading->example().ground;
        const Parameters small = asking(reading, {12, 8, 10}, std::vector<Constraint>());
        const double spacing = *small.spacing;
        const Size at = {4 * spacing, is_in_space ? 2 * spacing : 0, 3 * spacing};
        const Parameters large = asking(
            reading,
            {12 + 8 * spacing, 8 + 4 * spacing, 10 + 9 * spacing},
            std::vector<Constraint>()
        );
        const Made before = make(reading, small, 1);
        Origin origin = {*small.size, before.labels, at, {}};
        if (!find_origin_faults(*reading, large, origin).empty()) {
            // Slanted planes of which the older model's lie between.
            EXPECT_EQ(reading->example().name, "fractals");
            continue;
        }
        EXPECT_TRUE(has_planes_of(*reading, large, origin, small));
        const Made after = make(reading, large, 2, &origin);
        EXPECT_EQ(compare(before, after, at, everywhere).different, 0U);
        EXPECT_GT(after.stats.changed, 0.01);
        // A part of the older one, too.
        origin.remade.box = MetreBox{{0, 0, 0}, {at[0] + 5, 8, 10}};
        const Made mended = make(reading, large, 2, &origin);
        const auto outside = [&](const Point& place) { return !holds(*origin.remade.box, place); };
        EXPECT_EQ(compare(before, mended, at, outside).different, 0U);
        EXPECT_GT(compare(before, mended, at, everywhere).different, 0U);
    }
}

TEST(SolidOrigin, GoesWithListedPlanesInTheirPlace) {
    const Reading reading = find_solids("houses");
    Parameters small = asking(reading, {10, 8, 10});
    small.offsets = {{{1, 0, 0}, {1, 2, 3.5, 5, 6, 7, 8.5, 9}}};
    Parameters large = asking(reading, {14, 8, 10});
    large.offsets = {{{-2, 0, 0}, {-1, -3, -4, -5, -6, -7.5, -9, -10, -11, -12.5, -13}}};
    const Made before = make(reading, small, 1);
    const Origin origin = {*small.size, before.labels, {4, 0, 0}, {}};
    ASSERT_TRUE(find_origin_faults(*reading, large, origin).empty());
    EXPECT_TRUE(has_planes_of(*reading, large, origin, small));
    const Made after = make(reading, large, 3, &origin);
    EXPECT_EQ(compare(before, after, {4, 0, 0}, everywhere).different, 0U);
    large.offsets.front().offsets.push_back(-6.5);
    EXPECT_FALSE(has_planes_of(*reading, large, origin, small));
}

TEST(SolidOrigin, IsAskedForWhatIsAskedOfTheWholeModel) {
    const Reading reading = find_solids("houses");
    const Parameters parameters = asking(reading, {18, 9, 16});
    const Made before = make(reading, parameters, 1);
    Origin origin = {*parameters.size, before.labels, {}, {MetreBox{{0, 0, 0}, {9, 9, 16}}}};
    const Constraint nothing_there = {
        ForbiddenRule{}, {"plinth", "corner a", "corner b"}, {MetreBox{{0, 0, 0}, {4, 9, 16}}}};
    const Made emptied = make(reading, asking(reading, {18, 9, 16}, {{nothing_there}}), 2, &origin);
    const auto east = [](const Point& place) { return place.x() > 9; };
    EXPECT_EQ(compare(before, emptied, {}, east).different, 0U);
    const Constraint nothing = {ForbiddenRule{}, {"plinth", "corner a", "corner b"}};
    const auto refused =
        try_to_make(reading, asking(reading, {18, 9, 16}, {{nothing}}), 2, &origin);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kContradiction);
    // Nor is what stands in the east the image of anything yet.
    for (const SymmetryRule& rule :
         {SymmetryRule{SymmetryRule::Kind::kReflectX},
          SymmetryRule{SymmetryRule::Kind::kTranslate, {3, 0, 0}}}) {
        const auto unlike =
            try_to_make(reading, asking(reading, {18, 9, 16}, {{Constraint{rule}}}), 2, &origin);
        ASSERT_FALSE(unlike);
        EXPECT_EQ(unlike.error().code, ErrorCode::kContradiction);
    }
}

TEST(SolidOrigin, StaysSymmetricWhereBothSidesAreMadeAnew) {
    const Reading reading = find_solids("skyscrapers");
    const Parameters parameters =
        asking(reading, {18, 12, 16}, {{Constraint{SymmetryRule{SymmetryRule::Kind::kReflectX}}}});
    const Made before = make(reading, parameters, 1);
    const MetreBox strip = {{0, 0, 5}, {18, 12, 12}};
    const Origin origin = {*parameters.size, before.labels, {}, {strip}};
    const Made after = make(reading, parameters, 2, &origin);
    const auto outside = [&](const Point& place) { return !holds(strip, place); };
    EXPECT_EQ(compare(before, after, {}, outside).different, 0U);
    EXPECT_GT(compare(before, after, {}, everywhere).different, 20U);
}

TEST(SolidOrigin, TellsWhatCannotBe) {
    const Reading reading = find_solids("houses");
    const auto pointer = [&](const Size& size, const Origin& origin) -> std::string {
        const auto faults = find_origin_faults(*reading, asking(reading, size), origin);
        return faults.empty() ? "" : faults.front().pointer;
    };
    const Size small = {10, 8, 10};
    EXPECT_EQ(pointer({10, 8, 10}, {small}), "");
    EXPECT_EQ(pointer({9, 8, 10}, {small}), "/parameters/size");
    EXPECT_EQ(pointer({12, 8, 10}, {small, {}, {2, 0, 0}}), "");
    EXPECT_EQ(pointer({12, 8, 10}, {small, {}, {3, 0, 0}}), "/from/at");
    EXPECT_EQ(pointer({12, 8, 10}, {small, {}, {1.5, 0, 0}}), "/from/at");
    EXPECT_EQ(pointer({12, 9, 10}, {small, {}, {1, 1, 0}}), "/from/at");
    const Parameters parameters = asking(reading, small);
    const Made made = make(reading, parameters, 1);
    Origin damaged = {small, made.labels, {}, {}};
    damaged.labels.pop_back();
    EXPECT_EQ(make_problem(reading, parameters, &damaged).error().code, ErrorCode::kInternal);
    damaged.labels = made.labels;
    damaged.labels.back() = 60'000;
    EXPECT_EQ(make_problem(reading, parameters, &damaged).error().code, ErrorCode::kInternal);
    damaged.labels = std::vector<Label>(made.labels.rbegin(), made.labels.rend());
    EXPECT_EQ(make_problem(reading, parameters, &damaged).error().code, ErrorCode::kInternal);
}

}  // namespace
}  // namespace modelsynth::continuous
