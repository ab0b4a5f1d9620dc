#include "solver/continuous/planes/arrangement.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

// Planes pass through a point below the first distance to it (in metres per metre of the box), and
// do not above the second; what lies between is refused.
constexpr double kOnPlane = 1e-10;
constexpr double kOffPlane = 1e-8;

// A vertex's name: the numbers of the planes of its first three independent families.
using Key = std::uint64_t;
constexpr int kFamilyBits = 5;
constexpr int kPlaneBits = 16;
static_assert(kPlanesMax < std::size_t{1} << kPlaneBits);

// A line passes through a vertex.
struct Meeting {
    Key key = 0;
    FamilySet families = 0;
};

// A vertex with its name.
struct Named {
    Key key = 0;
    std::uint32_t meeting = 0;  // one of it
    Point place;
    std::size_t cell = 0;
};

// Meetings are put on heaps by name before they are sorted; equal names come on one.
constexpr std::size_t kHeaps = 1024;

std::size_t heap_of(Key key) { return key * 0x9E37'79B9'7F4A'7C15 >> 54; }

// How many vertices are dealt with between two looks at the stop token.
constexpr std::size_t kStopInterval = 4096;

// A line of the arrangement and the vertices on it, one after the other.
struct Walk {
    Heading heading = 0;
    std::uint32_t first = 0;  // of its meetings
};

class Builder {
  public:
    Builder(
        const Topes& topes,
        std::span<const PlaneOffsets> planes,
        const Arrangement::Frame& frame,
        std::size_t vertices_max,
        const std::stop_token& stop
    )
        : topes_(topes),
          planes_(planes),
          frame_(frame),
          vertices_max_(vertices_max),
          stop_(stop),
          extent_((frame.box.max - frame.box.min).maxCoeff()) {}

    // Every line of the arrangement once.
    std::optional<Error> walk_all() {
        for (std::size_t line = 0; line < topes_.lines().size(); ++line) {
            const FamilySet around = topes_.lines()[line].families;
            for (std::size_t a = 0; a < topes_.family_count(); ++a) {
                for (std::size_t b = a + 1; b < topes_.family_count(); ++b) {
                    if ((around >> a & 1) != 0 && (around >> b & 1) != 0) {
                        walk_pair(line, a, b);
                    }
                    if (error_) {
                        return std::move(error_);
                    }
                }
            }
        }
        walks_.push_back({0, static_cast<std::uint32_t>(meetings_.size())});
        return std::nullopt;
    }

    std::vector<Meeting> meetings_;
    std::vector<Walk> walks_;

    // The point where a vertex lies, from its name.
    [[nodiscard]] Point point_of(Key key) const {
        Eigen::Matrix3d normals;
        Point offsets;
        for (int i = 2; i >= 0; --i) {
            const std::size_t plane = key & ((Key{1} << kPlaneBits) - 1);
            key >>= kPlaneBits;
            offsets[i] = static_cast<double>(plane);
        }
        for (int i = 2; i >= 0; --i) {
            const std::size_t family = key & ((Key{1} << kFamilyBits) - 1);
            key >>= kFamilyBits;
            normals.row(i) = topes_.normals()[family];
            offsets[i] = planes_[family][static_cast<std::size_t>(offsets[i])];
        }
        return normals.inverse() * offsets;
    }

  private:
    // Lines where planes of a and b meet and of no family before them around the line.
    void walk_pair(std::size_t line, std::size_t a, std::size_t b) {
        const Point along = topes_.lines()[line].direction;
        Eigen::Matrix3d normals;
        normals.row(0) = topes_.normals()[a];
        normals.row(1) = topes_.normals()[b];
        normals.row(2) = along;
        const Eigen::Matrix3d inverse = normals.inverse();
        for (std::size_t i = 0; i < planes_[a].size(); ++i) {
            if (stop_.stop_requested()) {
                error_ = cancelled();
                return;
            }
            for (std::size_t j = 0; j < planes_[b].size(); ++j) {
                const Point base = inverse * Point(planes_[a][i], planes_[b][j], 0);
                walk(line, a, b, i, j, base);
                if (error_) {
                    return;
                }
            }
        }
    }

    void walk(
        std::size_t line,
        std::size_t a,
        std::size_t b,
        std::size_t i,
        std::size_t j,
        const Point& base
    ) {
        const Point along = topes_.lines()[line].direction;
        const auto part = inside_box(base, along);
        if (!part) {
            return;
        }
        FamilySet around = only(a) | only(b);
        for (std::size_t family = 0; family < topes_.family_count(); ++family) {
            if ((topes_.lines()[line].families >> family & 1) == 0 || family == a || family == b) {
                continue;
            }
            if (find_plane(family, topes_.normals()[family].dot(base))) {
                if (family < b) {
                    return;  // walked with that family
                }
                around |= only(family);
            }
        }
        crossings_.clear();
        for (std::size_t family = 0; family < topes_.family_count(); ++family) {
            if ((topes_.lines()[line].families >> family & 1) == 0) {
                cross(family, base, along, *part);
            }
        }
        if (crossings_.empty() || error_) {
            return;
        }
        std::sort(crossings_.begin(), crossings_.end());
        walks_.push_back(
            {static_cast<Heading>(2 * line), static_cast<std::uint32_t>(meetings_.size())}
        );
        const double on = kOnPlane * extent_;
        for (std::size_t k = 0; k < crossings_.size();) {
            // Families cross at different angles, so that what is one point across a plane may be
            // a little less so along the line; see cross().
            std::size_t end = k + 1;
            FamilySet families = around | only(crossings_[k].family);
            while (end < crossings_.size() && crossings_[end].t - crossings_[k].t <= 16 * on) {
                families |= only(crossings_[end].family);
                ++end;
            }
            if (end < crossings_.size() &&
                crossings_[end].t - crossings_[k].t <= kOffPlane * extent_) {
                error_ = Error{
                    ErrorCode::kInvalidArgument,
                    "planes come so near to one point that it cannot be said whether they meet; "
                    "another spacing may help"};
                return;
            }
            meetings_.push_back({key_of(a, b, i, j, base, k, end, families), families});
            if (meetings_.size() > 8 * vertices_max_) {
                error_ = too_large();
                return;
            }
            k = end;
        }
    }

    [[nodiscard]] Error too_large() const {
        return {
            ErrorCode::kTooLarge,
            "the planes of the model would meet in more than " + std::to_string(vertices_max_) +
                " points; a wider spacing or a smaller size helps"};
    }

    struct PlaneCrossing {
        double t = 0;
        std::uint8_t family = 0;
        std::uint16_t plane = 0;

        friend bool operator<(const PlaneCrossing& x, const PlaneCrossing& y) {
            return std::pair(x.t, x.family) < std::pair(y.t, y.family);
        }
    };

    void cross(
        std::size_t family,
        const Point& base,
        const Point& along,
        const std::pair<double, double>& part
    ) {
        const double slope = topes_.normals()[family].dot(along);
        const double start = topes_.normals()[family].dot(base);
        double low = start + slope * part.first;
        double high = start + slope * part.second;
        if (low > high) {
            std::swap(low, high);
        }
        const PlaneOffsets& offsets = planes_[family];
        const auto first = std::upper_bound(offsets.begin(), offsets.end(), low);
        const auto last = std::lower_bound(offsets.begin(), offsets.end(), high);
        for (auto at = first; at < last; ++at) {
            crossings_.push_back(
                {(*at - start) / slope,
                 static_cast<std::uint8_t>(family),
                 static_cast<std::uint16_t>(at - offsets.begin())}
            );
        }
    }

    // The vertex's name. The families of the line come first where both are lower than what crosses
    // it; else the planes are looked for.
    [[nodiscard]] Key key_of(
        std::size_t a,
        std::size_t b,
        std::size_t i,
        std::size_t j,
        const Point& base,
        std::size_t first,
        std::size_t end,
        FamilySet families
    ) {
        std::array<std::size_t, 3> chosen = {};
        int count = 0;
        FamilySet line = 0;
        for (std::size_t family = 0; count < 3; ++family) {
            if ((families >> family & 1) == 0 || (count == 2 && (line >> family & 1) != 0)) {
                continue;
            }
            chosen[static_cast<std::size_t>(count++)] = family;
            if (count == 2) {
                line = topes_.lines()[topes_.line_of(chosen[0], chosen[1])].families;
            }
        }
        Key key = 0;
        for (const std::size_t family : chosen) {
            key = key << kFamilyBits | family;
        }
        for (const std::size_t family : chosen) {
            std::size_t plane = family == a ? i : family == b ? j : kNoPlane;
            for (std::size_t k = first; k < end; ++k) {
                plane = crossings_[k].family == family ? crossings_[k].plane : plane;
            }
            if (plane == kNoPlane) {  // of a family around the line that is neither a nor b
                plane = find_plane(family, topes_.normals()[family].dot(base)).value_or(0);
            }
            key = key << kPlaneBits | plane;
        }
        return key;
    }

    std::optional<std::size_t> find_plane(std::size_t family, double offset) {
        const PlaneOffsets& offsets = planes_[family];
        const auto at =
            std::lower_bound(offsets.begin(), offsets.end(), offset - kOffPlane * extent_);
        if (at == offsets.end() || *at > offset + kOffPlane * extent_) {
            return std::nullopt;
        }
        if (std::abs(*at - offset) > kOnPlane * extent_) {
            error_ = Error{
                ErrorCode::kInvalidArgument,
                "planes come so near to one line that it cannot be said whether they meet; another "
                "spacing may help"};
        }
        return static_cast<std::size_t>(at - offsets.begin());
    }

    // The part of a line inside the box, as steps along it.
    [[nodiscard]] std::optional<std::pair<double, double>> inside_box(
        const Point& base, const Point& along
    ) const {
        const double margin = kOffPlane * extent_;  // what lies on the border is outside
        double from = -std::numeric_limits<double>::infinity();
        double to = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double low = frame_.box.min[axis] + margin - base[axis];
            const double high = frame_.box.max[axis] - margin - base[axis];
            if (std::abs(along[axis]) < 1e-12) {
                if (low >= 0 || high <= 0) {
                    return std::nullopt;
                }
                continue;
            }
            from = std::max(from, std::min(low / along[axis], high / along[axis]));
            to = std::min(to, std::max(low / along[axis], high / along[axis]));
        }
        return from < to ? std::optional(std::pair(from, to)) : std::nullopt;
    }

    static constexpr std::size_t kNoPlane = std::numeric_limits<std::size_t>::max();

    const Topes& topes_;
    std::span<const PlaneOffsets> planes_;
    const Arrangement::Frame& frame_;
    std::size_t vertices_max_;
    const std::stop_token& stop_;
    double extent_;
    std::vector<PlaneCrossing> crossings_;
    std::optional<Error> error_;
};

