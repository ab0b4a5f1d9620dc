// Symmetries of solids, looked at in the polygons of what is made.

#include "solver/continuous/faults.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/synthesis.h"
#include "solver/continuous/warnings.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/examples.h"
#include "tests/support/solid_places.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using examples::find_solids;
using testing::RecordingObserver;
using testing::SolidPlaces;

using Kind = SymmetryRule::Kind;
using Reading = std::shared_ptr<const ExampleReading>;
using Size = std::array<double, 3>;

// Boxes of two kinds on grass.
Reading read_boxes() {
    Example example;
    example.name = "boxes";
    example.materials = {{"grass", {}}, {"a", {}}, {"b", {}}};
    example.objects = {{"grass", 0}, {"a", 1}, {"b", 2}};
    example.ground = 1;
    example.polyhedra = {box(2, {0, 0, 0}, {3, 2, 4}), box(3, {0, 0, 6}, {2, 3, 9})};
    example.density = 0.8;
    return ExampleReading::make(std::move(example)).value();
}

Constraint symmetric(
    Kind kind, std::optional<NamePairs> mirror = std::nullopt, const Size& step = {0, 0, 0}
) {
    return {SymmetryRule{kind, step, std::move(mirror)}};
}

Parameters asking(const Reading& reading, const Size& size, std::vector<Constraint> constraints) {
    Parameters parameters;
    parameters.size = size;
    parameters.constraints = std::move(constraints);
    return fill_defaults(parameters, reading->example());
}

// The image of a place, said anew.
Point image_of(const Point& place, const SymmetryRule& rule, const Size& size) {
    const double x = place.x() - size[0] / 2;
    const double z = place.z() - size[2] / 2;
    const auto about_middle = [&](double moved_x, double moved_z) {
        return Point(size[0] / 2 + moved_x, place.y(), size[2] / 2 + moved_z);
    };
    switch (rule.kind) {
        case Kind::kReflectX:
            return about_middle(-x, z);
        case Kind::kReflectZ:
            return about_middle(x, -z);
        case Kind::kHalfTurn:
            return about_middle(-x, -z);
        case Kind::kQuarterTurn:
            return about_middle(z, -x);
        case Kind::kTranslate:
            break;
    }
    return place + Point(rule.translation[0], rule.translation[1], rule.translation[2]);
}

struct Made {
    Problem problem;
    Synthesis synthesis;
    RecordingObserver observer;

    [[nodiscard]] SolidPlaces places() const {
        const Bounds& bounds = problem.arrangement.frame().box;
        return {
            make_surface(problem, synthesis.labels),
            problem.reading->example().objects.size(),
            {bounds.min, bounds.max}};
    }
};

Made make(const Reading& reading, const Parameters& parameters, std::uint64_t seed) {
    RecordingObserver observer;
    Problem problem = make_problem(reading, parameters).value();
    Synthesis made = synthesise(problem, parameters, seed, observer, {}).value();
    return {std::move(problem), std::move(made), std::move(observer)};
}

// That at random places stands the image of what stands at their image, and not nothing everywhere.
void expect_symmetric(const Made& made, const Parameters& parameters, const Constraint& asked) {
    const auto& rule = std::get<SymmetryRule>(asked.rule);
    const ExampleReading& reading = *made.problem.reading;
    std::map<std::string, std::string> images;
    for (const auto& [object, image] : rule.mirror ? *rule.mirror : likely_mirror(reading, rule)) {
        images[object] = image;
        images.emplace(image, object);  // unless it has an image of its own
    }
    const SolidPlaces places = made.places();
    const Size& size = *parameters.size;
    const auto name_at = [&](const Point& place) -> std::string {
        const ObjectId object = places.at(place);
        return object == kEmpty ? "" : reading.example().objects[object - 1U].name;
    };
    const Eigen::AlignedBox3d& clip = places.set().frame().clip;
    std::mt19937_64 random(7);
    const auto share = [&] { return static_cast<double>(random() % 1'000'003) / 1'000'003; };
    std::size_t solid = 0;
    for (int i = 0; i < 3000; ++i) {
        const Point place =
            clip.min() + Point(share(), share(), share()).cwiseProduct(clip.sizes());
        const Point there = image_of(place, rule, size);
        if (!clip.contains(there)) {
            continue;
        }
        const std::string object = name_at(place);
        const auto image = images.find(object);
        ASSERT_EQ(name_at(there), image == images.end() ? object : image->second)
            << "image of " << place.transpose();
        solid += object.empty() ? 0U : 1U;
    }
    EXPECT_GT(solid, 20U);
}

struct Case {
    const char* example;
    Size size;
    std::vector<Constraint> symmetries;
};

