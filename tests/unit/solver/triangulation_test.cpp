#include "solver/continuous/triangulation/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct Shape {
    std::vector<Point2> points;
    Loop outer;
    std::vector<Loop> holes;
};

// The standard distributions differ between libraries, the engine does not.
double random_between(std::mt19937_64& random, double min, double max) {
    return min + (max - min) * static_cast<double>(random() >> 11) * 0x1p-53;
}

std::uint32_t random_below(std::mt19937_64& random, std::uint32_t bound) {
    return static_cast<std::uint32_t>(random() % bound);
}

double twice_area(const Point2& a, const Point2& b, const Point2& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double area_of(const Shape& shape, const Loop& loop) {
    double sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point2& a = shape.points[loop[i]];
        const Point2& b = shape.points[loop[(i + 1) % loop.size()]];
        sum += twice_area(shape.points[loop[0]], a, b);
    }
    return sum / 2;
}

double area_of(const Shape& shape) {
    double sum = area_of(shape, shape.outer);
    for (const Loop& hole : shape.holes) {
        sum += area_of(shape, hole);
    }
    return sum;
}

Triangles fill(const Shape& shape) { return triangulate(shape.points, shape.outer, shape.holes); }

// Of equal points the first.
std::uint32_t first_at_its_place(const Shape& shape, std::uint32_t number) {
    const auto found = std::find(shape.points.begin(), shape.points.end(), shape.points[number]);
    return static_cast<std::uint32_t>(found - shape.points.begin());
}

// How often each directed edge is in the loops, less how often its reverse is; the same for that of
// triangles. What is there and back cancels, so these are equal just if the triangles have the
// loops for a border.
using Border = std::map<Edge, int>;

void add_edge(std::uint32_t from, std::uint32_t to, Border& border) {
    const int sign = from < to ? 1 : -1;
    int& count = border[std::minmax(from, to)];
    count += sign;
    if (count == 0) {
        border.erase(std::minmax(from, to));
    }
}

Border border_of(const Shape& shape) {
    Border result;
    const auto add = [&](const Loop& loop) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint32_t next = loop[(i + 1) % loop.size()];
            add_edge(first_at_its_place(shape, loop[i]), first_at_its_place(shape, next), result);
        }
    };
    add(shape.outer);
    std::for_each(shape.holes.begin(), shape.holes.end(), add);
    return result;
}

// The laws of the header; `height_min` is of every triangle.
void expect_fills(const Shape& shape, const Triangles& triangles, double height_min) {
    double sum = 0;
    Border border;
    std::map<Edge, int> uses;
    for (const auto& triangle : triangles) {
        double longest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = triangle[i];
            const std::uint32_t to = triangle[(i + 1) % 3];
            ASSERT_LT(from, shape.points.size());
            add_edge(from, to, border);
            EXPECT_EQ(++uses[Edge(from, to)], 1) << "edge " << from << " to " << to;
            const Point2& a = shape.points[from];
            const Point2& b = shape.points[to];
            longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1]));
        }
        const double area = twice_area(
            shape.points[triangle[0]], shape.points[triangle[1]], shape.points[triangle[2]]
        );
        EXPECT_GT(area, height_min * longest);
        sum += area / 2;
    }
    const double expected = area_of(shape);
    EXPECT_NEAR(sum, expected, 1e-9 * expected);
    EXPECT_EQ(border, border_of(shape));
}

void expect_fills(const Shape& shape, double height_min = 1e-6) {
    const Triangles triangles = fill(shape);
    expect_fills(shape, triangles, height_min);
    EXPECT_EQ(triangles, fill(shape));
}

// The points of a new loop are appended.
Loop add_loop(Shape& shape, const std::vector<Point2>& points) {
    Loop loop;
    for (const Point2& point : points) {
        loop.push_back(static_cast<std::uint32_t>(shape.points.size()));
        shape.points.push_back(point);
    }
    return loop;
}

Shape make_shape(
    const std::vector<Point2>& outer, const std::vector<std::vector<Point2>>& holes = {}
) {
    Shape shape;
    shape.outer = add_loop(shape, outer);
    for (const auto& hole : holes) {
        shape.holes.push_back(add_loop(shape, hole));
    }
    return shape;
}

// A clockwise square.
std::vector<Point2> square_hole(double x, double y, double size) {
    return {{x, y}, {x, y + size}, {x + size, y + size}, {x + size, y}};
}

