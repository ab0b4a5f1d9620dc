// Pictures of figures beside rays of sight: what is painted last at a place is what stands first
// there.

#include "solver/continuous/display/figure_drawing.h"
#include "solver/continuous/display/figure_view.h"
#include "solver/continuous/reading/reading.h"
#include "solver/examples/solids/built_in_solids.h"
#include "tests/support/random_solids.h"
#include "tests/support/well_formed.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace modelsynth::continuous {
namespace {

// What one sees at a place of a picture.
struct Seen {
    ObjectId object = kEmpty;
    bool is_cut = false;
    Point normal = Point::Zero();
};

// Nothing where it can hardly be told.
std::optional<Seen> seen_along_ray(
    const Topes& topes, const Figure& figure, FamilySet relevant, ViewFrom from, const Place& place
) {
    const Point to_viewer = direction_to_viewer(from);
    const Point right = Point::UnitY().cross(to_viewer).normalized();
    const Point start = place[0] * right + place[1] * to_viewer.cross(right);

    struct Crossing {
        double at = 0;
        Point normal = Point::Zero();
    };

    // Into the cube from the viewer's side, and out of it.
    Crossing in = {9, Point::Zero()};
    double out = -9;
    for (int axis = 0; axis < 3; ++axis) {
        const double side = to_viewer[axis] > 0 ? 1 : -1;
        const double near = (side - start[axis]) / to_viewer[axis];
        if (near < in.at) {
            in = {near, side * Point::Unit(axis)};
        }
        out = std::max(out, (-side - start[axis]) / to_viewer[axis]);
    }
    constexpr double kClear = 1e-4;
    if (std::abs(in.at - out) < kClear) {
        return std::nullopt;
    }
    if (in.at < out) {
        return Seen{};
    }
    std::vector<Crossing> crossings = {in};
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        const Point& normal = topes.normals()[family];
        const double slope = normal.dot(to_viewer);
        if ((relevant >> family & 1) == 0 || std::abs(slope) < 1e-12) {
            continue;
        }
        const double at = -normal.dot(start) / slope;
        if (at < in.at && at > out) {
            crossings.push_back({at, slope > 0 ? normal : Point(-normal)});
        }
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return a.at > b.at;
    });
    crossings.push_back({out, Point::Zero()});
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
        if (crossings[i].at - crossings[i + 1].at < kClear) {
            return std::nullopt;
        }
        const Point middle = start + (crossings[i].at + crossings[i + 1].at) / 2 * to_viewer;
        FamilySet sides = 0;
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            sides |= topes.normals()[family].dot(middle) > 0 ? FamilySet{1} << family : 0U;
        }
        const auto object = static_cast<ObjectId>(figure[topes.tope_of(sides)]);
        if (object != kEmpty) {
            return Seen{object, i == 0, crossings[i].normal};
        }
    }
    return Seen{};
}

// Whether a place is inside an outline; nothing where it is near it.
std::optional<bool> is_inside(const std::vector<Place>& outline, const Place& place) {
    bool all_left = true;
    bool all_right = true;
    double nearest = 9;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Place& a = outline[i];
        const Place& b = outline[(i + 1) % outline.size()];
        const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
        if (length < 1e-9) {
            continue;
        }
        const double side =
            ((b[0] - a[0]) * (place[1] - a[1]) - (b[1] - a[1]) * (place[0] - a[0])) / length;
        all_left = all_left && side > 0;
        all_right = all_right && side < 0;
        nearest = std::min(nearest, std::abs(side));
    }
    if (nearest < 1e-4) {
        return std::nullopt;
    }
    return all_left || all_right;
}

std::optional<Seen> painted_last(const FigureView& view, const Place& place) {
    Seen seen;
    for (const auto* pieces : {&view.surfaces, &view.cuts}) {
        for (const FigurePiece& piece : *pieces) {
            const auto inside = is_inside(piece.outline, place);
            if (!inside) {
                return std::nullopt;
            }
            if (*inside) {
                seen = {piece.object, pieces == &view.cuts, piece.normal};
            }
        }
    }
    return seen;
}