TEST(SolidSymmetries, HoldAtEveryPlace) {
    const std::vector<Case> cases = {
        {"skyscrapers", {16, 12, 14}, {symmetric(Kind::kReflectX)}},
        {"skyscrapers", {15, 12, 15}, {symmetric(Kind::kReflectX), symmetric(Kind::kQuarterTurn)}},
        {"houses", {18, 9, 18}, {symmetric(Kind::kQuarterTurn)}},
        {"houses", {18, 9, 14}, {symmetric(Kind::kReflectX), symmetric(Kind::kReflectZ)}},
        {"arches", {16, 8, 13}, {symmetric(Kind::kHalfTurn)}},
        {"terrain", {17, 6, 20}, {symmetric(Kind::kReflectZ)}},
        {"pentagons", {16, 9, 13}, {symmetric(Kind::kReflectX)}},
        {"fractals", {8, 8, 8}, {symmetric(Kind::kReflectX)}},
        {"roads", {20, 3, 20}, {symmetric(Kind::kQuarterTurn)}},
        {"skyscrapers", {20, 12, 10}, {symmetric(Kind::kTranslate, {}, {7, 0, 1})}},
        {"terrain", {20, 6, 12}, {symmetric(Kind::kTranslate, {}, {-9, 0, 0})}}};
    for (const Case& one : cases) {
        SCOPED_TRACE(one.example);
        const Reading reading = find_solids(one.example);
        const Parameters parameters = asking(reading, one.size, one.symmetries);
        ASSERT_TRUE(find_faults(*reading, parameters).empty());
        const Made made = make(reading, parameters, 3);
        EXPECT_GT(made.synthesis.stats.changed, 0.01);
        for (const Constraint& symmetry : one.symmetries) {
            expect_symmetric(made, parameters, symmetry);
        }
    }
}

TEST(SolidSymmetries, MoveObjectsAsToldAndAPairIsNamedOnce) {
    const Reading reading = read_boxes();
    const std::vector<Constraint> symmetries = {symmetric(Kind::kReflectX, NamePairs{{"a", "b"}})};
    // The planes of one kind's corners are those of the other's.
    const Parameters parameters = asking(reading, {13, 5, 12}, symmetries);
    const Made made = make(reading, parameters, 1);
    expect_symmetric(made, parameters, symmetries.front());
    EXPECT_GT(made.synthesis.stats.changed, 0.05);
}

TEST(SolidSymmetries, HoldAfterEveryBlockWhoseChangesLieInItsRegion) {
    const Reading reading = find_solids("houses");
    const Parameters parameters = asking(reading, {20, 8, 20}, {symmetric(Kind::kQuarterTurn)});
    const Made made = make(reading, parameters, 5);
    const RecordingObserver& seen = made.observer;
    ASSERT_GT(seen.reports.size(), 3U);
    const Arrangement& arrangement = made.problem.arrangement;
    const Symmetries& symmetries = *made.problem.symmetries;
    std::vector<Label> before = seen.initial_model;
    for (std::size_t i = 0; i < seen.reports.size(); ++i) {
        std::vector<std::uint8_t> is_inside(before.size());
        arrangement.for_each_vertex(seen.reports[i].region, [&](Site site) {
            is_inside[site] = 1;
        });
        for (std::size_t site = 0; site < before.size(); ++site) {
            ASSERT_TRUE(before[site] == seen.models[i][site] || is_inside[site] != 0);
        }
        before = seen.models[i];
        for (std::size_t site = 0; site < before.size(); ++site) {
            const std::vector<Site> both = symmetries.close({static_cast<Site>(site)});
            for (const GraphArc& arc : symmetries.arcs(both)) {
                ASSERT_TRUE(symmetries.relations().allows(
                    arc.from_a, before[both[arc.a]], before[both[arc.b]]
                ));
            }
        }
    }
}

TEST(SolidSymmetries, MakeOnlyWhatIsNoImageOfOtherBlocks) {
    const Reading reading = find_solids("terrain");
    const auto blocks_of = [&](std::vector<Constraint> constraints) {
        return make(reading, asking(reading, {40, 6, 40}, std::move(constraints)), 1)
            .observer.reports.size();
    };
    const std::size_t all = blocks_of({});
    const std::size_t halves = blocks_of({symmetric(Kind::kReflectX)});
    const std::size_t quarters = blocks_of({symmetric(Kind::kQuarterTurn)});
    EXPECT_EQ(blocks_of({symmetric(Kind::kTranslate, {}, {20, 0, 0})}), all);
    EXPECT_LT(halves, all * 3 / 4);
    EXPECT_LT(quarters, halves * 3 / 4);
    EXPECT_EQ(blocks_of({symmetric(Kind::kReflectX), symmetric(Kind::kReflectZ)}), quarters);
}

TEST(LikelyMirror, ExchangesCornersOfOneSideForThoseOfTheOther) {
    const auto of = [](const char* example, Kind kind) {
        return likely_mirror(*find_solids(example), SymmetryRule{kind});
    };
    const NamePairs skyscrapers = {
        {"pier a", "pier b"}, {"pier b", "pier a"}, {"foot a", "foot b"}, {"foot b", "foot a"}};
    EXPECT_EQ(of("skyscrapers", Kind::kReflectX), skyscrapers);
    EXPECT_EQ(of("skyscrapers", Kind::kHalfTurn), NamePairs());
    EXPECT_EQ(of("terrain", Kind::kQuarterTurn), NamePairs());
    EXPECT_EQ(
        likely_mirror(*find_solids("skyscrapers"), SymmetryRule{Kind::kTranslate, {1, 0, 0}}),
        NamePairs()
    );
    // What stands in the east comes to stand in the north: bends go round in rings of four.
    const NamePairs turned = of("roller_coaster", Kind::kQuarterTurn);
    std::map<std::string, std::string> image(turned.begin(), turned.end());
    std::string bend = "bend 1";
    std::vector<std::string> ring;
    for (int i = 0; i < 4; ++i) {
        bend = image[bend];
        ring.push_back(bend);
    }
    EXPECT_EQ(ring.back(), "bend 1");
    EXPECT_NE(ring[1], "bend 1");
}

