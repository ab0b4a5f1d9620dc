#include "solver/continuous/constraints/coverage.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

// The cell of a row of `count` that is stretched over `length`.
std::int32_t cell_at(double place, double length, std::int32_t count) {
    const double cell = std::floor(place / length * count);
    return static_cast<std::int32_t>(std::clamp(cell, 0.0, count - 1.0));
}

bool holds(const MetreBox& box, const Point& place) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        if (place[axis] < box.min[i] || place[axis] > box.max[i]) {
            return false;
        }
    }
    return true;
}

bool meets(const MetreBox& box, const Point& low, const Point& high) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        if (high[axis] < box.min[i] || low[axis] > box.max[i]) {
            return false;
        }
    }
    return true;
}

}  // namespace

void Coverage::Range::add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
}

Coverage::Coverage(const Region& region, const std::array<double, 3>& size)
    : region_(region), size_(size), is_everywhere_(!region.box && !region.mask && !region.voxels) {}

double Coverage::at(const Point& place) const { return range(place, place).most; }

bool Coverage::is_uniform(const Point& place, double reach) const {
    const Point low = place - Point::Constant(reach);
    const Point high = place + Point::Constant(reach);
    if (low.y() < 0 && high.y() >= 0) {
        return false;
    }
    if (region_.box && meets(*region_.box, low, high)) {
        return holds(*region_.box, low) && holds(*region_.box, high);
    }
    const Range values = range(low, high);
    return values.least == values.most;
}

Coverage::Range Coverage::range(const Point& low, const Point& high) const {
    Range range;
    if (high.y() < 0) {
        return {0, 0};
    }
    if (is_everywhere_ || (region_.box && holds(*region_.box, low) && holds(*region_.box, high))) {
        return {1, 1};
    }
    if (region_.box || !(region_.mask || region_.voxels)) {
        range.add(0);
    }
    const auto x_cell = [&](const Point& place, std::int32_t count) {
        return cell_at(place.x(), size_[0], count);
    };
    const auto y_cell = [&](const Point& place, std::int32_t count) {
        return cell_at(place.y(), size_[1], count);
    };
    const auto z_cell = [&](const Point& place, std::int32_t count) {
        return cell_at(place.z(), size_[2], count);
    };
    if (const auto& mask = region_.mask) {
        for (auto z = z_cell(low, mask->depth); z <= z_cell(high, mask->depth); ++z) {
            for (auto x = x_cell(low, mask->width); x <= x_cell(high, mask->width); ++x) {
                const auto i = static_cast<std::size_t>(x) +
                               static_cast<std::size_t>(mask->width) * static_cast<std::size_t>(z);
                range.add(mask->values[i] / 255.0);
            }
        }
    }
    if (const auto& voxels = region_.voxels) {
        const GridSize& size = voxels->size;
        const Box cells = {
            {x_cell(low, size.x), y_cell(low, size.y), z_cell(low, size.z)},
            {x_cell(high, size.x) + 1, y_cell(high, size.y) + 1, z_cell(high, size.z) + 1}};
        for_each_cell(cells, [&](const Cell& cell) {
            range.add(voxels->values[size.index(cell)]);
        });
    }
    return range;
}

}  // namespace modelsynth::continuous
