#include "solver/discrete/analysis/success_curve.h"

#include "solver/discrete/analysis/success_drawing.h"
#include "tests/support/examples.h"
#include "tests/support/well_formed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

namespace modelsynth::discrete {
namespace {

using testing::is_well_formed;
using testing::make_example;

std::vector<SuccessPoint> measure(
    const Example& example, const SuccessOptions& options, Order order = Order::kScan
) {
    Parameters parameters;
    parameters.order.order = order;
    parameters.size = GridSize{40, 1, 40};
    return measure_success(example, fill_defaults(parameters, example), options, {}).value();
}

// Five labels that come to dead ends, the more often the larger the model.
Example fallible() { return testing::make_tiny_example(28, true); }

TEST(SuccessCurve, IsAllForAnInfallibleExampleInEveryOrder) {
    const Example chequers = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    for (const Order order : {Order::kScan, Order::kMinEntropy, Order::kRandom}) {
        for (const SuccessPoint& point : measure(chequers, {{3, 8, 21}, 5, 1}, order)) {
            EXPECT_EQ(point.runs, 5U);
            EXPECT_EQ(point.successes, 5U);
        }
    }
}

TEST(SuccessCurve, IsNothingWhereNothingFits) {
    // No label repeats, so there is no model larger than the example.
    const Example unlike = make_example({2, 1, 2}, {0, 1, 2, 3}, 4);
    EXPECT_EQ(
        measure(unlike, {{2, 5}, 4, 1}),
        (std::vector<SuccessPoint>{{{2, 1, 2}, 4, 4}, {{5, 1, 5}, 4, 0}})
    );
    // A boundary that no piece meets.
    Example walled = make_example({2, 1, 2}, {0, 0, 1, 1}, 2);
    walled.boundary[static_cast<std::size_t>(Direction::kWest)] = {BoundaryKind::kPieces, {"a"}};
    walled.boundary[static_cast<std::size_t>(Direction::kEast)] = {BoundaryKind::kPieces, {"b"}};
    EXPECT_EQ(measure(walled, {{1, 4}, 3, 1})[0].successes, 0U);
    EXPECT_EQ(measure(walled, {{1, 4}, 3, 1})[1].successes, 0U);
}

TEST(SuccessCurve, FallsWithTheSizeOfAFallibleExample) {
    const auto points = measure(fallible(), {{2, 4, 6, 10, 20}, 50, 3});
    ASSERT_EQ(points.size(), 5U);
    EXPECT_EQ(points.front().successes, 50U);
    EXPECT_LT(points.back().successes, 20U);
    for (std::size_t i = 1; i < points.size(); ++i) {
        EXPECT_LT(points[i].successes, points[i - 1].successes);
    }
}

TEST(SuccessCurve, IsAFunctionOfItsSeed) {
    const auto points = measure(fallible(), {{6, 10}, 60, 3});
    EXPECT_EQ(points, measure(fallible(), {{6, 10}, 60, 3}));
    EXPECT_NE(points, measure(fallible(), {{6, 10}, 60, 4}));
    // A size is the same by itself.
    EXPECT_EQ(points[1], measure(fallible(), {{10}, 60, 3})[0]);
}

TEST(SuccessCurve, KeepsToTheCellsAllowed) {
    const Example chequers = make_example({2, 1, 2}, {0, 1, 1, 0}, 2);
    EXPECT_EQ(
        measure(chequers, {{5, 10, 20, 3}, 10, 1, 250 + 450 + 18}),
        (std::vector<SuccessPoint>{{{5, 1, 5}, 10, 10}, {{10, 1, 10}, 4, 4}, {{3, 1, 3}, 7, 7}})
    );
    EXPECT_TRUE(measure(chequers, {{5}, 10, 1, 24}).empty());
}

TEST(SuccessCurve, StopsWhenAsked) {
    const Example example = fallible();
    std::stop_source stop;
    stop.request_stop();
    Parameters parameters;
    parameters.size = GridSize{5, 1, 5};
    const auto points =
        measure_success(example, fill_defaults(parameters, example), {}, stop.get_token());
    ASSERT_FALSE(points);
    EXPECT_EQ(points.error().code, ErrorCode::kCancelled);
}

TEST(SuccessDrawing, PutsPointsWhereTheyBelong) {
    const std::string svg = draw_success_curves(std::vector<SuccessCurve>{
        {"one", {{{10, 8, 10}, 20, 20}, {{50, 8, 50}, 20, 5}}}});
    EXPECT_TRUE(is_well_formed(svg));
    // 0 ... 50 cells from 70 to 500, 0 ... 100 % from 330 up to 30.
    EXPECT_NE(svg.find("d=\"M156 30L500 255\""), std::string::npos) << svg;
    EXPECT_NE(svg.find(">width and depth of the model (cells)<"), std::string::npos);
    EXPECT_NE(svg.find(">runs that succeed (%)<"), std::string::npos);
    EXPECT_NE(svg.find(">one<"), std::string::npos);
    EXPECT_NE(svg.find(">50</text>"), std::string::npos);
    EXPECT_NE(svg.find(">100</text>"), std::string::npos);
    // 20 of 20 runs: with 95 % confidence more than 83.9 %; 5 of 20: 11.2 ... 46.9 %.
    EXPECT_NE(svg.find("M156 78.3V30\""), std::string::npos);
    EXPECT_NE(svg.find("M500 296.4V189.4\""), std::string::npos);
}

TEST(SuccessDrawing, NeedsNothingFromElsewhereAndSuitsDarkPages) {
    std::string svg = draw_success_curves(std::vector<SuccessCurve>{{"one", {{{5, 1, 5}, 1, 1}}}});
    EXPECT_NE(svg.find("prefers-color-scheme: dark"), std::string::npos);
    const std::string name_space = "http://www.w3.org/2000/svg";
    svg.erase(svg.find(name_space), name_space.size());
    for (const char* outside : {"http", "url(", "@import", "href", "<script", "@font-face"}) {
        EXPECT_EQ(svg.find(outside), std::string::npos) << outside;
    }
}

TEST(SuccessDrawing, HoldsAnyNameAndAnyNumberOfCurves) {
    std::vector<SuccessCurve> curves;
    for (int i = 0; i < 8; ++i) {
        curves.push_back({"</text><a b=\"&\">\x01", {{{1 + i * 37, 1, 1}, 3, 2}}});
    }
    const std::string svg = draw_success_curves(curves);
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_EQ(svg.find('\x01'), std::string::npos);
    EXPECT_TRUE(is_well_formed(draw_success_curves({})));
    EXPECT_TRUE(is_well_formed(draw_success_curves(std::vector<SuccessCurve>{{"none", {}}})));
    // Cut between characters: "ä" is two bytes long.
    const std::string umlauts =
        draw_success_curves(std::vector<SuccessCurve>{{"ääääääääää", {{{3, 1, 3}, 1, 1}}}});
    EXPECT_NE(umlauts.find(">ääääää…</text>"), std::string::npos);
    EXPECT_NE(umlauts.find("<title>ääääääääää</title>"), std::string::npos);
}

}  // namespace
}  // namespace modelsynth::discrete