TEST(LikelyMirror, IsNoFaultOfAnyBuiltInExample) {
    for (const Reading& reading : examples::built_in_solids()) {
        for (const Kind kind :
             {Kind::kReflectX, Kind::kReflectZ, Kind::kHalfTurn, Kind::kQuarterTurn}) {
            Parameters parameters = asking(reading, {12, 9, 12}, {symmetric(kind)});
            fill_mirrors(*reading, parameters);
            const auto& mirror =
                std::get<SymmetryRule>(parameters.constraints->front().rule).mirror;
            const std::vector<Fault> faults = find_faults(*reading, parameters);
            for (const Fault& fault : faults) {
                EXPECT_FALSE(fault.pointer.starts_with("/constraints/0/mirror")) << fault.detail;
            }
            EXPECT_TRUE(mirror || !faults.empty()) << reading->example().name;
        }
    }
}

TEST(SolidSymmetries, TellWhatIsLeftOutForWantOfAnImage) {
    const Reading reading = find_solids("skyscrapers");
    const auto warnings = [&](std::optional<NamePairs> mirror) {
        const Parameters parameters =
            asking(reading, {10, 8, 10}, {symmetric(Kind::kReflectX, std::move(mirror))});
        return warnings_of(make_problem(reading, parameters).value());
    };
    const std::vector<std::string> found = warnings(std::nullopt);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(
        found.front(), "22 of 543 figures are left out: the example does not have their images"
    );
    // Corners that are to be their own images have none.
    ASSERT_EQ(warnings(NamePairs()).size(), 1U);
    EXPECT_EQ(warnings(NamePairs()).front().substr(0, 11), "178 of 543 ");
    EXPECT_TRUE(warnings_of(make_problem(reading, asking(reading, {10, 8, 10}, {})).value()).empty()
    );
}

TEST(SolidSymmetries, RefuseWhatCannotBe) {
    struct Refused {
        const char* example;
        Size size;
        Constraint constraint;
        const char* pointer;
    };

    const std::vector<Refused> cases = {
        {"houses", {12, 8, 14}, symmetric(Kind::kQuarterTurn), "/constraints/0/rotate"},
        {"pentagons", {12, 8, 12}, symmetric(Kind::kQuarterTurn), "/constraints/0/rotate"},
        {"fractals", {8, 8, 8}, symmetric(Kind::kReflectZ), "/constraints/0/reflect"},
        {"houses", {12, 8, 12}, symmetric(Kind::kTranslate), "/constraints/0/translate"},
        {"houses",
         {12, 8, 12},
         symmetric(Kind::kTranslate, {}, {1.5, 0, 0}),
         "/constraints/0/translate"},
        {"houses",
         {12, 8, 12},
         symmetric(Kind::kReflectX, NamePairs{{"wall", "roof"}}),
         "/constraints/0/mirror/wall"},
        {"houses",
         {12, 8, 12},
         symmetric(Kind::kReflectX, NamePairs{{"roof", "sill"}, {"door", "sill"}}),
         "/constraints/0/mirror"},
        {"houses",
         {12, 8, 12},
         symmetric(
             Kind::kHalfTurn, NamePairs{{"roof", "sill"}, {"sill", "door"}, {"door", "roof"}}
         ),
         "/constraints/0/mirror"},
        {"houses",
         {12, 8, 12},
         symmetric(Kind::kReflectX, NamePairs{{"grass", "roof"}}),
         "/constraints/0/mirror"},
        {"houses",
         {12, 8, 12},
         symmetric(Kind::kReflectX, NamePairs{{"roof", "empty"}}),
         "/constraints/0/mirror"},
        {"houses",
         {12, 8, 12},
         symmetric(Kind::kTranslate, {}, {0, 2, 0}),
         "/constraints/0/translate"}};
    for (const Refused& one : cases) {
        const Reading reading = find_solids(one.example);
        const auto faults = find_faults(*reading, asking(reading, one.size, {one.constraint}));
        ASSERT_EQ(faults.size(), 1U) << one.example << one.pointer;
        EXPECT_EQ(faults.front().pointer, one.pointer);
    }
    const Reading reading = find_solids("houses");
    const auto faultless =
        asking(reading, {12, 8, 12}, {symmetric(Kind::kTranslate, {}, {2, 0, 0})});
    EXPECT_TRUE(find_faults(*reading, faultless).empty());
}

}  // namespace
}  // namespace modelsynth::continuous
