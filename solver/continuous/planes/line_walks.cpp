#include "solver/continuous/planes/line_walks.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

// Planes pass through a point below the first distance to it (in metres per metre of the box), and
// do not above the second; what lies between is refused.
constexpr double kOnPlane = 1e-10;
constexpr double kOffPlane = 1e-8;

constexpr int kFamilyBits = 5;
constexpr int kPlaneBits = 16;
static_assert(kPlanesMax < std::size_t{1} << kPlaneBits);

class LineWalker {
  public:
    LineWalker(
        const Topes& topes,
        std::span<const PlaneOffsets> planes,
        const Bounds& box,
        std::size_t vertices_max,
        const std::stop_token& stop
    )
        : topes_(topes),
          planes_(planes),
          box_(box),
          vertices_max_(vertices_max),
          stop_(stop),
          extent_((box.max - box.min).maxCoeff()) {}

    [[nodiscard]] Result<LineWalks> walk_all() {
        for (std::size_t line = 0; line < topes_.lines().size(); ++line) {
            const FamilySet around = topes_.lines()[line].families;
            for (std::size_t a = 0; a < topes_.family_count(); ++a) {
                for (std::size_t b = a + 1; b < topes_.family_count(); ++b) {
                    if ((around >> a & 1) != 0 && (around >> b & 1) != 0) {
                        walk_pair(line, a, b);
                    }
                    if (error_) {
                        return tl::unexpected(std::move(*error_));
                    }
                }
            }
        }
        made_.walks.push_back({0, static_cast<std::uint32_t>(made_.meetings.size())});
        return std::move(made_);
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
        made_.walks.push_back(
            {static_cast<Heading>(2 * line), static_cast<std::uint32_t>(made_.meetings.size())}
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
            made_.meetings.push_back({key_of(a, b, i, j, base, k, end, families), families});
            if (made_.meetings.size() > 8 * vertices_max_) {
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
    [[nodiscard]] VertexKey key_of(
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
        VertexKey key = 0;
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
            const double low = box_.min[axis] + margin - base[axis];
            const double high = box_.max[axis] - margin - base[axis];
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
    const Bounds& box_;
    std::size_t vertices_max_;
    const std::stop_token& stop_;
    double extent_;
    LineWalks made_;
    std::vector<PlaneCrossing> crossings_;
    std::optional<Error> error_;
};

}  // namespace

Result<LineWalks> walk_lines(
    const Topes& topes,
    std::span<const PlaneOffsets> planes,
    const Bounds& box,
    std::size_t vertices_max,
    const std::stop_token& stop
) {
    return LineWalker(topes, planes, box, vertices_max, stop).walk_all();
}

Point place_of(VertexKey key, const Topes& topes, std::span<const PlaneOffsets> planes) {
    Eigen::Matrix3d normals;
    Point offsets;
    for (int i = 2; i >= 0; --i) {
        const std::size_t plane = key & ((VertexKey{1} << kPlaneBits) - 1);
        key >>= kPlaneBits;
        offsets[i] = static_cast<double>(plane);
    }
    for (int i = 2; i >= 0; --i) {
        const std::size_t family = key & ((VertexKey{1} << kFamilyBits) - 1);
        key >>= kFamilyBits;
        normals.row(i) = topes.normals()[family];
        offsets[i] = planes[family][static_cast<std::size_t>(offsets[i])];
    }
    return normals.inverse() * offsets;
}

}  // namespace modelsynth::continuous
