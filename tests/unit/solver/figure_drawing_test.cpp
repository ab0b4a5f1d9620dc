// Pictures of figures: which edges are drawn, and files that any reader can show.

#include "solver/continuous/display/figure_drawing.h"

#include "solver/continuous/display/figure_view.h"
#include "solver/continuous/reading/reading.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/support/well_formed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using testing::is_well_formed;

constexpr FamilySet kAll = 0b111;

Topes three_axes() { return Topes::make({{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}).value(); }

// The middles of strokes, each once.
std::set<std::pair<long, long>> middles(const std::vector<Stroke>& strokes) {
    std::set<std::pair<long, long>> found;
    for (const auto& [from, to] : strokes) {
        found.emplace(std::lround((from[0] + to[0]) * 1000), std::lround((from[1] + to[1]) * 1000));
    }
    return found;
}

std::vector<Stroke> edges_of(const std::vector<FigurePiece>& pieces) {
    std::vector<Stroke> edges;
    for (const FigurePiece& piece : pieces) {
        edges.insert(edges.end(), piece.edges.begin(), piece.edges.end());
    }
    return edges;
}

TEST(FigureView, ShowsAFaceAsOneSquareOnHalfACube) {
    const Topes topes = three_axes();
    const Figure figure = face_figure(topes, 0, 1, kEmpty);
    const FigureView view = view_figure(topes, figure, 0b001, ViewFrom::kFront);
    ASSERT_EQ(view.surfaces.size(), 1U);
    EXPECT_EQ(view.surfaces[0].object, 1);
    EXPECT_EQ(view.surfaces[0].outline.size(), 4U);
    EXPECT_LT((view.surfaces[0].normal - Point::UnitY()).norm(), 1e-12);
    EXPECT_EQ(view.edges.size(), 4U);
    EXPECT_EQ(view.cuts.size(), 2U);
    EXPECT_EQ(middles(edges_of(view.cuts)).size(), 7U);
    EXPECT_FALSE(view.is_point_hidden);
    // From below the bottom is seen, and two sides, and nothing of the surface.
    const FigureView back = view_figure(topes, figure, 0b001, ViewFrom::kBack);
    EXPECT_EQ(back.surfaces.size(), 0U);
    EXPECT_EQ(back.cuts.size(), 3U);
    EXPECT_TRUE(back.is_point_hidden);
}

TEST(FigureView, DrawsNoSeamsWhereASurfaceGoesOn) {
    const Topes topes = three_axes();
    const FigureView view =
        view_figure(topes, face_figure(topes, 0, 1, kEmpty), kAll, ViewFrom::kFront);
    EXPECT_EQ(view.surfaces.size(), 4U);
    EXPECT_EQ(view.edges.size(), 8U);  // two at the cube's sides for each quarter
    EXPECT_EQ(view.cuts.size(), 4U);
    EXPECT_EQ(edges_of(view.cuts).size(), 12U);  // no upright ones but at the cube's edges
}

TEST(FigureView, DrawsTheEdgesOfACorner) {
    const Topes topes = three_axes();
    Figure figure(topes.count(), '\0');
    figure[topes.tope_of(0)] = 1;  // west, below, behind
    const FigureView view = view_figure(topes, figure, kAll, ViewFrom::kFront);
    EXPECT_EQ(view.surfaces.size(), 3U);
    EXPECT_EQ(view.cuts.size(), 0U);
    EXPECT_EQ(view.edges.size(), 12U);
    EXPECT_EQ(middles(view.edges).size(), 9U);
    EXPECT_FALSE(view.is_point_hidden);
}

TEST(FigureView, DrawsTheBorderBetweenObjects) {
    const Topes topes = three_axes();
    const FigureView view =
        view_figure(topes, face_figure(topes, 0, 1, 2), 0b001, ViewFrom::kFront);
    EXPECT_EQ(view.surfaces.size(), 0U);
    EXPECT_EQ(view.cuts.size(), 5U);
    EXPECT_EQ(middles(view.edges).size(), 4U);
    EXPECT_TRUE(view.is_point_hidden);
}

std::shared_ptr<const ExampleReading> grey_blocks(const std::string& name) {
    Example example;
    example.name = name;
    example.materials = {{"grey", {0.3F, 0.3F, 0.3F}}};
    example.objects = {{name, 0}, {"b", 0}, {"c", 0}};
    example.polyhedra = {
        box(1, {0, 0, 0}, {1, 1, 1}), box(2, {1, 0, 0}, {2, 2, 1}), box(3, {0, 1, 0}, {1, 2, 1})};
    return ExampleReading::make(std::move(example)).value();
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

TEST(FigureDrawing, OfEachFigureOfBuiltInExamplesIsASmallFile) {
    for (const auto& reading : examples::built_in_solids()) {
        SCOPED_TRACE(reading->example().name);
        for (std::size_t number = 0; number < reading->figures().count(); number += 7) {
            const std::string svg = draw_figure(*reading, number);
            ASSERT_TRUE(is_well_formed(svg)) << svg;
            EXPECT_LT(svg.size(), 16000U);
            EXPECT_EQ(count_of(svg, "point\" r="), 2U);
        }
    }
}

TEST(FigureDrawing, SheetHoldsSoManyFiguresAndSaysSo) {
    const auto houses = examples::find_solids("houses");
    const std::string svg = draw_figure_sheet(*houses);
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_EQ(count_of(svg, "point\" r="), 2 * kFiguresOnSheetMax);
    EXPECT_NE(
        svg.find("the first 256 of " + std::to_string(houses->figures().count())), std::string::npos
    );
    const std::string all = draw_figure_sheet(*grey_blocks("a"));
    EXPECT_EQ(all.find("the first"), std::string::npos);
    EXPECT_LT(all.find(">Corners<"), all.find(">Edges<"));
    EXPECT_LT(all.find(">Edges<"), all.find(">Faces<"));
    EXPECT_LT(all.find(">Faces<"), all.find(">Insides<"));
    EXPECT_NE(all.find(">Insides<"), std::string::npos);
    EXPECT_NE(all.find(">empty space<"), std::string::npos);
}

TEST(FigureDrawing, TellsObjectsOfOneColourApart) {
    const auto reading = grey_blocks("a");
    const std::string svg = draw_figure_sheet(*reading);
    std::set<std::string> colors;
    const std::string swatch = "<rect ";
    for (std::size_t at = svg.find(swatch); at != std::string::npos;
         at = svg.find(swatch, at + 1)) {
        colors.insert(svg.substr(svg.find("fill=", at), 14));
    }
    EXPECT_EQ(colors.size(), 3U);
    EXPECT_TRUE(colors.contains("fill=\"#959595\""));  // the first one is as it is
}

TEST(FigureDrawing, NeedsNothingFromElsewhereAndHoldsAnyName) {
    const auto reading = grey_blocks("</text><a b=\"&\">\x01");
    for (std::string svg : {draw_figure_sheet(*reading), draw_figure(*reading, 0)}) {
        EXPECT_TRUE(is_well_formed(svg));
        EXPECT_EQ(svg.find('\x01'), std::string::npos);
        EXPECT_NE(svg.find("prefers-color-scheme: dark"), std::string::npos);
        const std::string name_space = "http://www.w3.org/2000/svg";
        svg.erase(svg.find(name_space), name_space.size());
        for (const char* outside : {"http", "@import", "<script", "@font-face", "NaN", "nan"}) {
            EXPECT_EQ(svg.find(outside), std::string::npos) << outside;
        }
        EXPECT_EQ(count_of(svg, "url("), count_of(svg, "url(#cut-"));
        EXPECT_EQ(count_of(svg, "href="), count_of(svg, "href=\"#cube-"));
    }
}

TEST(FigureDrawing, IsTheSameForTheSameExample) {
    EXPECT_EQ(draw_figure_sheet(*grey_blocks("a")), draw_figure_sheet(*grey_blocks("a")));
    EXPECT_EQ(draw_figure(*grey_blocks("a"), 3), draw_figure(*grey_blocks("a"), 3));
}

}  // namespace
}  // namespace modelsynth::continuous
