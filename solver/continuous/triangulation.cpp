#include "solver/continuous/triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

// Ears are cut off one by one (Meisters 1975), the best shaped first, after every hole was joined
// to the outer boundary by a bridge, an edge there and back.
//
// Loops that touch make this delicate: at one place there may be several corners. First of all,
// loops are therefore linked anew at such places, so that what is between the two edges of a corner
// is inside and no other edge is there ("facing" corners). A hole that touches the outer boundary
// thereby becomes part of it, and parts that hang together only at a place become rings of their
// own. Bridges and cuts keep this. It follows that other corners at the places of an ear cannot be
// in its way: an edge from there into the triangle would have to leave it across an edge of the
// ring.
//
// An ear has to be strictly convex and may have no other place of the rings in it, nor on its
// border. In exact arithmetic there is always one: a simple polygon with flat corners has a
// triangulation without degenerate triangles, and a cut leaves another such polygon.

namespace modelsynth::continuous {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Twice the signed area of the triangle.
double turn(const Point2& a, const Point2& b, const Point2& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double distance_squared(const Point2& a, const Point2& b) {
    return (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
}

// Where the loops have vertices: points that are the same but for errors are one place.
struct Places {
    double tolerance = 0;
    std::vector<Point2> at;
    std::vector<std::uint32_t> number;  // the smallest of the points there
};

// One pass of a ring through a place. Inside is to the left of the ring.
struct Corner {
    std::uint32_t place = kNone;
    std::uint32_t prev = kNone;  // the corner itself, as is next: no longer in a ring
    std::uint32_t next = kNone;
};

using Corners = std::vector<Corner>;

void link(Corners& corners, std::uint32_t from, std::uint32_t to) {
    corners[from].next = to;
    corners[to].prev = from;
}

double tolerance_for(std::span<const Point2> points, const Loop& vertices) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    Point2 min = {kLargest, kLargest};
    Point2 max = {-kLargest, -kLargest};
    for (const std::uint32_t vertex : vertices) {
        for (const std::size_t axis : {0U, 1U}) {
            min[axis] = std::min(min[axis], points[vertex][axis]);
            max[axis] = std::max(max[axis], points[vertex][axis]);
        }
    }
    const double largest = std::max({1e4, -min[0], -min[1], max[0], max[1]});
    const double extent = std::max(max[0] - min[0], max[1] - min[1]);
    return std::min(1e-12 * largest, 1e-6 * extent);
}

// Of every vertex its place, added to `places` if there is none yet.
std::vector<std::uint32_t> find_places(
    std::span<const Point2> points, const Loop& vertices, Places& places
) {
    std::vector<std::uint32_t> order(vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(points[vertices[a]], a) < std::tie(points[vertices[b]], b);
    });
    std::vector<std::uint32_t> result(vertices.size());
    for (const std::uint32_t i : order) {
        const Point2& point = points[vertices[i]];
        std::size_t place = places.at.size();
        bool is_known = false;
        while (!is_known && place > 0 && point[0] - places.at[place - 1][0] <= places.tolerance) {
            --place;
            is_known = std::abs(point[1] - places.at[place][1]) <= places.tolerance;
        }
        if (!is_known) {
            place = places.at.size();
            places.at.push_back(point);
            places.number.push_back(vertices[i]);
        }
        places.number[place] = std::min(places.number[place], vertices[i]);
        result[i] = static_cast<std::uint32_t>(place);
    }
    return result;
}

// The corners of one loop, linked; a place that follows itself is one corner.
void add_ring(std::span<const std::uint32_t> places, Corners& corners) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] != places[(i + 1) % places.size()]) {
            corners.push_back({places[i], kNone, kNone});
        }
    }
    const auto end = static_cast<std::uint32_t>(corners.size());
    for (std::uint32_t corner = first; corner < end; ++corner) {
        link(corners, corner, corner + 1 < end ? corner + 1 : first);
    }
}

// An edge at a place: the corner from which it leaves, here or at its other end.
struct Spoke {
    double angle = 0;  // grows with the angle, 0 ... 4
    bool leaves = false;
    std::uint32_t corner = kNone;
};

