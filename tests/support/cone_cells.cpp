#include "tests/support/cone_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace modelsynth::testing {

namespace {

constexpr double kSameNormal = 2e-5;
constexpr double kParallel = 1e-6;

// Directions in which some planes around a line and the sectors between them go from it.
std::vector<Point> sector_middles(const Point& line, const std::vector<Point>& normals) {
    const Point right = line.unitOrthogonal();
    const Point up = line.cross(right);
    std::vector<double> angles;
    for (const Point& normal : normals) {
        const double angle = std::atan2(normal.dot(up), normal.dot(right));
        angles.push_back(std::remainder(angle + std::numbers::pi / 2, 2 * std::numbers::pi));
        angles.push_back(std::remainder(angle - std::numbers::pi / 2, 2 * std::numbers::pi));
    }
    std::sort(angles.begin(), angles.end());
    angles.push_back(angles.front() + 2 * std::numbers::pi);
    std::vector<Point> middles;
    for (std::size_t i = 1; i < angles.size(); ++i) {
        const double middle = (angles[i - 1] + angles[i]) / 2;
        middles.emplace_back(std::cos(middle) * right + std::sin(middle) * up);
    }
    return middles;
}

}  // namespace

ConeCells::ConeCells(const std::vector<Point>& normals) {
    for (const Point& normal : normals) {
        if (!find(normal)) {
            normals_.push_back(normal);
        }
    }
    // The lines along which planes meet, both ways; every cell has some of them on its border, and
    // a mean of these is inside of it. The weights are uneven lest directions have something in
    // common.
    std::mt19937_64 random(1);
    std::map<std::uint64_t, Point> sums;
    std::vector<Point> seen;
    for (std::size_t a = 0; a < normals_.size(); ++a) {
        for (std::size_t b = a + 1; b < normals_.size(); ++b) {
            const Point line = normals_[a].cross(normals_[b]).normalized();
            const bool is_known = std::any_of(seen.begin(), seen.end(), [&](const Point& other) {
                return other.cross(line).norm() < kParallel;
            });
            if (is_known) {
                continue;
            }
            seen.push_back(line);
            std::vector<Point> around;
            std::uint64_t far = 0;  // sides of the line itself, of the planes not along it
            std::uint64_t along = 0;
            for (std::size_t i = 0; i < normals_.size(); ++i) {
                const double slope = normals_[i].dot(line);
                if (std::abs(slope) < kParallel || i == a || i == b) {
                    around.push_back(normals_[i]);
                    along |= std::uint64_t{1} << i;
                } else {
                    far |= std::uint64_t{slope > 0} << i;
                }
            }
            expected_count_ += 2 * (around.size() - 1);
            for (const Point& sideways : sector_middles(line, around)) {
                const std::uint64_t near = sides_of(sideways) & along;
                const auto weight = [&] { return 1 + static_cast<double>(random() % 1000) / 2000; };
                sums.try_emplace(near | far, Point::Zero()).first->second += weight() * line;
                const std::uint64_t opposite =
                    ~far & ~along & ((std::uint64_t{1} << normals_.size()) - 1);
                sums.try_emplace(near | opposite, Point::Zero()).first->second -= weight() * line;
            }
        }
    }
    for (const auto& [sides, sum] : sums) {
        cells_.push_back({sides, sum.normalized()});
    }
}

std::optional<std::size_t> ConeCells::find(const Point& normal) const {
    for (std::size_t i = 0; i < normals_.size(); ++i) {
        if (normals_[i].cross(normal).norm() < kSameNormal) {
            return i;
        }
    }
    return std::nullopt;
}

std::uint64_t ConeCells::sides_of(const Point& direction) const {
    std::uint64_t sides = 0;
    for (std::size_t i = 0; i < normals_.size(); ++i) {
        sides |= std::uint64_t{normals_[i].dot(direction) > 0} << i;
    }
    return sides;
}

}  // namespace modelsynth::testing