// Turned, moved and with errors, as points of faces in space are: no three are exactly collinear.
void disturb(Shape& shape, std::mt19937_64& random, double error) {
    const double angle = random_between(random, 0, 6.28);
    const Point2 shift = {random_between(random, -5e3, 5e3), random_between(random, -5e3, 5e3)};
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    for (Point2& point : shape.points) {
        const Point2 turned = {
            cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]};
        for (const std::size_t axis : {0U, 1U}) {
            point[axis] = turned[axis] + shift[axis] + random_between(random, -error, error);
        }
    }
}

// Every edge is divided into up to three.
void divide_edges(Shape& shape, std::mt19937_64& random) {
    const auto divide = [&](Loop& loop) {
        Loop divided;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            divided.push_back(loop[i]);
            const Point2 a = shape.points[loop[i]];
            const Point2 b = shape.points[loop[(i + 1) % loop.size()]];
            const std::uint32_t parts = 1 + random_below(random, 3);
            for (std::uint32_t part = 1; part < parts; ++part) {
                const double share = static_cast<double>(part) / parts;
                divided.push_back(static_cast<std::uint32_t>(shape.points.size()));
                shape.points.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])}
                );
            }
        }
        loop = divided;
    };
    divide(shape.outer);
    std::for_each(shape.holes.begin(), shape.holes.end(), divide);
}

TEST(Triangulation, OfATriangleIsTheTriangle) {
    const Shape shape = make_shape({{0, 0}, {2, 0}, {0, 1}});
    EXPECT_EQ(fill(shape).size(), 1U);
    expect_fills(shape);
}

TEST(Triangulation, FillsASquareAndAnL) {
    const Shape square = make_shape({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    EXPECT_EQ(fill(square).size(), 2U);
    expect_fills(square);
    const Shape l_shape = make_shape({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}});
    EXPECT_EQ(fill(l_shape).size(), 4U);
    expect_fills(l_shape);
}

TEST(Triangulation, UsesVerticesBetweenCollinearEdges) {
    const Shape square = make_shape(
        {{0, 0},
         {1, 0},
         {2, 0},
         {3, 0},
         {3, 1},
         {3, 2},
         {3, 3},
         {2, 3},
         {1, 3},
         {0, 3},
         {0, 2},
         {0, 1}}
    );
    EXPECT_EQ(fill(square).size(), 10U);
    expect_fills(square);
    // All but one on one side.
    const Shape fan = make_shape({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}, {2, 1}});
    EXPECT_EQ(fill(fan).size(), 5U);
    expect_fills(fan);
}

TEST(Triangulation, ReadsOnlyThePointsOfTheLoops) {
    const double nan = std::nan("");
    Shape shape = make_shape({{nan, nan}, {0, 0}, {1, 0}, {1, 1}, {nan, 0}, {0, 1}});
    shape.outer = {1, 2, 3, 5};
    expect_fills(shape);
}

TEST(Triangulation, LeavesHolesOut) {
    const Shape one = make_shape({{0, 0}, {3, 0}, {3, 3}, {0, 3}}, {square_hole(1, 1, 1)});
    EXPECT_EQ(fill(one).size(), 8U);
    expect_fills(one);
    // Side by side and one above the other, all in line with each other and with the corners.
    const Shape four = make_shape(
        {{0, 0}, {5, 0}, {5, 1}, {5, 2}, {5, 5}, {0, 5}},
        {square_hole(1, 1, 1), square_hole(3, 1, 1), square_hole(1, 3, 1), square_hole(3, 3, 1)}
    );
    expect_fills(four);
}

TEST(Triangulation, FillsAroundAHoleThatTouchesTheOuterLoop) {
    // At a corner of the outer loop.
    Shape at_corner = make_shape({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 2}, {2, 3}, {2, 1}});
    at_corner.outer = {0, 1, 2, 3};
    at_corner.holes = {{0, 4, 5, 6}};
    expect_fills(at_corner);
    // At a vertex between collinear edges, at two, and with the hole in the outer loop.
    Shape on_side = make_shape({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4}, {1, 2}, {3, 2}});
    on_side.outer = {0, 1, 2, 3, 4, 5};
    on_side.holes = {{1, 6, 7}};
    expect_fills(on_side);
    on_side.holes = {{1, 6, 4, 7}};
    expect_fills(on_side);
    on_side.holes.clear();
    on_side.outer = {0, 1, 6, 7, 1, 2, 3, 4, 5};
    expect_fills(on_side);
}