Spoke make_spoke(const Point2& hub, const Point2& end, bool leaves, std::uint32_t corner) {
    const double x = end[0] - hub[0];
    const double y = end[1] - hub[1];
    const double share = x / (std::abs(x) + std::abs(y));
    return {y >= 0 ? 1 - share : 3 + share, leaves, corner};
}

// Links the edges that arrive at a place to those that leave it so that corners face the inside:
// counter-clockwise, an edge that leaves is followed by the one that arrives at the same corner.
// Shape: `spokes` has as many of one kind as of the other.
void link_facing(std::vector<Spoke>& spokes, Corners& corners) {
    std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
        return std::tie(a.angle, a.leaves, a.corner) < std::tie(b.angle, b.leaves, b.corner);
    });
    std::vector<std::uint32_t> open;
    // Once more for what is before the first edge that leaves.
    for (const bool is_first : {true, false}) {
        for (Spoke& spoke : spokes) {
            if (spoke.leaves && is_first) {
                open.push_back(spoke.corner);
            } else if (!spoke.leaves && spoke.corner != kNone && !open.empty()) {
                link(corners, spoke.corner, open.back());
                open.pop_back();
                spoke.corner = kNone;
            }
        }
    }
}

void face_inside(const Places& places, Corners& corners) {
    const Corners before = corners;
    std::vector<std::vector<std::uint32_t>> corners_at(places.at.size());
    for (std::uint32_t corner = 0; corner < corners.size(); ++corner) {
        corners_at[before[corner].place].push_back(corner);
    }
    std::vector<Spoke> spokes;
    for (std::size_t place = 0; place < places.at.size(); ++place) {
        if (corners_at[place].size() < 2) {
            continue;
        }
        spokes.clear();
        const auto add = [&](std::uint32_t other, bool leaves, std::uint32_t corner) {
            const Point2& end = places.at[before[other].place];
            spokes.push_back(make_spoke(places.at[place], end, leaves, corner));
        };
        for (const std::uint32_t corner : corners_at[place]) {
            add(before[corner].next, true, corner);
            add(before[corner].prev, false, before[corner].prev);
        }
        link_facing(spokes, corners);
    }
}

// Joins the holes to the outer boundaries, each from its rightmost place, the hole furthest to the
// right first: to the right of it, there is then always something to join it to.
class Bridges {
  public:
    Bridges(const Places& places, Corners& corners) : places_(places), corners_(corners) {}

    void build() {
        std::vector<std::vector<std::uint32_t>> holes = find_rings();
        std::sort(holes.begin(), holes.end(), [&](const auto& a, const auto& b) {
            return std::tie(at(a.front()), a.front()) > std::tie(at(b.front()), b.front());
        });
        for (std::vector<std::uint32_t>& hole : holes) {
            // Corners at the place of the first: one of them faces the other end of the bridge.
            const std::uint32_t place = corners_[hole.front()].place;
            const auto end = std::partition(hole.begin(), hole.end(), [&](std::uint32_t corner) {
                return corners_[corner].place == place;
            });
            join(hole, static_cast<std::size_t>(end - hole.begin()));
        }
    }

  private:
    struct Bridge {
        std::uint32_t from = kNone;
        std::uint32_t to = kNone;
    };

    [[nodiscard]] const Point2& at(std::uint32_t corner) const {
        return places_.at[corners_[corner].place];
    }

    // Corners of outer boundaries go to joined_, holes are returned, their rightmost corner first.
    std::vector<std::vector<std::uint32_t>> find_rings() {
        std::vector<std::vector<std::uint32_t>> holes;
        std::vector<bool> is_seen(corners_.size());
        for (std::uint32_t first = 0; first < corners_.size(); ++first) {
            std::vector<std::uint32_t> ring;
            double area = 0;
            for (std::uint32_t c = first; !is_seen[c]; c = corners_[c].next) {
                is_seen[c] = true;
                ring.push_back(c);
                area += turn(at(first), at(c), at(corners_[c].next));
            }
            if (area > 0) {
                joined_.insert(joined_.end(), ring.begin(), ring.end());
            } else if (!ring.empty()) {
                const auto rightmost = std::max_element(
                    ring.begin(), ring.end(), [&](auto a, auto b) { return at(a) < at(b); }
                );
                std::iter_swap(ring.begin(), rightmost);
                holes.push_back(std::move(ring));
            }
        }
        return holes;
    }

