#include "solver/continuous/triangulation/ear_cutter.h"

#include "solver/continuous/triangulation/place_grid.h"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <utility>

namespace modelsynth::continuous::rings {

namespace {

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

std::vector<std::array<std::uint32_t, 3>> cut_ears(const Places& places, Corners& corners) {
    return EarCutter(places, corners).cut_all();
}

}  // namespace modelsynth::continuous::rings
