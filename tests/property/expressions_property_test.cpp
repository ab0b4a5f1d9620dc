// Printed expressions of figures, read back and evaluated in every tope.

#include "solver/continuous/display/expressions.h"
#include "solver/continuous/reading/reading.h"
#include "solver/examples/all.h"
#include "tests/support/formula.h"
#include "tests/support/random_solids.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace modelsynth::continuous {
namespace {

using testing::Formula;

// The object stands where the text says, and nowhere else.
void expect_exact(
    const Topes& topes, const Figure& figure, ObjectId object, const std::string& text
) {
    Formula formula(text);
    for (std::size_t tope = 0; tope < topes.count(); ++tope) {
        const Point& inside = topes.inside(static_cast<Tope>(tope));
        const bool holds = formula.evaluate([&](std::size_t number) {
            return topes.normals()[number - 1].dot(inside) < 0;
        });
        EXPECT_EQ(holds, static_cast<ObjectId>(figure[tope]) == object) << text;
    }
}

void expect_exact(const ExampleReading& reading) {
    ExpressionWriter writer(reading.topes());
    for (std::size_t label = 0; label < reading.figures().count(); ++label) {
        const Figure& figure = reading.figures().at(static_cast<Label>(label));
        for (const ObjectId object : objects_in(figure)) {
            const auto text = writer.write(figure, object);
            ASSERT_TRUE(text);
            expect_exact(reading.topes(), figure, object, *text);
        }
    }
}

TEST(ExpressionsProperty, OfBuiltInExamplesAreExact) {
    std::size_t solids = 0;
    for (const auto& example : examples::all()) {
        if (const auto* reading = std::get_if<std::shared_ptr<const ExampleReading>>(&example)) {
            SCOPED_TRACE((*reading)->example().name);
            expect_exact(**reading);
            ++solids;
        }
    }
    EXPECT_GT(solids, 10U);
}

TEST(ExpressionsProperty, OfRandomSolidsAreExact) {
    std::size_t read = 0;
    for (int kind = 0; kind < testing::kSolidsKindCount; ++kind) {
        for (std::uint32_t seed = 0; seed < 40; ++seed) {
            SCOPED_TRACE("kind " + std::to_string(kind) + ", seed " + std::to_string(seed));
            const auto reading = ExampleReading::make(
                testing::make_random_solids(static_cast<testing::SolidsKind>(kind), seed)
            );
            if (reading) {
                expect_exact(**reading);
                ++read;
            }
        }
    }
    EXPECT_GT(read, 60U);
}

// Planes with small integers for normals, several of which often meet in one line.
std::vector<Point> random_normals(std::mt19937& random, std::size_t count) {
    std::vector<Point> normals;
    for (std::size_t i = 0; i < count; ++i) {
        const auto part = [&random] { return static_cast<double>(random() % 7) - 3; };
        const double x = part();
        const double y = part();
        const Point normal(x, y, part());
        const bool is_new =
            normal.norm() > 0 &&
            std::none_of(normals.begin(), normals.end(), [&normal](const Point& other) {
                return other.cross(normal).norm() < 1e-9;
            });
        if (is_new) {
            normals.push_back(normal.normalized());
        }
    }
    return normals;
}

// Any objects in the topes of any planes: what no solid looks like, so that the whole search is
// met, and the greedy choice. What is too long is left out then.
TEST(ExpressionsProperty, OfRandomFiguresAreExact) {
    std::size_t exact = 0;
    std::size_t greedy = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const auto topes = Topes::make(random_normals(random, 3 + seed % 12));
        if (!topes) {
            continue;
        }
        const std::size_t share = 1 + random() % 8;
        Figure figure;
        for (std::size_t tope = 0; tope < topes->count(); ++tope) {
            figure.push_back(random() % 9 < share ? static_cast<char>(1 + random() % 2) : '\0');
        }
        ExpressionWriter writer(*topes);
        for (const ObjectId object : objects_in(figure)) {
            const auto text = writer.write(figure, object);
            if (text) {
                expect_exact(*topes, figure, object, *text);
                ++(topes->family_count() > kPrimesVariablesMax ? greedy : exact);
            }
        }
    }
    EXPECT_GT(exact, 100U);
    EXPECT_GT(greedy, 50U);
}

}  // namespace
}  // namespace modelsynth::continuous