    // The first `start_count` corners of the hole are where the bridge may begin.
    void join(const std::vector<std::uint32_t>& hole, std::size_t start_count) {
        const Bridge bridge = find_bridge(std::span(hole).first(start_count));
        if (bridge.to == kNone) {
            for (const std::uint32_t corner : hole) {
                link(corners_, corner, corner);
            }
            return;
        }
        const auto from = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(corners_[bridge.from]);
        corners_.push_back(corners_[bridge.to]);
        const std::uint32_t to = from + 1;
        link(corners_, corners_[bridge.from].prev, from);
        link(corners_, from, to);
        link(corners_, to, corners_[bridge.to].next);
        link(corners_, bridge.to, bridge.from);
        joined_.insert(joined_.end(), hole.begin(), hole.end());
        joined_.insert(joined_.end(), {from, to});
    }

    // The shortest one that is clear; for want of one, the shortest.
    Bridge find_bridge(std::span<const std::uint32_t> starts) {
        std::vector<std::pair<double, std::uint32_t>> candidates;
        candidates.reserve(joined_.size());
        for (const std::uint32_t corner : joined_) {
            candidates.emplace_back(distance_squared(at(starts.front()), at(corner)), corner);
        }
        std::make_heap(candidates.begin(), candidates.end(), std::greater<>());
        Bridge shortest;
        for (auto end = candidates.end(); end != candidates.begin(); --end) {
            std::pop_heap(candidates.begin(), end, std::greater<>());
            Bridge bridge;
            bridge.to = std::prev(end)->second;
            const Point2& target = at(bridge.to);
            const auto start = std::find_if(starts.begin(), starts.end(), [&](auto corner) {
                return faces(corner, target);
            });
            if (start == starts.end() || !faces(bridge.to, at(*start))) {
                continue;
            }
            bridge.from = *start;
            if (is_clear(bridge)) {
                return bridge;
            }
            if (shortest.to == kNone) {
                shortest = bridge;
            }
        }
        return shortest;
    }

    // Whether the way from the corner to the target begins between the edges of the corner.
    [[nodiscard]] bool faces(std::uint32_t corner, const Point2& target) const {
        const Point2& hub = at(corner);
        const Point2& next = at(corners_[corner].next);
        const Point2& prev = at(corners_[corner].prev);
        if (target == hub) {
            return false;
        }
        if (next == prev) {
            return true;
        }
        if (turn(hub, next, prev) > 0) {
            return turn(hub, next, target) > 0 && turn(hub, target, prev) > 0;
        }
        return turn(hub, prev, target) < 0 || turn(hub, target, next) < 0;
    }

    [[nodiscard]] bool is_clear(const Bridge& bridge) {
        // What was in the way of one bridge often is in that of the next one tried.
        if (is_in_the_way(in_the_way_, bridge)) {
            return false;
        }
        for (std::uint32_t corner = 0; corner < corners_.size(); ++corner) {
            if (is_in_the_way(corner, bridge)) {
                in_the_way_ = corner;
                return false;
            }
        }
        return true;
    }

    // Whether the bridge passes the corner or crosses the edge from there.
    [[nodiscard]] bool is_in_the_way(std::uint32_t corner, const Bridge& bridge) const {
        const Point2& a = at(bridge.from);
        const Point2& b = at(bridge.to);
        const Point2& c = at(corner);
        const Point2& d = at(corners_[corner].next);
        for (const std::size_t axis : {0U, 1U}) {
            if (std::max(a[axis], b[axis]) + places_.tolerance < std::min(c[axis], d[axis]) ||
                std::max(c[axis], d[axis]) + places_.tolerance < std::min(a[axis], b[axis])) {
                return false;
            }
        }
        if (c == a || c == b) {
            return false;
        }
        const double side_c = turn(a, b, c);
        const double length_squared = distance_squared(a, b);
        if (std::abs(side_c) <= places_.tolerance * std::sqrt(length_squared)) {
            const double along = (b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1]);
            return along > 0 && along < length_squared;
        }
        return d != a && d != b && (side_c > 0) != (turn(a, b, d) > 0) &&
               (turn(c, d, a) > 0) != (turn(c, d, b) > 0);
    }

    const Places& places_;
    Corners& corners_;
    std::vector<std::uint32_t> joined_;
    std::uint32_t in_the_way_ = 0;
};

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