TEST(Triangulation, TakesPointsAtOnePlaceForOne) {
    Shape shape = make_shape(
        {{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}},
        {{{2, 0}, {1, 2}, {3, 2}}, {{3, 2}, {2.5, 3}, {3.5, 3}}}
    );
    expect_fills(shape);
    const Triangles expected = fill(shape);
    for (std::size_t i = 5; i < shape.points.size(); ++i) {
        shape.points[i][0] += 1e-9;
        shape.points[i][1] -= 1e-9;
    }
    EXPECT_EQ(fill(shape), expected);
}

TEST(Triangulation, FillsAroundHolesThatTouchEachOther) {
    Shape shape = make_shape({{0, 0}, {6, 0}, {6, 6}, {0, 6}});
    const Loop lower = add_loop(shape, square_hole(1, 1, 2));
    const Loop upper = add_loop(shape, square_hole(3, 3, 2));
    shape.holes = {lower, {lower[2], upper[1], upper[2], upper[3]}};
    expect_fills(shape);
    // The same as one loop.
    shape.holes = {
        {lower[0], lower[1], lower[2], upper[1], upper[2], upper[3], lower[2], lower[3]}};
    expect_fills(shape);
}

TEST(Triangulation, FillsWhatHolesThatTouchEnclose) {
    // Four squares around one, as on a chessboard: inside of them is an island.
    Shape shape = make_shape({{0, 0}, {7, 0}, {7, 7}, {0, 7}});
    const Loop corner = add_loop(shape, {{3, 3}, {4, 3}, {4, 4}, {3, 4}});
    const Loop rest =
        add_loop(shape, {{3, 2}, {4, 2}, {5, 3}, {5, 4}, {4, 5}, {3, 5}, {2, 4}, {2, 3}});
    shape.holes = {
        {corner[0], corner[1], rest[1], rest[0]},
        {corner[1], corner[2], rest[3], rest[2]},
        {corner[2], corner[3], rest[5], rest[4]},
        {corner[3], corner[0], rest[7], rest[6]}};
    expect_fills(shape);
}

TEST(Triangulation, FillsPartsThatTouchAtAVertexAndTheirHoles) {
    // Both hang from one vertex; the loop passes it so that its corners there overlap.
    Shape shape = make_shape({{0, 0}, {-4, -5}, {-1, -5}, {1, -5}, {4, -5}});
    shape.outer = {0, 1, 2, 0, 3, 4};
    expect_fills(shape);
    shape.holes = {
        add_loop(shape, {{-2, -4.5}, {-2, -4}, {-1.5, -4}}),
        add_loop(shape, {{2, -4.5}, {2, -4}, {2.5, -4}})};
    expect_fills(shape);
}

TEST(Triangulation, FillsACombAndASpiral) {
    for (const std::uint32_t teeth : {1U, 2U, 50U, 1000U}) {
        std::vector<Point2> comb = {{2.0 * teeth, -1}, {2.0 * teeth, 0}};
        for (std::uint32_t tooth = teeth; tooth-- > 0;) {
            comb.push_back({2.0 * tooth + 1, 30});
            comb.push_back({2.0 * tooth, 0});
        }
        comb.push_back({0, -1});
        expect_fills(make_shape(comb));
    }
    std::vector<Point2> spiral;
    constexpr int kSteps = 1000;
    for (int i = -kSteps; i <= kSteps; ++i) {
        const double angle = 0.05 * std::abs(i);
        const double radius = i < 0 ? angle : angle + 2;
        const Point2 point = {radius * std::cos(angle), radius * std::sin(angle)};
        spiral.push_back(point);
    }
    // Out along the outer arm, back along the inner.
    std::rotate(spiral.begin(), spiral.begin() + kSteps, spiral.end());
    expect_fills(make_shape(spiral));
}

TEST(Triangulation, FillsAroundFiveHundredHoles) {
    std::vector<std::vector<Point2>> holes;
    for (int column = 0; column < 25; ++column) {
        for (int row = 0; row < 20; ++row) {
            const double x = 2 * column;
            const double y = 2 * row;
            holes.push_back(
                {{x, y},
                 {x, y + 0.5},
                 {x, y + 1},
                 {x + 0.3, y + 1},
                 {x + 0.6, y + 1},
                 {x + 1, y + 1},
                 {x + 1, y + 0.5},
                 {x + 1, y},
                 {x + 0.6, y},
                 {x + 0.3, y}}
            );
        }
    }
    const Shape shape = make_shape({{-1, -1}, {50, -1}, {50, 40}, {-1, 40}}, holes);
    EXPECT_EQ(fill(shape).size(), 2U + 500U * 12U);
    expect_fills(shape);
}