// Gives how many places were clear.
std::size_t expect_seen(
    const Topes& topes, const Figure& figure, FamilySet relevant, std::mt19937& random
) {
    std::size_t clear = 0;
    for (const ViewFrom from : {ViewFrom::kFront, ViewFrom::kBack}) {
        const FigureView view = view_figure(topes, figure, relevant, from);
        for (int i = 0; i < 40; ++i) {
            const auto part = [&random] {
                return static_cast<double>(random() % 3001) / 1000 - 1.5;
            };
            const double across = part();
            const Place place = {across, part()};
            const auto expected = seen_along_ray(topes, figure, relevant, from, place);
            const auto found = painted_last(view, place);
            if (!expected || !found) {
                continue;
            }
            ++clear;
            EXPECT_EQ(found->object, expected->object) << place[0] << ", " << place[1];
            EXPECT_EQ(found->is_cut, expected->is_cut);
            EXPECT_LT((found->normal - expected->normal).norm(), 1e-9);
        }
    }
    return clear;
}

void expect_seen(const ExampleReading& reading, std::size_t step) {
    std::mt19937 random(1);
    for (std::size_t i = 0; i < reading.figures().count(); i += step) {
        SCOPED_TRACE("figure " + std::to_string(i));
        const auto label = static_cast<Label>(i);
        const std::size_t clear = expect_seen(
            reading.topes(), reading.figures().at(label), reading.figures().relevant(label), random
        );
        EXPECT_GT(clear, 40U);
    }
}

TEST(FigureViewProperty, OfBuiltInExamplesHasInFrontWhatIsInFront) {
    for (const auto& reading : examples::built_in_solids()) {
        SCOPED_TRACE(reading->example().name);
        expect_seen(*reading, 3);
    }
}

TEST(FigureViewProperty, OfRandomSolidsHasInFrontWhatIsInFront) {
    std::size_t read = 0;
    for (const auto kind :
         {testing::SolidsKind::kBoxes,
          testing::SolidsKind::kWedges,
          testing::SolidsKind::kTetrahedra,
          testing::SolidsKind::kConvex}) {
        for (std::uint32_t seed = 0; seed < 10; ++seed) {
            SCOPED_TRACE(
                "kind " + std::to_string(static_cast<int>(kind)) + ", seed " + std::to_string(seed)
            );
            const auto reading = ExampleReading::make(testing::make_random_solids(kind, seed));
            if (reading) {
                expect_seen(**reading, 5);
                ++read;
            }
        }
    }
    EXPECT_GT(read, 20U);
}

// What is thinner than can be seen is drawn in some way.
TEST(FigureViewProperty, OfSliversIsAPicture) {
    std::size_t read = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto reading =
            ExampleReading::make(testing::make_random_solids(testing::SolidsKind::kSlivers, seed));
        if (reading) {
            EXPECT_TRUE(testing::is_well_formed(draw_figure_sheet(**reading)));
            ++read;
        }
    }
    EXPECT_GT(read, 5U);
}

// Any objects in the cells of up to ten planes.
TEST(FigureViewProperty, OfRandomFiguresHasInFrontWhatIsInFront) {
    std::size_t seen = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::vector<Point> normals;
        for (std::size_t i = 0; i < 3 + seed % 8; ++i) {
            const auto part = [&random] { return static_cast<double>(random() % 2001) - 1000; };
            const double x = part();
            const double y = part();
            normals.push_back(Point(x, y, part()).normalized());
        }
        const auto topes = Topes::make(normals);
        if (!topes) {
            continue;
        }
        Figure figure;
        for (std::size_t tope = 0; tope < topes->count(); ++tope) {
            figure.push_back(random() % 3 == 0 ? static_cast<char>(1 + random() % 2) : '\0');
        }
        const FamilySet all = (FamilySet{1} << topes->family_count()) - 1;
        seen += expect_seen(*topes, figure, all, random);
    }
    EXPECT_GT(seen, 2000U);
}

// Places of the picture are the point's coordinates across the line of sight.
TEST(FigureViewProperty, PutsPointsWhereTheyAreSeen) {
    for (const ViewFrom from : {ViewFrom::kFront, ViewFrom::kBack}) {
        const Point to_viewer = direction_to_viewer(from);
        EXPECT_NEAR(to_viewer.norm(), 1, 1e-12);
        const Point right = Point::UnitY().cross(to_viewer).normalized();
        for (const Point& point : {Point(1, 2, 3), Point(-2, 0.5, 1), Point(0, -1, 0)}) {
            const Place place = place_of(point, from);
            EXPECT_NEAR(place[0], right.dot(point), 1e-12);
            EXPECT_NEAR(place[1], to_viewer.cross(right).dot(point), 1e-12);
        }
    }
}

}  // namespace
}  // namespace modelsynth::continuous