// The triangle that a cut at a corner would give.
struct Ear {
    std::array<std::uint32_t, 3> places = {};
    std::array<Point2, 3> points = {};
    std::array<double, 3> lengths = {};  // of the edge from the point of that number
    double area = 0;                     // twice, signed

    [[nodiscard]] double height() const {
        return area / *std::max_element(lengths.begin(), lengths.end());
    }

    // Largest for equilateral triangles.
    [[nodiscard]] double shape() const {
        return area / (lengths[0] * lengths[0] + lengths[1] * lengths[1] + lengths[2] * lengths[2]);
    }

    // How far inside the edges a point is; negative if it is outside.
    [[nodiscard]] double depth(const Point2& point) const {
        return std::min(
            {turn(points[0], points[1], point) / lengths[0],
             turn(points[1], points[2], point) / lengths[1],
             turn(points[2], points[0], point) / lengths[2]}
        );
    }

    // The first place near the ear that is none of its own and has the property.
    template <class Property>
    [[nodiscard]] std::uint32_t find(const PlaceGrid& grid, double margin, const Property& property)
        const {
        const auto [min_x, max_x] = std::minmax({points[0][0], points[1][0], points[2][0]});
        const auto [min_y, max_y] = std::minmax({points[0][1], points[1][1], points[2][1]});
        return grid.find(
            {min_x - margin, min_y - margin},
            {max_x + margin, max_y + margin},
            [&](std::uint32_t place) {
                return place != places[0] && place != places[1] && place != places[2] &&
                       property(place);
            }
        );
    }
};

// A corner waits for the place in its ear to leave the rings: while it is there, the ear need not
// be looked at. Places only ever leave, so an ear stays one until a neighbour is cut.
class EarCutter {
  public:
    EarCutter(const Places& places, Corners& corners)
        : places_(places),
          corners_(corners),
          grid_(places.at),
          corner_counts_(places.at.size()),
          waiting_(places.at.size()),
          versions_(corners.size()) {}

    std::vector<std::array<std::uint32_t, 3>> cut_all() {
        for (std::uint32_t corner = 0; corner < corners_.size(); ++corner) {
            if (is_left(corner)) {
                ++corner_counts_[corners_[corner].place];
                ++left_count_;
            }
        }
        for (std::uint32_t place = 0; place < corner_counts_.size(); ++place) {
            if (corner_counts_[place] == 0) {
                grid_.remove(place);
            }
        }
        for (std::uint32_t corner = 0; corner < corners_.size(); ++corner) {
            if (is_left(corner)) {
                examine(corner);
            }
        }
        while (left_count_ > 0) {
            cut(choose());
        }
        return std::move(triangles_);
    }

  private:
    // A corner as it was when its version was this one.
    struct Visit {
        std::uint32_t corner = kNone;
        std::uint32_t version = 0;

        friend auto operator<=>(const Visit&, const Visit&) = default;
    };

    [[nodiscard]] bool is_left(std::uint32_t corner) const {
        return corners_[corner].next != corner;
    }

    [[nodiscard]] std::uint32_t place_of(std::uint32_t corner) const {
        return corners_[corner].place;
    }

    [[nodiscard]] Ear ear_at(std::uint32_t corner) const {
        Ear ear;
        ear.places = {
            place_of(corners_[corner].prev), place_of(corner), place_of(corners_[corner].next)};
        for (std::size_t i = 0; i < 3; ++i) {
            ear.points[i] = places_.at[ear.places[i]];
        }
        for (std::size_t i = 0; i < 3; ++i) {
            ear.lengths[i] = std::sqrt(distance_squared(ear.points[i], ear.points[(i + 1) % 3]));
        }
        ear.area = turn(ear.points[0], ear.points[1], ear.points[2]);
        return ear;
    }

    // Puts the corner among those to choose from, or where it waits.
    void examine(std::uint32_t corner) {
        const Visit visit = {corner, ++versions_[corner]};
        const Ear ear = ear_at(corner);
        if (ear.height() <= places_.tolerance) {
            return;
        }
        const double tolerance = places_.tolerance;
        const std::uint32_t inside = ear.find(grid_, tolerance, [&](std::uint32_t place) {
            return ear.depth(places_.at[place]) >= -tolerance;
        });
        if (inside == kNone) {
            ears_.emplace(ear.shape(), visit);
        } else {
            waiting_[inside].push_back(visit);
        }
    }

