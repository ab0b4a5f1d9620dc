// Boolean expressions of figures: short ones where that is known, exact ones elsewhere.

#include "solver/continuous/display/expressions.h"

#include "solver/continuous/reading/reading.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/formula.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using testing::Formula;

Topes topes_of(std::vector<Point> normals) {
    for (Point& normal : normals) {
        normal.normalize();
    }
    return Topes::make(std::move(normals)).value();
}

Topes three_axes() { return topes_of({{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}); }

// The figure with object 1 where a predicate on the half-spaces holds.
using Inside = std::function<bool(const std::array<bool, 33>&)>;

Figure figure_where(const Topes& topes, const Inside& is_inside) {
    Figure figure;
    for (std::size_t tope = 0; tope < topes.count(); ++tope) {
        std::array<bool, 33> h = {};
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            h[family + 1] = topes.normals()[family].dot(topes.inside(static_cast<Tope>(tope))) < 0;
        }
        figure.push_back(is_inside(h) ? 1 : 0);
    }
    return figure;
}

std::string written(const Topes& topes, const Inside& is_inside) {
    return ExpressionWriter(topes).write(figure_where(topes, is_inside), 1).value();
}

TEST(Expressions, OfFacesEdgesAndCornersAreTheThesiss) {
    const Topes topes = three_axes();
    using H = const std::array<bool, 33>&;
    EXPECT_EQ(written(topes, [](H) { return true; }), "1");
    EXPECT_EQ(written(topes, [](H h) { return h[1]; }), "h1");
    EXPECT_EQ(written(topes, [](H h) { return !h[3]; }), "¬h3");
    EXPECT_EQ(written(topes, [](H h) { return h[1] && h[2]; }), "h1 ∧ h2");
    EXPECT_EQ(written(topes, [](H h) { return h[1] || !h[2]; }), "h1 ∨ ¬h2");
    EXPECT_EQ(written(topes, [](H h) { return h[1] && h[2] && h[3]; }), "h1 ∧ h2 ∧ h3");
    // The wall on a floor that ends; the hole in a corner; the saddle (Fig. 4.21).
    EXPECT_EQ(written(topes, [](H h) { return h[1] || (h[2] && h[3]); }), "h1 ∨ (h2 ∧ h3)");
    EXPECT_EQ(written(topes, [](H h) { return h[1] || h[2] || h[3]; }), "h1 ∨ h2 ∨ h3");
    EXPECT_EQ(written(topes, [](H h) { return h[1] && (h[2] || !h[3]); }), "h1 ∧ (h2 ∨ ¬h3)");
    // Two solids that touch in an edge.
    EXPECT_EQ(written(topes, [](H h) { return h[1] == h[3]; }), "(h1 ∧ h3) ∨ (¬h1 ∧ ¬h3)");
}

// Below planes in general position, of which cells are missing that would ask for more.
TEST(Expressions, OfTheThesissComplexVertexIsAsLongAsThere) {
    const Topes topes = topes_of({{1, 2, 3}, {3, 1, 0}, {0, 1, 5}, {1, -1, 1}, {2, 0, -1}});
    ASSERT_EQ(topes.count(), 22U);
    const std::string text = written(topes, [](const std::array<bool, 33>& h) {
        return (h[3] && (h[1] || h[2])) || (h[4] && (h[1] || h[5]));
    });
    EXPECT_LE(Formula(text).literal_count(), 6U) << text;
}

TEST(Expressions, OfATetrahedronAreConjunctions) {
    Example example;
    example.name = "tetrahedron";
    example.materials = {{"a", {}}};
    example.objects = {{"a", 0}};
    Polyhedron solid;
    solid.corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    solid.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    example.polyhedra = {solid};
    const auto reading = ExampleReading::make(std::move(example)).value();
    // The upright and the horizontal faces look against their families' normals, the slope with it.
    ASSERT_GT(reading->topes().normals()[3].minCoeff(), 0.5);
    ExpressionWriter writer(reading->topes());
    std::multiset<std::string> found;
    for (std::size_t label = 0; label < reading->figures().count(); ++label) {
        const Figure& figure = reading->figures().at(static_cast<Label>(label));
        found.insert(objects_in(figure).empty() ? "0" : writer.write(figure, 1).value());
    }
    EXPECT_EQ(
        found,
        (std::multiset<std::string>{
            "0",
            "1",
            "¬h1",
            "¬h2",
            "¬h3",
            "h4",
            "¬h1 ∧ ¬h2",
            "¬h1 ∧ ¬h3",
            "¬h1 ∧ h4",
            "¬h2 ∧ ¬h3",
            "¬h2 ∧ h4",
            "¬h3 ∧ h4",
            "¬h1 ∧ ¬h2 ∧ ¬h3",
            "¬h1 ∧ ¬h2 ∧ h4",
            "¬h1 ∧ ¬h3 ∧ h4",
            "¬h2 ∧ ¬h3 ∧ h4"})
    );
}

