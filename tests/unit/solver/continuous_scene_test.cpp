// Models of solids as meshes: the texture coordinates of their faces.

#include "solver/continuous/problem.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

namespace modelsynth::continuous {
namespace {

constexpr double kMillimetre = 1e-3;

struct Corner {
    Point place;
    Point normal;
    Eigen::Vector2d at;  // in the picture
};

using Triangle = std::array<Corner, 3>;

std::vector<Triangle> triangles_of(const Scene& scene) {
    std::vector<Triangle> triangles;
    for (const Mesh& mesh : scene.kit->meshes) {
        for (const Primitive& part : mesh.primitives) {
            EXPECT_EQ(part.texture_coordinates.size(), part.positions.size());
            for (std::size_t i = 0; i < part.indices.size(); ++i) {
                const std::uint32_t vertex = part.indices[i];
                const Vec3& place = part.positions[vertex];
                const Vec3& normal = part.normals[vertex];
                const Vec2& at = part.texture_coordinates.at(vertex);
                if (i % 3 == 0) {
                    triangles.emplace_back();
                }
                triangles.back()[i % 3] = {
                    {place.x, place.y, place.z}, {normal.x, normal.y, normal.z}, {at.x, at.y}};
            }
        }
    }
    return triangles;
}

std::vector<Corner> corners_of(const std::vector<Triangle>& triangles) {
    std::vector<Corner> corners;
    for (const Triangle& triangle : triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    return corners;
}

// Houses have walls, floors and slopes of several directions.
struct Houses {
    std::shared_ptr<const ExampleReading> reading =
        ExampleReading::make(examples::make_houses()).value();
    Surface surface = make_model();

  private:
    class Silent final : public Observer {
      public:
        void on_start(std::uint32_t, std::span<const Label>) override {}

        void on_block(const BlockReport&) override {}
    };

    [[nodiscard]] Surface make_model() const {
        Parameters parameters;
        parameters.size = {12, 8, 12};
        parameters = fill_defaults(parameters, reading->example());
        const Problem problem = make_problem(reading, parameters).value();
        Silent silent;
        return make_surface(problem, synthesise(problem, parameters, 1, silent, {})->labels);
    }
};

void expect_true_to_scale(const std::vector<Triangle>& triangles) {
    for (const auto& [a, b, c] : triangles) {
        EXPECT_NEAR((b.at - a.at).norm(), (b.place - a.place).norm(), kMillimetre);
        EXPECT_NEAR((c.at - b.at).norm(), (c.place - b.place).norm(), kMillimetre);
        EXPECT_NEAR((a.at - c.at).norm(), (a.place - c.place).norm(), kMillimetre);
    }
}

TEST(TextureCoordinates, OfAWallAreItsMetres) {
    Example example;
    example.materials = {{"wall", {}}};
    example.objects = {{"wall", 0}};
    example.polyhedra = {examples::box(1, {1, 0, 2}, {5, 3, 8})};
    const auto reading = ExampleReading::make(example).value();
    std::size_t south = 0;
    std::size_t east = 0;
    std::size_t above = 0;
    for (const Triangle& triangle : triangles_of(make_example_scene(*reading))) {
        for (const Corner& corner : triangle) {
            if (corner.normal == Point(0, 0, 1)) {
                EXPECT_EQ(corner.at, Eigen::Vector2d(corner.place.x(), -corner.place.y()));
                ++south;
            } else if (corner.normal == Point(1, 0, 0)) {
                EXPECT_EQ(corner.at, Eigen::Vector2d(-corner.place.z(), -corner.place.y()));
                ++east;
            } else if (corner.normal == Point(0, 1, 0)) {
                EXPECT_EQ(corner.at, Eigen::Vector2d(corner.place.x(), corner.place.z()));
                ++above;
            }
        }
    }
    EXPECT_EQ(std::tuple(south, east, above), std::tuple(6U, 6U, 6U));
}

TEST(TextureCoordinates, AreTrueToScaleOnEverySlope) {
    const Houses houses;
    const auto triangles = triangles_of(make_scene(*houses.reading, houses.surface));
    ASSERT_GT(triangles.size(), 100U);
    expect_true_to_scale(triangles);
    expect_true_to_scale(triangles_of(make_example_scene(*houses.reading)));
}

TEST(TextureCoordinates, StandUprightAndAreNotMirrored) {
    const Houses houses;
    std::size_t slopes = 0;
    for (const auto& [a, b, c] : triangles_of(make_scene(*houses.reading, houses.surface))) {
        // Counter-clockwise where v grows downwards.
        const Eigen::Vector2d ab = b.at - a.at;
        const Eigen::Vector2d ac = c.at - a.at;
        EXPECT_LT(ab.x() * ac.y() - ab.y() * ac.x(), 0);
        if (std::abs(a.normal.y()) > 0.999) {
            continue;
        }
        // Down by one metre of height is down by more along a slope.
        const double steepness = std::sqrt(1 - a.normal.y() * a.normal.y());
        EXPECT_NEAR(ab.y() * steepness, a.place.y() - b.place.y(), kMillimetre);
        EXPECT_NEAR(ac.y() * steepness, a.place.y() - c.place.y(), kMillimetre);
        slopes += steepness < 0.999 ? 1U : 0U;
    }
    EXPECT_GT(slopes, 10U);
}

bool is_in_plane_of(const Corner& a, const Corner& b) {
    return a.normal == b.normal && std::abs(a.normal.dot(b.place - a.place)) < kMillimetre;
}

TEST(TextureCoordinates, OfBlocksAreThoseOfTheModel) {
    const Houses houses;
    const auto model = triangles_of(make_scene(*houses.reading, houses.surface));
    std::size_t shared = 0;
    std::size_t cut = 0;
    for (const double x : {0.0, 5.3}) {
        const Bounds part = {{x, -1, 2.7}, {x + 5.3, 9, 9.1}};
        const auto triangles = triangles_of(make_scene(*houses.reading, houses.surface, part));
        expect_true_to_scale(triangles);
        for (const Corner& corner : corners_of(triangles)) {
            bool is_shared = false;
            for (const Corner& other : corners_of(model)) {
                if (!is_in_plane_of(corner, other)) {
                    continue;
                }
                is_shared = is_shared || corner.place == other.place;
                EXPECT_NEAR(
                    (corner.at - other.at).norm(), (corner.place - other.place).norm(), kMillimetre
                );
            }
            (is_shared ? shared : cut) += 1;
        }
    }
    EXPECT_GT(shared, 20U);
    EXPECT_GT(cut, 20U);
}

TEST(TextureCoordinates, OfOnePlaneAreOnePicture) {
    const Houses houses;
    const auto corners = corners_of(triangles_of(make_scene(*houses.reading, houses.surface)));
    std::size_t pairs = 0;
    for (const Corner& a : corners) {
        for (const Corner& b : corners) {
            if (is_in_plane_of(a, b)) {
                EXPECT_NEAR((a.at - b.at).norm(), (a.place - b.place).norm(), kMillimetre);
                ++pairs;
            }
        }
    }
    EXPECT_GT(pairs, 10 * corners.size());
}

}  // namespace
}  // namespace modelsynth::continuous
