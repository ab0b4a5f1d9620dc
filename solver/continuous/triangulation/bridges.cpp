#include "solver/continuous/triangulation/bridges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace modelsynth::continuous::rings {

namespace {

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
}  // namespace

void bridge_holes(const Places& places, Corners& corners) { Bridges(places, corners).build(); }

}  // namespace modelsynth::continuous::rings