TEST(Expressions, TellObjectsOfOneFigureApart) {
    const Topes topes = three_axes();
    // A wall on the ground beside empty space.
    Figure figure = figure_where(topes, [](const auto& h) { return h[1]; });
    for (std::size_t tope = 0; tope < topes.count(); ++tope) {
        if (figure[tope] == 0 && (topes.sides(static_cast<Tope>(tope)) >> 1 & 1) == 0) {
            figure[tope] = 7;
        }
    }
    EXPECT_EQ(objects_in(figure), (std::vector<ObjectId>{1, 7}));
    ExpressionWriter writer(topes);
    EXPECT_EQ(writer.write(figure, 1), "h1");
    EXPECT_EQ(writer.write(figure, 7), "¬h1 ∧ h2");
}

// Shortest formulas of three variables: combined from shorter ones, by their truth tables.
std::array<std::size_t, 256> shortest_lengths() {
    std::array<std::size_t, 256> length;
    length.fill(99);
    length[0] = length[255] = 0;
    for (const std::size_t table : {0xAAU, 0xCCU, 0xF0U}) {
        length[table] = length[255 - table] = 1;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t a = 0; a < 256; ++a) {
            for (std::size_t b = 0; b < 256; ++b) {
                for (const std::size_t table : {a & b, a | b}) {
                    if (length[a] + length[b] < length[table]) {
                        length[table] = length[a] + length[b];
                        changed = true;
                    }
                }
            }
        }
    }
    return length;
}

TEST(Expressions, OfThreeHalfSpacesAreShortest) {
    const Topes topes = three_axes();
    const auto lengths = shortest_lengths();
    ExpressionWriter writer(topes);
    for (std::size_t table = 1; table < 256; ++table) {
        const Figure figure = figure_where(topes, [table](const auto& h) {
            return (table >> ((h[1] ? 1 : 0) + (h[2] ? 2 : 0) + (h[3] ? 4 : 0)) & 1) != 0;
        });
        const std::string text = writer.write(figure, 1).value();
        EXPECT_EQ(Formula(text).literal_count(), lengths[table]) << text;
    }
}

TEST(Expressions, OfManyHalfSpacesAreWrittenGreedily) {
    // A cone of twenty sides and its complement.
    std::vector<Point> normals;
    for (int i = 0; i < 20; ++i) {
        const double angle = i * 0.314159;
        normals.emplace_back(std::cos(angle), 0.7, std::sin(angle));
    }
    const Topes topes = topes_of(normals);
    const auto all = [](const auto& h) {
        bool inside = true;
        for (std::size_t i = 1; i <= 20; ++i) {
            inside = inside && h[i];
        }
        return inside;
    };
    EXPECT_EQ(Formula(written(topes, all)).literal_count(), 20U);
    EXPECT_EQ(Formula(written(topes, [&](const auto& h) { return !all(h); })).literal_count(), 20U);
}

TEST(Expressions, AreLeftOutRatherThanWrongWhenTheStepsAreUsedUp) {
    const PartialFunction function = {3, {0b111, 0b001}, {0b000, 0b110}};
    std::size_t enough = 100000;
    EXPECT_TRUE(find_short_expression(function, enough));
    EXPECT_LT(enough, 100000U);
    std::size_t too_few = 5;
    EXPECT_FALSE(find_short_expression(function, too_few));
    EXPECT_EQ(too_few, 0U);
}

}  // namespace
}  // namespace modelsynth::continuous