    std::uint32_t choose() {
        while (!ears_.empty()) {
            const Visit visit = ears_.top().second;
            ears_.pop();
            if (visit.version == versions_[visit.corner]) {
                return visit.corner;
            }
        }
        return least_bad();
    }

    // Where to cut when there is no ear, which is so only in numerical trouble.
    [[nodiscard]] std::uint32_t least_bad() const {
        std::uint32_t best = kNone;
        std::pair<int, double> best_merit;
        for (std::uint32_t corner = 0; corner < corners_.size(); ++corner) {
            if (is_left(corner)) {
                const auto merit = merit_of(ear_at(corner));
                if (best == kNone || merit > best_merit) {
                    best = corner;
                    best_merit = merit;
                }
            }
        }
        return best;
    }

    // From worst to best: clockwise; with a place inside, the deeper the worse; thin but clear; an
    // edge there and back, which is no triangle at all.
    [[nodiscard]] std::pair<int, double> merit_of(const Ear& ear) const {
        if (ear.places[0] == ear.places[2]) {
            return {3, 0};
        }
        if (ear.area <= 0) {
            return {0, ear.area};
        }
        double depth = -1;
        static_cast<void>(ear.find(grid_, 0, [&](std::uint32_t place) {
            depth = std::max(depth, ear.depth(places_.at[place]));
            return false;
        }));
        return depth < 0 ? std::pair(2, ear.shape()) : std::pair(1, -depth);
    }

    void cut(std::uint32_t corner) {
        const std::uint32_t prev = corners_[corner].prev;
        std::uint32_t next = corners_[corner].next;
        if (place_of(prev) == place_of(next)) {
            const std::uint32_t twin = next;
            next = corners_[twin].next;
            take_out(twin);
        } else {
            triangles_.push_back(
                {places_.number[place_of(prev)],
                 places_.number[place_of(corner)],
                 places_.number[place_of(next)]}
            );
        }
        take_out(corner);
        link(corners_, prev, next);
        if (corners_[next].next == prev) {
            take_out(prev);
            take_out(next);
        } else {
            examine(prev);
            examine(next);
        }
        wake();
    }

    void take_out(std::uint32_t corner) {
        link(corners_, corner, corner);
        ++versions_[corner];
        --left_count_;
        const std::uint32_t place = place_of(corner);
        if (--corner_counts_[place] == 0) {
            grid_.remove(place);
            woken_.insert(woken_.end(), waiting_[place].begin(), waiting_[place].end());
            waiting_[place].clear();
        }
    }

    void wake() {
        for (const Visit& visit : woken_) {
            if (visit.version == versions_[visit.corner]) {
                examine(visit.corner);
            }
        }
        woken_.clear();
    }

    const Places& places_;
    Corners& corners_;
    PlaceGrid grid_;
    std::vector<std::uint32_t> corner_counts_;  // by place
    std::vector<std::vector<Visit>> waiting_;   // by the place inside
    std::vector<std::uint32_t> versions_;       // by corner
    std::size_t left_count_ = 0;
    std::priority_queue<std::pair<double, Visit>> ears_;
    std::vector<Visit> woken_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(
    std::span<const Point2> points, const Loop& outer, std::span<const Loop> holes
) {
    Loop vertices = outer;
    for (const Loop& hole : holes) {
        vertices.insert(vertices.end(), hole.begin(), hole.end());
    }
    if (vertices.empty()) {
        return {};
    }
    Places places;
    places.tolerance = tolerance_for(points, vertices);
    const std::vector<std::uint32_t> place_of = find_places(points, vertices, places);
    Corners corners;
    std::span<const std::uint32_t> rest = place_of;
    const auto take = [&](const Loop& loop) {
        add_ring(rest.first(loop.size()), corners);
        rest = rest.subspan(loop.size());
    };
    take(outer);
    for (const Loop& hole : holes) {
        take(hole);
    }
    face_inside(places, corners);
    Bridges(places, corners).build();
    return EarCutter(places, corners).cut_all();
}

}  // namespace modelsynth::continuous