TEST(Triangulation, FillsSlotsBesideEachOther) {
    std::vector<std::vector<Point2>> slots;
    for (int i = 0; i < 300; ++i) {
        slots.push_back({{1.0 * i, 1}, {1.0 * i, 99}, {i + 0.5, 99}, {i + 0.5, 1}});
    }
    Shape shape = make_shape({{-1, 0}, {300, 0}, {300, 100}, {-1, 100}}, slots);
    expect_fills(shape);
    std::mt19937_64 random(5);
    divide_edges(shape, random);
    expect_fills(shape);
}

TEST(Triangulation, FillsARegularPolygonOfManyCorners) {
    std::vector<Point2> round;
    constexpr int kCorners = 5000;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * 3.14159265358979 * i / kCorners;
        round.push_back({std::cos(angle), std::sin(angle)});
    }
    expect_fills(make_shape(round), 1e-8);
    // So small that every corner is flat within the tolerance.
    for (Point2& point : round) {
        point = {0.01 * point[0], 0.01 * point[1]};
    }
    expect_fills(make_shape(round), 0);
}

TEST(Triangulation, FillsRandomStars) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        const std::uint32_t count = seed % 50 == 49 ? 2000 : 5 + random_below(random, 80);
        std::vector<Point2> star;
        for (std::uint32_t i = 0; i < count; ++i) {
            const double angle = 6.2831853 * i / count;
            const double radius = random_between(random, 1, 10);
            star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        }
        Shape shape = make_shape(star);
        if (seed % 2 == 1) {
            shape.holes = {add_loop(shape, {{-0.5, -0.2}, {0.1, 0.4}, {0.3, -0.3}})};
        }
        expect_fills(shape, 1e-8);
        divide_edges(shape, random);
        expect_fills(shape, 1e-8);
        disturb(shape, random, 1e-9);
        expect_fills(shape, 1e-8);
    }
}

// Some cells of a square grid that hang together.
class Cells {
  public:
    Cells(std::uint32_t size, std::uint32_t count, std::mt19937_64& random)
        : size_(size), is_filled_(std::size_t{size} * size) {
        std::vector<Edge> filled = {{size / 2, size / 2}};
        add(filled.front());
        for (std::uint32_t step = 0; step < 50 * count && filled.size() < count; ++step) {
            auto [x, y] = filled[random_below(random, static_cast<std::uint32_t>(filled.size()))];
            std::uint32_t& axis = random_below(random, 2) == 0 ? x : y;
            axis += random_below(random, 2) == 0 ? 1 : ~0U;
            if (x < size && y < size && !is_filled(x, y)) {
                filled.emplace_back(x, y);
                add(filled.back());
            }
        }
    }

    // The loops around the cells, a vertex at every unit. Where two touch, chance decides which way
    // each goes on.
    [[nodiscard]] Shape outline(std::mt19937_64& random) const {
        Shape shape;
        for (std::uint32_t y = 0; y <= size_; ++y) {
            for (std::uint32_t x = 0; x <= size_; ++x) {
                shape.points.push_back({static_cast<double>(x), static_cast<double>(y)});
            }
        }
        std::map<std::uint32_t, std::vector<std::uint32_t>> ends = edges();
        while (!ends.empty()) {
            const std::uint32_t first = ends.begin()->first;
            Loop loop;
            std::uint32_t at = first;
            do {
                loop.push_back(at);
                auto& choices = ends[at];
                std::swap(
                    choices[random_below(random, static_cast<std::uint32_t>(choices.size()))],
                    choices.back()
                );
                const std::uint32_t next = choices.back();
                choices.pop_back();
                if (choices.empty()) {
                    ends.erase(at);
                }
                at = next;
            } while (at != first);
            if (area_of(shape, loop) > 0) {
                EXPECT_TRUE(shape.outer.empty());
                shape.outer = loop;
            } else {
                shape.holes.push_back(loop);
            }
        }
        return shape;
    }

