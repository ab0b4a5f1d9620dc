#pragma once

#include "solver/continuous/planes/plane_offsets.h"
#include "solver/continuous/reading/topes.h"
#include "solver/core/grid.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

// An edge of the arrangement seen from one of its ends.
struct ArrangementEdge {
    Heading heading = 0;
    Site end = 0;  // the vertex at its other end; kNoSite where it leaves the box
};

// Where planes of several families meet inside a box: the sites of continuous model synthesis
// (thesis 4.5.4), and the edges between them. There are no sites for edges: an edge's figure is
// what both its ends look at along it, so that two vertices fit when these are equal.
//
// Vertices stand by the cell of a grid that they lie in, cells in the order of flat arrays, so that
// those of a part of the model lie together. A vertex on a wall between cells belongs to the upper
// one.
// Cost: 44 bytes a vertex and 8 an edge's end; O(planes^3) time. Thread-safe.
class Arrangement {
  public:
    struct Frame {
        Bounds box;       // the planes are cut to what is strictly inside
        GridSize cells;   // the grid starts at the origin
        double cell = 1;  // metres
    };

    // Requires: `topes` outlives it.
    // Fails: kTooLarge when there would be more vertices than vertices_max; kInvalidArgument where
    // it cannot be said whether planes meet in one point; kCancelled when `stop` is requested.
    [[nodiscard]] static Result<Arrangement> make(
        const Topes& topes,
        std::span<const PlaneOffsets> planes,
        const Frame& frame,
        std::size_t vertices_max,
        const std::stop_token& stop = {}
    );

    [[nodiscard]] std::size_t vertex_count() const { return positions_.size(); }

    [[nodiscard]] const Point& position(Site vertex) const { return positions_[vertex]; }

    // Of which a plane passes through the vertex.
    [[nodiscard]] FamilySet families(Site vertex) const { return families_[vertex]; }

    [[nodiscard]] std::span<const ArrangementEdge> edges(Site vertex) const {
        return {edges_.data() + first_edge_[vertex], first_edge_[vertex + 1] - first_edge_[vertex]};
    }

    // The planes of a family, by number.
    [[nodiscard]] const PlaneOffsets& planes(std::size_t family) const { return planes_[family]; }

    // The number of the family's plane that passes through the vertex. Requires: one does.
    [[nodiscard]] std::size_t plane_through(Site vertex, std::size_t family) const;

    // Of two parallel planes, but at most a cell.
    [[nodiscard]] double least_distance() const;

    [[nodiscard]] const Frame& frame() const { return frame_; }

    // Vertices in a run of cells: first_in(i) ... first_in(j) - 1 lie in the cells i ... j - 1.
    [[nodiscard]] Site first_in(std::size_t cell) const { return first_in_cell_[cell]; }

    // Calls visit(Site) for the vertices of a box of cells, in rising order.
    template <class Visit>
    void for_each_vertex(const Box& box, Visit visit) const {
        for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
            for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
                const std::size_t row = frame_.cells.index({box.min.x, y, z});
                const auto length = static_cast<std::size_t>(box.max.x - box.min.x);
                for (Site site = first_in(row); site < first_in(row + length); ++site) {
                    visit(site);
                }
            }
        }
    }

    [[nodiscard]] const Topes& topes() const { return *topes_; }

  private:
    Arrangement() = default;

    const Topes* topes_ = nullptr;
    Frame frame_;
    std::vector<PlaneOffsets> planes_;
    std::vector<Point> positions_;
    std::vector<FamilySet> families_;
    std::vector<std::uint32_t> first_edge_;
    std::vector<ArrangementEdge> edges_;
    std::vector<Site> first_in_cell_;
};

}  // namespace modelsynth::continuous
