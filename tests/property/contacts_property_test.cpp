// Where polygons border empty space, against rays through the model.

#include "solver/continuous/decoration/contacts.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "tests/support/case_count.h"
#include "tests/support/examples.h"
#include "tests/support/random_solids.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace modelsynth::continuous {
namespace {

using testing::RecordingObserver;
using testing::solid_case_count;
using testing::SolidsKind;

// How often a ray from a place goes through a polygon.
std::size_t crossings(
    const Surface& surface, const SurfacePolygon& polygon, const Point& normal, const Point& place
) {
    const Point ray(0.5377, 0.6311, 0.5592);
    const double slope = ray.dot(normal);
    const double reach = (surface.points[polygon.loops[0][0]] - place).dot(normal) / slope;
    if (std::abs(slope) < 1e-12 || reach < 0) {
        return 0;
    }
    const Point hit = place + reach * ray;
    const Point right = normal.unitOrthogonal();
    const Point up = normal.cross(right);
    std::size_t sides = 0;
    for (const std::vector<std::uint32_t>& loop : polygon.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point a = surface.points[loop[i]] - hit;
            const Point b = surface.points[loop[(i + 1) % loop.size()]] - hit;
            if ((a.dot(up) > 0) != (b.dot(up) > 0)) {
                const double share = a.dot(up) / (a.dot(up) - b.dot(up));
                sides += a.dot(right) + share * (b - a).dot(right) > 0 ? 1U : 0U;
            }
        }
    }
    return sides % 2;
}

bool is_empty(const Surface& surface, const std::vector<Point>& normals, const Point& place) {
    std::vector<std::size_t> count(kObjectTypesMax + 1);
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        const SurfacePolygon& polygon = surface.polygons[p];
        count[polygon.object] += crossings(surface, polygon, normals[p], place);
    }
    return std::none_of(count.begin(), count.end(), [](std::size_t n) { return n % 2 != 0; });
}

struct Tally {
    std::size_t free = 0;
    std::size_t covered = 0;
    std::size_t in_part = 0;  // sides of which a part is covered
};

void expect_true(const Surface& surface, ObjectId object, Tally& tally) {
    const std::vector<Point> normals = normals_of(surface);
    const Contacts contacts(surface, normals);
    for (const Side& side : sides_of(surface, normals, object)) {
        const std::vector<SidePart> parts = contacts.free_parts(side);
        const Point& from = surface.points[side.from];
        const Point along = surface.points[side.to] - from;
        const double length = along.norm();
        const bool is_in_part =
            !parts.empty() && (parts.front().begin > 0 || parts.front().end < length);
        tally.in_part += is_in_part ? 1U : 0U;
        for (const double share : {0.0173, 0.2618, 0.4877, 0.7391, 0.9789}) {
            const double at = share * length;
            bool is_near_end = false;
            bool is_free = false;
            for (const SidePart& part : parts) {
                is_free = is_free || (part.begin < at && at < part.end);
                is_near_end = is_near_end || std::abs(part.begin - at) < 1e-3 * length ||
                              std::abs(part.end - at) < 1e-3 * length;
            }
            if (is_near_end) {
                continue;
            }
            const Point place = from + share * along + 1e-5 * side.inwards + 1e-7 * side.outwards;
            EXPECT_EQ(is_free, is_empty(surface, normals, place))
                << "object " << int{object} << " at " << place.transpose();
            (is_free ? tally.free : tally.covered) += 1;
        }
    }
}

// Of all objects of a model, if there is one.
void expect_true_in_model(
    const std::shared_ptr<const ExampleReading>& reading,
    const std::array<double, 3>& size,
    std::uint64_t seed,
    Tally& tally
) {
    Parameters parameters;
    parameters.size = size;
    parameters = fill_defaults(parameters, reading->example());
    const auto problem = make_problem(reading, parameters);
    if (!problem) {
        return;
    }
    RecordingObserver observer;
    const auto made = synthesise(*problem, parameters, seed, observer, {});
    ASSERT_TRUE(made);
    const Surface surface = make_surface(*problem, made->labels);
    for (std::size_t i = 0; i < reading->example().objects.size(); ++i) {
        expect_true(surface, static_cast<ObjectId>(i + 1), tally);
    }
}

TEST(Contacts, OfRandomSolidsAreWhereRaysSaySo) {
    Tally tally;
    for (const SolidsKind kind :
         {SolidsKind::kBoxes, SolidsKind::kWedges, SolidsKind::kTetrahedra}) {
        for (std::uint32_t seed = 0; seed < solid_case_count(20); ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const auto reading = ExampleReading::make(make_random_solids(kind, seed));
            if (reading && (*reading)->topes().family_count() <= 7) {
                expect_true_in_model(*reading, {9, 6, 9}, seed, tally);
            }
        }
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GT(tally.free, 0U);
        EXPECT_GT(tally.covered, 0U);
    }
}

TEST(Contacts, OfBuiltInModelsAreWhereRaysSaySo) {
    Tally tally;
    for (const char* name : {"houses", "buildings", "skyscrapers"}) {
        SCOPED_TRACE(name);
        for (std::uint64_t seed = 1; seed <= solid_case_count(3); ++seed) {
            expect_true_in_model(examples::find_solids(name), {16, 9, 16}, seed, tally);
        }
    }
    if (testing::are_solid_cases_usual()) {
        EXPECT_GT(tally.free, 1000U);
        EXPECT_GT(tally.covered, 1000U);
        EXPECT_GT(tally.in_part, solid_case_count(10));
    }
}

}  // namespace
}  // namespace modelsynth::continuous
