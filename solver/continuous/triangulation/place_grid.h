#pragma once

#include "solver/continuous/triangulation/rings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth::continuous::rings {

// The places by cells of a grid, to find those in a box. Keeps a reference to the points.
class PlaceGrid {
  public:
    explicit PlaceGrid(const std::vector<Point2>& points) : points_(points) {
        min_ = max_ = points.front();
        for (const Point2& point : points) {
            for (const std::size_t axis : {0U, 1U}) {
                min_[axis] = std::min(min_[axis], point[axis]);
                max_[axis] = std::max(max_[axis], point[axis]);
            }
        }
        // About as many cells as points, also if they are all in a row.
        const double width = max_[0] - min_[0];
        const double height = max_[1] - min_[1];
        const auto count = static_cast<double>(points.size());
        cell_size_ = std::max(std::sqrt(width * height / count), std::max(width, height) / count);
        if (cell_size_ == 0) {
            cell_size_ = 1;
        }
        columns_ = 1 + static_cast<std::size_t>(width / cell_size_);
        cells_.resize(columns_ * (1 + static_cast<std::size_t>(height / cell_size_)));
        for (std::uint32_t place = 0; place < points.size(); ++place) {
            cells_[cell_of(points[place])].push_back(place);
        }
    }

    void remove(std::uint32_t place) { std::erase(cells_[cell_of(points_[place])], place); }

    // The first place in the box that has the property, kNone if none has.
    template <class Property>
    [[nodiscard]] std::uint32_t find(Point2 min, Point2 max, const Property& property) const {
        const std::size_t first = cell_of(min);
        const std::size_t last = cell_of(max);
        const std::size_t width = last % columns_ - first % columns_;
        for (std::size_t row = first; row <= last; row += columns_) {
            for (std::size_t cell = row; cell <= row + width; ++cell) {
                for (const std::uint32_t place : cells_[cell]) {
                    const Point2& point = points_[place];
                    if (point[0] >= min[0] && point[0] <= max[0] && point[1] >= min[1] &&
                        point[1] <= max[1] && property(place)) {
                        return place;
                    }
                }
            }
        }
        return kNone;
    }

  private:
    [[nodiscard]] std::size_t index(double coordinate, std::size_t axis) const {
        const double inside = std::clamp(coordinate, min_[axis], max_[axis]);
        return static_cast<std::size_t>((inside - min_[axis]) / cell_size_);
    }

    [[nodiscard]] std::size_t cell_of(const Point2& point) const {
        return index(point[1], 1) * columns_ + index(point[0], 0);
    }

    const std::vector<Point2>& points_;
    Point2 min_ = {};
    Point2 max_ = {};
    double cell_size_ = 1;
    std::size_t columns_ = 1;
    std::vector<std::vector<std::uint32_t>> cells_;
};
}  // namespace modelsynth::continuous::rings
