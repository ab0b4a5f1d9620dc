#include "solver/core/grid_topology.h"

#include "solver/core/result.h"

#include <limits>

namespace modelsynth {

namespace {

std::int32_t extent(const GridSize& size, std::size_t axis) {
    return axis == 0 ? size.x : axis == 1 ? size.y : size.z;
}

std::int32_t along(const Cell& cell, std::size_t axis) {
    return axis == 0 ? cell.x : axis == 1 ? cell.y : cell.z;
}

std::int32_t& along(Cell& cell, std::size_t axis) {
    return axis == 0 ? cell.x : axis == 1 ? cell.y : cell.z;
}

bool is_periodic(const Periodic& periodic, std::size_t axis) {
    return axis == 0 ? periodic.x : axis == 1 ? periodic.y : periodic.z;
}

// An axis of the part is closed only when the part spans the whole of a closed axis.
Periodic inner_periodic(const GridSize& size, const Periodic& periodic, const Box& box) {
    const GridSize inner = box.size();
    return {
        periodic.x && inner.x == size.x,
        periodic.y && inner.y == size.y,
        periodic.z && inner.z == size.z};
}

bool lies_inside(const GridSize& size, const Box& box) {
    return size.contains(box.min) && box.max.x > box.min.x && box.max.y > box.min.y &&
           box.max.z > box.min.z && box.max.x <= size.x && box.max.y <= size.y &&
           box.max.z <= size.z;
}

// The layer of the box's cells on the side of the direction.
Box face_of(Box box, std::size_t direction) {
    const std::size_t axis = direction / 2;
    if (direction % 2 == 0) {
        along(box.min, axis) = along(box.max, axis) - 1;
    } else {
        along(box.max, axis) = along(box.min, axis) + 1;
    }
    return box;
}

}  // namespace

GridTopology::GridTopology(const GridSize& size, Periodic periodic) : size_(size) {
    check(size.x > 0 && size.y > 0 && size.z > 0, "a grid without cells");
    check(size.cell_count() < std::numeric_limits<Site>::max(), "more cells than site numbers");
    const std::array<std::int64_t, 3> strides = {
        1, std::int64_t{size.x} * size.z, std::int64_t{size.x}};
    for (std::size_t direction = 0; direction < kDirectionCount; ++direction) {
        const std::size_t axis = direction / 2;
        const std::int64_t sign = direction % 2 == 0 ? 1 : -1;
        steps_[direction] = sign * strides[axis];
        wrapped_steps_[direction] = -sign * strides[axis] * (extent(size, axis) - 1);
    }
    arcs_.assign(site_count(), kInside);
    if (periodic.x || periodic.y || periodic.z) {
        wraps_.resize(site_count());
    }
    for (std::size_t direction = 0; direction < kDirectionCount; ++direction) {
        const auto bit = static_cast<std::uint8_t>(1U << direction);
        for_each_cell(face_of(Box::whole(size), direction), [&](const Cell& cell) {
            const std::size_t site = size.index(cell);
            arcs_[site] &= kAllArcs;  // no longer inside
            if (is_periodic(periodic, direction / 2)) {
                wraps_[site] |= bit;
            } else {
                arcs_[site] &= static_cast<std::uint8_t>(~bit);
            }
        });
    }
}

GridPart::GridPart(const GridSize& size, Periodic periodic, const Box& box)
    : size_(size),
      periodic_(periodic),
      box_(box),
      inner_(box.size(), inner_periodic(size, periodic, box)) {
    check(lies_inside(size, box), "a block outside the grid");
}

void GridPart::move_to(const Box& box) {
    check(lies_inside(size_, box), "a block outside the grid");
    if (box.size() != box_.size()) {
        inner_ = GridTopology(box.size(), inner_periodic(size_, periodic_, box));
    }
    box_ = box;
}

Box GridPart::face(std::size_t direction) const { return face_of(box_, direction); }

Box GridPart::half_face(std::size_t group) const {
    Box half = face(group / 2);
    const bool is_second = group % 2 != 0;
    const auto halve = [is_second](std::int32_t& min, std::int32_t& max) {
        (is_second ? min : max) = min + (max - min) / 2;
    };
    const bool is_along_z = group / 2 / 2 == 0;
    if (is_along_z) {
        halve(half.min.z, half.max.z);
    } else {
        halve(half.min.x, half.max.x);
    }
    return half;
}

bool GridPart::has_outside(std::size_t direction, Cell& offset) const {
    const std::size_t axis = direction / 2;
    const bool positive = direction % 2 == 0;
    const bool at_edge =
        positive ? along(box_.max, axis) == extent(size_, axis) : along(box_.min, axis) == 0;
    offset = kDirectionSteps[direction];
    if (!at_edge) {
        return true;
    }
    const bool spans_axis = extent(box_.size(), axis) == extent(size_, axis);
    if (!is_periodic(periodic_, axis) || spans_axis) {
        return false;
    }
    along(offset, axis) = positive ? 1 - extent(size_, axis) : extent(size_, axis) - 1;
    return true;
}

}  // namespace modelsynth
