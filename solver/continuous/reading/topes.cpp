#include "solver/continuous/reading/topes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

// A line is parallel to a plane below the first, not parallel above the second.
constexpr double kParallel = 1e-7;
constexpr double kNotParallel = 1e-5;

}  // namespace

Tope Topes::tope_of(FamilySet sides) const {
    const auto found = tope_of_.find(sides);
    check(found != tope_of_.end(), "sides of no cell of the arrangement");
    return found->second;
}

std::optional<std::size_t> Topes::find_family(const Point& normal) const {
    for (std::size_t family = 0; family < family_count(); ++family) {
        if (std::abs(normals_[family].dot(normal.normalized())) > 1 - 1e-9) {
            return family;
        }
    }
    return std::nullopt;
}

Result<Topes> Topes::make(std::vector<Point> normals) {
    Topes topes;
    topes.normals_ = std::move(normals);
    const std::size_t m = topes.normals_.size();
    topes.line_of_.assign(m * m, 0);
    for (std::size_t a = 0; a < m; ++a) {
        for (std::size_t b = a + 1; b < m; ++b) {
            Point direction = topes.normals_[a].cross(topes.normals_[b]).normalized();
            FamilySet families = 0;
            for (std::size_t other = 0; other < m; ++other) {
                const double slope = std::abs(direction.dot(topes.normals_[other]));
                if (slope > kParallel && slope < kNotParallel) {
                    return tl::unexpected(Error{
                        ErrorCode::kInvalidArgument,
                        "three directions of faces are so nearly parallel to one line that it "
                        "cannot be said whether they are"});
                }
                families |= slope <= kParallel ? only(other) : 0;
            }
            families |= only(a) | only(b);
            const auto known = std::find_if(
                topes.lines_.begin(),
                topes.lines_.end(),
                [&](const LineDirection& line) { return line.families == families; }
            );
            const auto number = static_cast<std::uint16_t>(known - topes.lines_.begin());
            if (known == topes.lines_.end()) {
                topes.lines_.push_back({direction, families});
            }
            topes.line_of_[a * m + b] = number;
            topes.line_of_[b * m + a] = number;
        }
    }
    const FamilySet all = m == kFamiliesMax ? ~FamilySet{0} : (FamilySet{1} << m) - 1;
    if (topes.lines_.empty() || topes.lines_.front().families == all) {
        return tl::unexpected(Error{
            ErrorCode::kInvalidArgument,
            "the faces of the example do not have directions enough: at least three that are not "
            "parallel to one line"});
    }

    // Every cell has lines on its border, so the cells around all lines are all cells.
    std::map<FamilySet, Point> insides;
    for (std::size_t heading = 0; heading < 2 * topes.lines_.size(); ++heading) {
        const Point along = topes.direction(static_cast<Heading>(heading));
        const FamilySet around = topes.lines_[heading / 2].families;
        FamilySet beyond = 0;
        for (std::size_t family = 0; family < m; ++family) {
            const bool is_positive =
                (around & only(family)) == 0 && topes.normals_[family].dot(along) > 0;
            beyond |= is_positive ? only(family) : 0;
        }
        topes.sides_along_.push_back(beyond);
        // Directions in which the planes around the line leave it, by angle.
        const Point right = along.unitOrthogonal();
        const Point up = along.cross(right);
        std::vector<double> angles;
        for (std::size_t family = 0; family < m; ++family) {
            if ((around & only(family)) != 0) {
                const Point in_plane = along.cross(topes.normals_[family]);
                const double angle = std::atan2(in_plane.dot(up), in_plane.dot(right));
                angles.push_back(angle);
                angles.push_back(angle > 0 ? angle - std::numbers::pi : angle + std::numbers::pi);
            }
        }
        std::sort(angles.begin(), angles.end());
        for (std::size_t i = 0; i < angles.size(); ++i) {
            const double next =
                i + 1 < angles.size() ? angles[i + 1] : angles.front() + 2 * std::numbers::pi;
            const double middle = (angles[i] + next) / 2;
            const Point sideways = std::cos(middle) * right + std::sin(middle) * up;
            FamilySet sides = beyond;
            for (std::size_t family = 0; family < m; ++family) {
                const bool is_positive =
                    (around & only(family)) != 0 && topes.normals_[family].dot(sideways) > 0;
                sides |= is_positive ? only(family) : 0;
            }
            const auto [at, is_new] = insides.try_emplace(sides, Point::Zero());
            at->second += along;
        }
    }
    for (const auto& [sides, sum] : insides) {
        topes.tope_of_[sides] = static_cast<Tope>(topes.sides_.size());
        topes.sides_.push_back(sides);
        topes.insides_.push_back(sum.normalized());
    }
    for (std::size_t tope = 0; tope < topes.sides_.size(); ++tope) {
        for (std::size_t family = 0; family < m; ++family) {
            const auto found = topes.tope_of_.find(topes.sides_[tope] ^ only(family));
            topes.across_.push_back(
                found == topes.tope_of_.end() ? static_cast<Tope>(tope) : found->second
            );
        }
    }
    topes.composed_.reserve(2 * topes.lines_.size() * topes.sides_.size());
    for (std::size_t heading = 0; heading < 2 * topes.lines_.size(); ++heading) {
        const FamilySet around = topes.lines_[heading / 2].families;
        for (const FamilySet sides : topes.sides_) {
            const auto along = topes.tope_of_.find((sides & around) | topes.sides_along_[heading]);
            if (along == topes.tope_of_.end()) {
                return tl::unexpected(Error{
                    ErrorCode::kInvalidArgument,
                    "some directions of faces are so nearly the same that it cannot be said how "
                    "they lie to each other; make them the same, or set them further apart"});
            }
            topes.composed_.push_back(along->second);
        }
    }
    return topes;
}

}  // namespace modelsynth::continuous
