#include "solver/continuous/reading/nudge.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr int kLargest = 8;     // of the integers
constexpr double kSame = 1e-6;  // radians: no turn at all
constexpr double kDensest = 2;  // planes of a family a step, about
constexpr int kPeriodMax = 4;   // steps from one point of the lattice that counts to the next

using Integers = std::array<int, 3>;

Point normal_from(const Integers& numbers, const std::array<double, 3>& steps) {
    Point normal;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        normal[static_cast<Eigen::Index>(axis)] = numbers[axis] / steps[axis];
    }
    return normal;
}

double angle_between(const Point& a, const Point& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Of the smallest that are near enough the nearest.
std::optional<Integers> find_integers(
    const Point& normal, const std::array<double, 3>& steps, double radians
) {
    for (int largest = 1; largest <= kLargest; ++largest) {
        std::optional<Integers> best;
        double least = radians;
        for (int x = -largest; x <= largest; ++x) {
            for (int y = -largest; y <= largest; ++y) {
                for (int z = -largest; z <= largest; ++z) {
                    const Integers numbers = {x, y, z};
                    if (std::gcd(std::gcd(x, y), z) != 1) {
                        continue;
                    }
                    const double angle = angle_between(normal_from(numbers, steps), normal);
                    if (angle <= least) {
                        least = angle;
                        best = numbers;
                    }
                }
            }
        }
        if (best) {
            return best;
        }
    }
    return std::nullopt;
}

// The cells, and along which lines which families meet.
bool are_alike(const Topes& a, const Topes& b) {
    if (a.count() != b.count() || a.lines().size() != b.lines().size()) {
        return false;
    }
    std::set<FamilySet> cells;
    std::set<FamilySet> lines;
    for (std::size_t t = 0; t < a.count(); ++t) {
        cells.insert(a.sides(static_cast<Tope>(t)));
    }
    for (const LineDirection& line : a.lines()) {
        lines.insert(line.families);
    }
    for (std::size_t t = 0; t < b.count(); ++t) {
        if (!cells.contains(b.sides(static_cast<Tope>(t)))) {
            return false;
        }
    }
    return std::all_of(b.lines().begin(), b.lines().end(), [&](const LineDirection& line) {
        return lines.contains(line.families);
    });
}

}  // namespace

std::optional<Nudged> nudge(
    const Topes& topes, const std::array<double, 3>& steps, double degrees
) {
    const double radians = degrees * std::numbers::pi / 180;
    Nudged nudged;
    std::vector<double> lengths;  // of the normals as integers, in 1 / metres
    for (const Point& normal : topes.normals()) {
        const auto numbers = find_integers(normal, steps, std::max(radians, kSame));
        if (!numbers) {
            return std::nullopt;
        }
        const Point near = normal_from(*numbers, steps);
        const double angle = angle_between(near, normal);
        lengths.push_back(near.norm());
        nudged.normals.push_back(angle <= kSame ? normal : near.normalized());
        nudged.largest_degrees =
            std::max(nudged.largest_degrees, angle <= kSame ? 0 : angle * 180 / std::numbers::pi);
    }
    auto turned = Topes::make(nudged.normals);
    if (!turned || !are_alike(topes, *turned)) {
        return std::nullopt;
    }
    const double longest = *std::max_element(lengths.begin(), lengths.end());
    const double step = *std::min_element(steps.begin(), steps.end());
    const double period = std::clamp(std::ceil(longest * step / kDensest), 1.0, double{kPeriodMax});
    for (const double length : lengths) {
        // Planes of few directions, such as walls, keep their step.
        nudged.spacings.push_back((length * step < 1.5 ? 1 : period) / length);
    }
    return nudged;
}

}  // namespace modelsynth::continuous
