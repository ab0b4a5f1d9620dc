#pragma once

#include "solver/core/grid.h"
#include "solver/core/topology.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace modelsynth {

// Which axes of a grid close on themselves.
struct Periodic {
    bool x = false;
    bool y = false;
    bool z = false;
};

// The implicit topology of a grid: a site per cell in the order of flat arrays, an arc to each of
// the six neighbours, relations numbered as the directions.
// Cost: one byte a cell. Thread-safe.
class GridTopology {
  public:
    static constexpr std::size_t kRelationCount = kDirectionCount;

    // Requires: every extent positive and fewer than 2^32 cells (checked).
    explicit GridTopology(const GridSize& size, Periodic periodic = {});

    [[nodiscard]] std::size_t site_count() const { return size_.cell_count(); }

    [[nodiscard]] const GridSize& size() const { return size_; }

    // As SteppedTopology asks; arcs across a seam are no steps.
    [[nodiscard]] bool has_steps_only() const { return wraps_.empty(); }

    [[nodiscard]] const std::array<std::int64_t, kDirectionCount>& steps() const { return steps_; }

    [[nodiscard]] const std::uint8_t* arc_masks() const { return arcs_.data(); }

    [[nodiscard]] std::size_t reach() const {
        return static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.z);
    }

    friend bool operator==(const GridTopology& a, const GridTopology& b) {
        return a.size_ == b.size_ && a.wraps_ == b.wraps_;  // the rest follows from these
    }

    template <class Visit>
    void for_each_arc(Site site, Visit visit) const {
        // The hot loop of every search: most cells are inside, with all six neighbours a step away.
        const unsigned arcs = arcs_.data()[site];
        if (arcs == kInside) {
            for (std::size_t direction = 0; direction < kDirectionCount; ++direction) {
                visit(neighbour(site, steps_[direction]), static_cast<RelationId>(direction));
            }
            return;
        }
        const unsigned wraps = wraps_.empty() ? 0 : wraps_.data()[site];
        for (std::size_t direction = 0; direction < kDirectionCount; ++direction) {
            if ((arcs >> direction & 1) != 0) {
                const bool wrapped = (wraps >> direction & 1) != 0;
                const std::int64_t step = (wrapped ? wrapped_steps_ : steps_)[direction];
                visit(neighbour(site, step), static_cast<RelationId>(direction));
            }
        }
    }

  private:
    // All six neighbours, and none of them across a seam.
    static constexpr std::uint8_t kInside = 0xFF;
    static constexpr std::uint8_t kAllArcs = (1U << kDirectionCount) - 1;

    static Site neighbour(Site site, std::int64_t step) {
        return static_cast<Site>(static_cast<std::int64_t>(site) + step);
    }

    GridSize size_;
    std::array<std::int64_t, kDirectionCount> steps_ = {};
    std::array<std::int64_t, kDirectionCount> wrapped_steps_ = {};
    std::vector<std::uint8_t> arcs_;   // bit d: there is a neighbour in direction d; or kInside
    std::vector<std::uint8_t> wraps_;  // bit d: that neighbour is across the seam; empty: nowhere
};

// A box of a grid, as a part of it.
class GridPart {
  public:
    using Inner = GridTopology;
    static constexpr std::size_t kOutwardGroups = 2 * kDirectionCount;

    // Requires: box inside size and not empty (checked).
    GridPart(const GridSize& size, Periodic periodic, const Box& box);

    // As if it were made anew with this box; costs nothing when that has the shape of the last one.
    // Requires: as above.
    void move_to(const Box& box);

    [[nodiscard]] const GridTopology& inner() const { return inner_; }

    [[nodiscard]] Site global(Site site) const {
        const Cell cell = inner_.size().cell(site);
        return static_cast<Site>(
            size_.index({cell.x + box_.min.x, cell.y + box_.min.y, cell.z + box_.min.z})
        );
    }

    template <class Visit>
    void for_each_run(Visit visit) const {
        Site inside = 0;
        for_each_row(box_, [&](const Cell& first, std::size_t count) {
            visit(inside, static_cast<Site>(size_.index(first)), count);
            inside += static_cast<Site>(count);
        });
    }

    template <class Visit>
    void for_each_outward_arc(Visit visit) const {
        for (std::size_t direction = 0; direction < kDirectionCount; ++direction) {
            for_each_arc_through(direction, face(direction), visit);
        }
    }

    // Groups 2d and 2d + 1 are the two halves of the face in direction d: those that lie to the
    // north and south, or, where there are none, to the west and east.
    template <class Visit>
    void for_each_outward_arc(std::size_t group, Visit visit) const {
        for_each_arc_through(group / 2, half_face(group), visit);
    }

  private:
    // The outward arcs of the cells, which lie at that face.
    template <class Visit>
    void for_each_arc_through(std::size_t direction, const Box& cells, Visit visit) const {
        Cell beyond;
        if (!has_outside(direction, beyond)) {
            return;
        }
        for_each_row(cells, [&](const Cell& first, std::size_t count) {
            auto inside = static_cast<Site>(inner_.size().index(
                {first.x - box_.min.x, first.y - box_.min.y, first.z - box_.min.z}
            ));
            auto outside = static_cast<Site>(
                size_.index({first.x + beyond.x, first.y + beyond.y, first.z + beyond.z})
            );
            for (const Site end = inside + static_cast<Site>(count); inside != end;) {
                visit(inside++, outside++, static_cast<RelationId>(direction));
            }
        });
    }

    [[nodiscard]] Box half_face(std::size_t group) const;
    // The layer of the box's cells on the side of the direction.
    [[nodiscard]] Box face(std::size_t direction) const;
    // Whether cells of the whole lie beyond that face, and how far from the face's cells.
    [[nodiscard]] bool has_outside(std::size_t direction, Cell& offset) const;

    GridSize size_;
    Periodic periodic_;
    Box box_;
    GridTopology inner_;
};

}  // namespace modelsynth
