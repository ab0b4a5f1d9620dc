#include "solver/continuous/import/face_merging.h"

#include "solver/continuous/check/solid_check.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

// The idea: planes are grown from the largest triangles, since the directions of small ones are
// mostly noise, and a triangle is taken for where its corners are and not for its own direction.

namespace modelsynth::continuous {

namespace {

// Triangles that face other ways by more than this are on the other side of something thin.
constexpr double kSameSideCosine = 0.9;

constexpr std::uint32_t kNoRegion = 0xFFFFFFFF;

class Merging {
  public:
    Merging(
        std::span<const Point> points,
        std::span<const Triangle> triangles,
        std::span<const HalfEdge> mates,
        std::span<const std::uint32_t> corners,
        double tolerance
    )
        : points_(points),
          triangles_(triangles),
          mates_(mates),
          corners_(corners),
          tolerance_(tolerance),
          region_(triangles.size(), kNoRegion) {}

    std::vector<MergedFace> merge() {
        std::vector<std::uint32_t> order(triangles_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::vector<double> areas;  // below 0 for those that can only join others
        for (const std::uint32_t triangle : order) {
            areas.push_back(has_height(triangle) ? area_of(triangle).norm() : -1);
        }
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return areas[a] > areas[b];
        });
        std::vector<MergedFace> faces;
        for (const std::uint32_t seed : order) {
            if (region_[seed] == kNoRegion) {
                add_faces(grow(seed), faces);
            }
        }
        std::sort(faces.begin(), faces.end(), [](const MergedFace& a, const MergedFace& b) {
            return a.triangles.front() < b.triangles.front();
        });
        return faces;
    }

  private:
    [[nodiscard]] const Point& corner(std::uint32_t triangle, std::uint32_t i) const {
        return points_[triangles_[triangle][i % 3]];
    }

    [[nodiscard]] Point area_of(std::uint32_t triangle) const {
        const Point& origin = corner(triangle, 0);
        return (corner(triangle, 1) - origin).cross(corner(triangle, 2) - origin) / 2;
    }

    [[nodiscard]] std::uint32_t longest_edge(std::uint32_t triangle) const {
        std::array<double, 3> lengths = {};
        for (std::uint32_t i = 0; i < 3; ++i) {
            lengths[i] = (corner(triangle, i + 1) - corner(triangle, i)).norm();
        }
        return static_cast<std::uint32_t>(
            std::max_element(lengths.begin(), lengths.end()) - lengths.begin()
        );
    }

    [[nodiscard]] bool has_height(std::uint32_t triangle) const {
        const std::uint32_t i = longest_edge(triangle);
        const double base = (corner(triangle, i + 1) - corner(triangle, i)).norm();
        return 2 * area_of(triangle).norm() > tolerance_ * base;
    }

    // The triangles that hang together in one plane with the seed.
    std::vector<std::uint32_t> grow(std::uint32_t seed) {
        std::vector<std::uint32_t> region = {seed};
        region_[seed] = seed;
        if (!has_height(seed)) {
            return region;
        }
        Point area = area_of(seed);
        for (std::size_t done = 0; done < region.size(); ++done) {
            for (std::uint32_t i = 0; i < 3; ++i) {
                const HalfEdge mate = mates_[3 * region[done] + i];
                const std::uint32_t other = mate / 3;
                if (region_[other] != kNoRegion || !joins(mate, seed, area)) {
                    continue;
                }
                region_[other] = seed;
                area += area_of(other);
                region.push_back(other);
            }
        }
        return region;
    }

    // Whether the triangle of a half-edge at the border of a region is in the region's plane.
    [[nodiscard]] bool joins(HalfEdge half, std::uint32_t seed, const Point& area) const {
        const std::uint32_t triangle = half / 3;
        if (!has_height(triangle)) {
            return half % 3 == longest_edge(triangle);
        }
        const Point normal = area.normalized();
        const Point middle = (corner(seed, 0) + corner(seed, 1) + corner(seed, 2)) / 3;
        for (std::uint32_t i = 0; i < 3; ++i) {
            if (std::abs(normal.dot(corner(triangle, i) - middle)) > tolerance_) {
                return false;
            }
        }
        return area_of(triangle).normalized().dot(normal) > kSameSideCosine;
    }

    void add_faces(std::vector<std::uint32_t> region, std::vector<MergedFace>& faces) const {
        if (auto border = region.size() > 1 ? border_of(region) : std::nullopt) {
            std::swap(region.front(), *std::min_element(region.begin(), region.end()));
            faces.push_back({std::move(*border), std::move(region)});
            return;
        }
        for (const std::uint32_t triangle : region) {
            faces.push_back({{3 * triangle, 3 * triangle + 1, 3 * triangle + 2}, {triangle}});
        }
    }

    [[nodiscard]] bool is_inner(HalfEdge half) const {
        return region_[mates_[half] / 3] == region_[half / 3];
    }

    // The one loop around a region, if it is one that passes no corner twice.
    [[nodiscard]] std::optional<std::vector<HalfEdge>> border_of(
        const std::vector<std::uint32_t>& region
    ) const {
        std::vector<HalfEdge> edges;
        for (const std::uint32_t triangle : region) {
            for (HalfEdge half = 3 * triangle; half < 3 * triangle + 3; ++half) {
                if (!is_inner(half)) {
                    edges.push_back(half);
                }
            }
        }
        if (edges.size() < 3 || edges.size() > kCornersOfFaceMax) {
            return std::nullopt;
        }
        const HalfEdge begin = *std::min_element(edges.begin(), edges.end());
        std::vector<HalfEdge> border;
        std::set<std::uint32_t> passed;
        HalfEdge half = begin;
        do {
            if (!passed.insert(corners_[half]).second) {
                return std::nullopt;
            }
            border.push_back(half);
            half = next_in_triangle(half);
            while (is_inner(half)) {
                half = next_in_triangle(mates_[half]);
            }
        } while (half != begin);
        if (border.size() != edges.size() || !is_flat(region, border)) {
            return std::nullopt;
        }
        return border;
    }

    // Noise may have turned the plane while it grew.
    [[nodiscard]] bool is_flat(
        const std::vector<std::uint32_t>& region, const std::vector<HalfEdge>& border
    ) const {
        Point area = Point::Zero();
        for (const std::uint32_t triangle : region) {
            area += area_of(triangle);
        }
        const Point normal = area.normalized();
        double offset = 0;
        for (const HalfEdge half : border) {
            offset += normal.dot(corner(half / 3, half % 3)) / static_cast<double>(border.size());
        }
        return std::all_of(border.begin(), border.end(), [&](HalfEdge half) {
            return std::abs(normal.dot(corner(half / 3, half % 3)) - offset) <= 2 * tolerance_;
        });
    }

    std::span<const Point> points_;
    std::span<const Triangle> triangles_;
    std::span<const HalfEdge> mates_;
    std::span<const std::uint32_t> corners_;
    double tolerance_;
    std::vector<std::uint32_t> region_;  // by its seed
};

}  // namespace

std::vector<MergedFace> merge_faces(
    std::span<const Point> points,
    std::span<const Triangle> triangles,
    std::span<const HalfEdge> mates,
    std::span<const std::uint32_t> corners,
    double tolerance
) {
    return Merging(points, triangles, mates, corners, tolerance).merge();
}

}  // namespace modelsynth::continuous