  private:
    [[nodiscard]] bool is_filled(std::uint32_t x, std::uint32_t y) const {
        return x < size_ && y < size_ && is_filled_[std::size_t{y} * size_ + x];
    }

    void add(const Edge& cell) { is_filled_[std::size_t{cell.second} * size_ + cell.first] = true; }

    // Of every point where the edges from there end; the cells are to the left.
    [[nodiscard]] std::map<std::uint32_t, std::vector<std::uint32_t>> edges() const {
        std::map<std::uint32_t, std::vector<std::uint32_t>> result;
        const std::uint32_t up = size_ + 1;
        for (std::uint32_t y = 0; y < size_; ++y) {
            for (std::uint32_t x = 0; x < size_; ++x) {
                if (!is_filled(x, y)) {
                    continue;
                }
                const std::uint32_t point = y * up + x;
                const auto add = [&](bool is_inner, std::uint32_t from, std::uint32_t to) {
                    if (!is_inner) {
                        result[from].push_back(to);
                    }
                };
                add(is_filled(x, y - 1), point, point + 1);
                add(is_filled(x + 1, y), point + 1, point + 1 + up);
                add(is_filled(x, y + 1), point + 1 + up, point + up);
                add(is_filled(x - 1, y), point + up, point);
            }
        }
        return result;
    }

    std::uint32_t size_;
    std::vector<bool> is_filled_;
};

TEST(Triangulation, FillsRandomRectilinearShapesThatTouchThemselves) {
    for (std::uint32_t seed = 0; seed < 600; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        const std::uint32_t size = seed % 100 == 99 ? 60 : 3 + random_below(random, 12);
        const std::uint32_t count = 1 + random_below(random, size * size);
        Shape shape = Cells(size, count, random).outline(random);
        const Triangles triangles = fill(shape);
        // On a grid, no triangle is less than half a cell.
        expect_fills(shape, triangles, 0.4 / (1.5 * size));
        disturb(shape, random, 1e-9);
        expect_fills(shape, 0.4 / (1.5 * size));
    }
}

// Every loop gets points of its own, also where it touches others or itself.
Shape with_own_points(const Shape& shape) {
    Shape result;
    const auto copy = [&](const Loop& loop) {
        std::vector<Point2> points;
        for (const std::uint32_t number : loop) {
            points.push_back(shape.points[number]);
        }
        return add_loop(result, points);
    };
    result.outer = copy(shape.outer);
    for (const Loop& hole : shape.holes) {
        result.holes.push_back(copy(hole));
    }
    return result;
}

TEST(Triangulation, KeepsTheAreaOfLoopsThatCrossALittle) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        const std::uint32_t size = 3 + random_below(random, 12);
        const Shape exact =
            Cells(size, 1 + random_below(random, size * size), random).outline(random);
        for (const double error : {1e-9, 1e-7, 1e-4}) {
            Shape shape = with_own_points(exact);
            disturb(shape, random, error);
            double sum = 0;
            double sum_of_sizes = 0;
            for (const auto& [a, b, c] : fill(shape)) {
                const double area =
                    twice_area(shape.points[a], shape.points[b], shape.points[c]) / 2;
                sum += area;
                sum_of_sizes += std::abs(area);
            }
            // The triangles may be between any points that are one.
            EXPECT_NEAR(sum, area_of(shape), 1e-9 * size * size);
            // With larger errors, points are no longer one and triangles may overlap.
            if (error <= 1e-9) {
                EXPECT_LE(sum_of_sizes, sum + 1e-9);
            }
        }
    }
}

TEST(Triangulation, EndsWhateverTheLoopsAre) {
    EXPECT_TRUE(fill(Shape{}).empty());
    EXPECT_TRUE(fill(make_shape({{1, 1}, {1, 1}, {1, 1}})).empty());
    EXPECT_TRUE(fill(make_shape({{0, 0}, {1, 0}})).empty());
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        Shape shape;
        for (std::uint32_t loops = 1 + random_below(random, 4); loops > 0; --loops) {
            std::vector<Point2> tangle;
            for (std::uint32_t i = random_below(random, 40); i > 0; --i) {
                tangle.push_back({1.0 * random_below(random, 8), 1.0 * random_below(random, 8)});
            }
            shape.holes.push_back(add_loop(shape, tangle));
        }
        EXPECT_LE(fill(shape).size(), 3 * shape.points.size());
    }
}

}  // namespace
}  // namespace modelsynth::continuous