std::int32_t cell_of(double coordinate, double cell, std::int32_t cells) {
    const double at = std::floor(coordinate / cell + 1e-7);
    return std::clamp(static_cast<std::int32_t>(at), 0, cells - 1);
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
    Builder builder(topes, planes, frame, vertices_max, stop);
    if (auto error = builder.walk_all()) {
        return tl::unexpected(std::move(*error));
    }

    // The meetings of one name are one vertex. What is sorted is short each time, so that a stop is
    // seen soon.
    std::vector<std::pair<Key, std::uint32_t>> by_key(builder.meetings_.size());
    std::array<std::uint32_t, kHeaps + 1> heap_end = {};
    for (const Meeting& meeting : builder.meetings_) {
        ++heap_end[heap_of(meeting.key) + 1];
    }
    std::partial_sum(heap_end.begin(), heap_end.end(), heap_end.begin());
    for (std::uint32_t i = 0; i < by_key.size(); ++i) {
        const Key key = builder.meetings_[i].key;
        by_key[heap_end[heap_of(key)]++] = {key, i};
    }
    std::vector<Named> named;
    std::vector<std::uint32_t> group_of(by_key.size());
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
                named.push_back({by_key[i].first, by_key[i].second, {}, 0});
            }
            group_of[by_key[i].second] = static_cast<std::uint32_t>(named.size() - 1);
        }
    }
    if (named.size() > vertices_max) {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "the planes of the model meet in " + std::to_string(named.size()) +
                " points, more than " + std::to_string(vertices_max) +
                "; a wider spacing or a smaller size helps"});
    }
    Arrangement made;
    made.topes_ = &topes;
    made.frame_ = frame;
    made.planes_.assign(planes.begin(), planes.end());
    made.first_in_cell_.assign(frame.cells.cell_count() + 1, 0);
    for (std::size_t i = 0; i < named.size(); ++i) {
        if (i % kStopInterval == 0 && stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        Named& vertex = named[i];
        vertex.place = builder.point_of(vertex.key);
        vertex.cell = frame.cells.index(
            {cell_of(vertex.place.x(), frame.cell, frame.cells.x),
             cell_of(vertex.place.y(), frame.cell, frame.cells.y),
             cell_of(vertex.place.z(), frame.cell, frame.cells.z)}
        );
        ++made.first_in_cell_[vertex.cell + 1];
    }
    std::partial_sum(
        made.first_in_cell_.begin(), made.first_in_cell_.end(), made.first_in_cell_.begin()
    );

    // Vertices by cell, then by name.
    std::vector<std::uint32_t> order(named.size());
    std::vector<Site> next_in_cell(made.first_in_cell_.begin(), made.first_in_cell_.end() - 1);
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[next_in_cell[named[i].cell]++] = i;
    }
    for (std::size_t cell = 0; cell + 1 < made.first_in_cell_.size(); ++cell) {
        if (cell % kStopInterval == 0 && stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        std::sort(
            order.begin() + made.first_in_cell_[cell],
            order.begin() + made.first_in_cell_[cell + 1],
            [&](std::uint32_t x, std::uint32_t y) { return named[x].key < named[y].key; }
        );
    }
    std::vector<Site> number(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Named& vertex = named[order[i]];
        number[order[i]] = static_cast<Site>(i);
        made.positions_.push_back(vertex.place);
        made.families_.push_back(builder.meetings_[vertex.meeting].families);
    }

    const auto visit_ends = [&](auto visit) {
        for (std::size_t w = 0; w + 1 < builder.walks_.size(); ++w) {
            const Walk& walk = builder.walks_[w];
            Site before = kNoSite;
            for (std::uint32_t i = walk.first; i < builder.walks_[w + 1].first; ++i) {
                const Site here = number[group_of[i]];
                visit(here, opposite(walk.heading), before);
                if (before != kNoSite) {
                    visit(before, walk.heading, here);
                }
                before = here;
            }
            visit(before, walk.heading, kNoSite);
        }
    };
    if (stop.stop_requested()) {
        return tl::unexpected(cancelled());
    }
    made.first_edge_.assign(order.size() + 2, 0);
    visit_ends([&](Site at, Heading, Site) { ++made.first_edge_[at + 2]; });
    for (std::size_t i = 2; i < made.first_edge_.size(); ++i) {
        made.first_edge_[i] += made.first_edge_[i - 1];
    }
    made.edges_.resize(made.first_edge_.back());
    visit_ends([&](Site at, Heading heading, Site end) {
        made.edges_[made.first_edge_[at + 1]++] = {heading, end};
    });
    made.first_edge_.pop_back();
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i % kStopInterval == 0 && stop.stop_requested()) {
            return tl::unexpected(cancelled());
        }
        std::sort(
            made.edges_.begin() + made.first_edge_[i],
            made.edges_.begin() + made.first_edge_[i + 1],
            [](const ArrangementEdge& x, const ArrangementEdge& y) { return x.heading < y.heading; }
        );
    }
    return made;
}

}  // namespace modelsynth::continuous
