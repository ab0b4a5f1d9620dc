#include "solver/continuous/planes/arrangement.h"

#include "solver/continuous/planes/line_walks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

// How many vertices are dealt with between two looks at the stop token.
constexpr std::size_t kStopInterval = 4096;

// The vertices in the order of heaps, on each by name.
struct NamedVertices {
    struct Vertex {
        VertexKey key = 0;
        std::uint32_t meeting = 0;  // one of it
    };

    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> of_meeting;  // which vertex it is
};

// Meetings are put on heaps by name before they are sorted; equal names come on one. What is sorted
// is short each time, so that a stop is seen soon.
constexpr std::size_t kHeaps = 1024;

std::size_t heap_of(VertexKey key) { return key * 0x9E37'79B9'7F4A'7C15 >> 54; }

// The meetings of one name are one vertex.
Result<NamedVertices> name_vertices(
    std::span<const LineWalks::Meeting> meetings, const std::stop_token& stop
) {
    std::vector<std::pair<VertexKey, std::uint32_t>> by_key(meetings.size());
    std::array<std::uint32_t, kHeaps + 1> heap_end = {};
    for (const LineWalks::Meeting& meeting : meetings) {
        ++heap_end[heap_of(meeting.key) + 1];
    }
    std::partial_sum(heap_end.begin(), heap_end.end(), heap_end.begin());
    for (std::uint32_t i = 0; i < by_key.size(); ++i) {
        by_key[heap_end[heap_of(meetings[i].key)]++] = {meetings[i].key, i};
    }
    NamedVertices named;
    named.of_meeting.resize(by_key.size());
    for (std::size_t heap = 0; heap < kHeaps; ++heap) {
        if (stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        const std::size_t begin = heap == 0 ? 0 : heap_end[heap - 1];
        const std::size_t end = heap_end[heap];
        std::sort(
            by_key.begin() + static_cast<std::ptrdiff_t>(begin),
            by_key.begin() + static_cast<std::ptrdiff_t>(end)
        );
        for (std::size_t i = begin; i < end; ++i) {
            if (i == begin || by_key[i].first != by_key[i - 1].first) {
                named.vertices.push_back({by_key[i].first, by_key[i].second});
            }
            named.of_meeting[by_key[i].second] =
                static_cast<std::uint32_t>(named.vertices.size() - 1);
        }
    }
    return named;
}

std::int32_t cell_of(double coordinate, double cell, std::int32_t cells) {
    const double at = std::floor(coordinate / cell + 1e-7);
    return std::clamp(static_cast<std::int32_t>(at), 0, cells - 1);
}

std::size_t cell_of(const Point& place, const Arrangement::Frame& frame) {
    return frame.cells.index(
        {cell_of(place.x(), frame.cell, frame.cells.x),
         cell_of(place.y(), frame.cell, frame.cells.y),
         cell_of(place.z(), frame.cell, frame.cells.z)}
    );
}

// The vertices by cell, then by name.
struct CellOrder {
    std::vector<std::uint32_t> vertices;
    std::vector<Site> first_in_cell;
};

// `places`: of the vertices.
Result<CellOrder> order_by_cell(
    const NamedVertices& named,
    std::span<const Point> places,
    const Arrangement::Frame& frame,
    const std::stop_token& stop
) {
    CellOrder order;
    order.first_in_cell.assign(frame.cells.cell_count() + 1, 0);
    for (const Point& place : places) {
        ++order.first_in_cell[cell_of(place, frame) + 1];
    }
    std::partial_sum(
        order.first_in_cell.begin(), order.first_in_cell.end(), order.first_in_cell.begin()
    );
    order.vertices.resize(places.size());
    std::vector<Site> next_in_cell(order.first_in_cell.begin(), order.first_in_cell.end() - 1);
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        order.vertices[next_in_cell[cell_of(places[i], frame)]++] = i;
    }
    for (std::size_t cell = 0; cell + 1 < order.first_in_cell.size(); ++cell) {
        if (cell % kStopInterval == 0 && stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        std::sort(
            order.vertices.begin() + order.first_in_cell[cell],
            order.vertices.begin() + order.first_in_cell[cell + 1],
            [&](std::uint32_t x, std::uint32_t y) {
                return named.vertices[x].key < named.vertices[y].key;
            }
        );
    }
    return order;
}

// The edges of each vertex, from first_edge[vertex] on, by heading.
struct EdgeLists {
    std::vector<std::uint32_t> first_edge;
    std::vector<ArrangementEdge> edges;
};

// `number`: of the vertex of each meeting.
Result<EdgeLists> list_edges(
    std::span<const LineWalks::Walk> walks,
    std::span<const Site> number,
    std::size_t vertex_count,
    const std::stop_token& stop
) {
    const auto visit_ends = [&](auto visit) {
        for (std::size_t w = 0; w + 1 < walks.size(); ++w) {
            Site before = kNoSite;
            for (std::uint32_t i = walks[w].first; i < walks[w + 1].first; ++i) {
                const Site here = number[i];
                visit(here, opposite(walks[w].heading), before);
                if (before != kNoSite) {
                    visit(before, walks[w].heading, here);
                }
                before = here;
            }
            visit(before, walks[w].heading, kNoSite);
        }
    };
    EdgeLists lists;
    lists.first_edge.assign(vertex_count + 2, 0);
    visit_ends([&](Site at, Heading, Site) { ++lists.first_edge[at + 2]; });
    std::partial_sum(lists.first_edge.begin(), lists.first_edge.end(), lists.first_edge.begin());
    lists.edges.resize(lists.first_edge.back());
    if (stop.stop_requested()) {
        return tl::unexpected(cancelled());
    }
    visit_ends([&](Site at, Heading heading, Site end) {
        lists.edges[lists.first_edge[at + 1]++] = {heading, end};
    });
    lists.first_edge.pop_back();
    for (std::size_t i = 0; i < vertex_count; ++i) {
        if (i % kStopInterval == 0 && stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        std::sort(
            lists.edges.begin() + lists.first_edge[i],
            lists.edges.begin() + lists.first_edge[i + 1],
            [](const ArrangementEdge& x, const ArrangementEdge& y) { return x.heading < y.heading; }
        );
    }
    return lists;
}

}  // namespace

std::size_t Arrangement::plane_through(Site vertex, std::size_t family) const {
    const PlaneOffsets& offsets = planes_[family];
    const double offset = topes_->normals()[family].dot(positions_[vertex]);
    const auto above = std::lower_bound(offsets.begin(), offsets.end(), offset);
    if (above == offsets.end()) {
        return offsets.size() - 1;
    }
    const auto number = static_cast<std::size_t>(above - offsets.begin());
    const bool is_below = number > 0 && offset - offsets[number - 1] < *above - offset;
    return is_below ? number - 1 : number;
}

double Arrangement::least_distance() const {
    double least = frame_.cell;
    for (const PlaneOffsets& offsets : planes_) {
        for (std::size_t i = 1; i < offsets.size(); ++i) {
            least = std::min(least, offsets[i] - offsets[i - 1]);
        }
    }
    return least;
}

Result<Arrangement> Arrangement::make(
    const Topes& topes,
    std::span<const PlaneOffsets> planes,
    const Frame& frame,
    std::size_t vertices_max,
    const std::stop_token& stop
) {
    for (const PlaneOffsets& offsets : planes) {
        if (offsets.size() > kPlanesMax) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "more than " + std::to_string(kPlanesMax) + " planes of one direction",
                {}});
        }
    }
    const auto lines = walk_lines(topes, planes, frame.box, vertices_max, stop);
    if (!lines) {
        return tl::unexpected(lines.error());
    }
    const auto named = name_vertices(lines->meetings, stop);
    if (!named) {
        return tl::unexpected(named.error());
    }
    const std::size_t count = named->vertices.size();
    if (count > vertices_max) {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "the planes of the model meet in " + std::to_string(count) + " points, more than " +
                std::to_string(vertices_max) + "; a wider spacing or a smaller size helps"});
    }
    std::vector<Point> places;
    places.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (i % kStopInterval == 0 && stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        places.push_back(place_of(named->vertices[i].key, topes, planes));
    }
    auto order = order_by_cell(*named, places, frame, stop);
    if (!order) {
        return tl::unexpected(order.error());
    }

    Arrangement made;
    made.topes_ = &topes;
    made.frame_ = frame;
    made.planes_.assign(planes.begin(), planes.end());
    made.first_in_cell_ = std::move(order->first_in_cell);
    made.positions_.reserve(count);
    made.families_.reserve(count);
    std::vector<Site> number(count);
    for (const std::uint32_t vertex : order->vertices) {
        number[vertex] = static_cast<Site>(made.positions_.size());
        made.positions_.push_back(places[vertex]);
        made.families_.push_back(lines->meetings[named->vertices[vertex].meeting].families);
    }
    std::vector<Site> of_meeting;
    of_meeting.reserve(named->of_meeting.size());
    for (const std::uint32_t vertex : named->of_meeting) {
        of_meeting.push_back(number[vertex]);
    }
    auto lists = list_edges(lines->walks, of_meeting, count, stop);
    if (!lists) {
        return tl::unexpected(lists.error());
    }
    made.first_edge_ = std::move(lists->first_edge);
    made.edges_ = std::move(lists->edges);
    return made;
}

}  // namespace modelsynth::continuous
