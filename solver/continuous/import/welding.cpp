#include "solver/continuous/import/welding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace modelsynth::continuous {

namespace {

using Cell = std::array<std::int64_t, 3>;

// Points kept so far, by cells some tolerances wide. A cell holds few of them, since none are
// close; an ordered map, since no choice of points makes it slow.
class KeptPoints {
  public:
    explicit KeptPoints(double tolerance) : tolerance_(tolerance) {}

    // That of a point close to this one; of several the first in the first cell.
    std::uint32_t number_of(const Point& point) {
        const Cell least = cell_of(point - Point::Constant(tolerance_));
        const Cell greatest = cell_of(point + Point::Constant(tolerance_));
        for (std::int64_t x = least[0]; x <= greatest[0]; ++x) {
            for (std::int64_t y = least[1]; y <= greatest[1]; ++y) {
                for (std::int64_t z = least[2]; z <= greatest[2]; ++z) {
                    if (const auto other = find_in({x, y, z}, point)) {
                        return *other;
                    }
                }
            }
        }
        const auto number = static_cast<std::uint32_t>(points_.size());
        points_.push_back(point);
        cells_[cell_of(point)].push_back(number);
        return number;
    }

    std::vector<Point> take() { return std::move(points_); }

  private:
    [[nodiscard]] std::optional<std::uint32_t> find_in(const Cell& cell, const Point& point) const {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) {
            return std::nullopt;
        }
        for (const std::uint32_t other : found->second) {
            if ((points_[other] - point).norm() <= tolerance_) {
                return other;
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] Cell cell_of(const Point& point) const {
        Cell cell;
        for (int axis = 0; axis < 3; ++axis) {
            cell[static_cast<std::size_t>(axis)] =
                static_cast<std::int64_t>(std::floor(point[axis] / (4 * tolerance_)));
        }
        return cell;
    }

    double tolerance_;
    std::vector<Point> points_;
    std::map<Cell, std::vector<std::uint32_t>> cells_;
};

// The points, each once, of triangles that lie across an axis.
std::vector<std::uint32_t> points_across(
    const std::vector<Point>& points,
    const std::vector<std::uint32_t>& corners,
    int axis,
    double tolerance
) {
    std::vector<bool> is_across(points.size());
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const auto [least, greatest] = std::minmax(
            {points[corners[i]][axis], points[corners[i + 1]][axis], points[corners[i + 2]][axis]}
        );
        if (greatest - least <= tolerance) {
            for (std::size_t c = i; c < i + 3; ++c) {
                is_across[corners[c]] = true;
            }
        }
    }
    std::vector<std::uint32_t> across;
    for (std::uint32_t point = 0; point < is_across.size(); ++point) {
        if (is_across[point]) {
            across.push_back(point);
        }
    }
    return across;
}

// Of places in order within the tolerance of the first, the most frequent; of several the least.
void align(
    std::vector<Point>& points, std::vector<std::uint32_t> order, int axis, double tolerance
) {
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points[a][axis] < points[b][axis];
    });
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
        const double from = points[order[first]][axis];
        double best = from;
        std::size_t best_count = 0;
        std::size_t run = first;
        for (end = first; end < order.size(); ++end) {
            const double value = points[order[end]][axis];
            if (value > from + tolerance) {
                break;
            }
            if (value != points[order[run]][axis]) {
                run = end;
            }
            if (end - run + 1 > best_count) {
                best_count = end - run + 1;
                best = value;
            }
        }
        for (std::size_t i = first; i < end; ++i) {
            points[order[i]][axis] = best;
        }
    }
}

}  // namespace

std::vector<std::uint32_t> weld(std::vector<Point>& points, double tolerance) {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(points.size());
    KeptPoints near(tolerance);
    for (const Point& point : points) {
        numbers.push_back(near.number_of(point));
    }
    points = near.take();
    for (int axis = 0; axis < 3; ++axis) {
        align(points, points_across(points, numbers, axis, tolerance), axis, tolerance);
    }
    // What was close along every axis, though not in space, is now one.
    std::vector<std::uint32_t> aligned;
    KeptPoints kept(tolerance);
    for (const Point& point : points) {
        aligned.push_back(kept.number_of(point));
    }
    points = kept.take();
    for (std::uint32_t& number : numbers) {
        number = aligned[number];
    }
    return numbers;
}

}  // namespace modelsynth::continuous
