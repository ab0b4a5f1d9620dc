#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/solids.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr std::size_t kGround = std::numeric_limits<std::size_t>::max();

// A face of the example as the reader sees it: its plane, and where it reaches.
struct Patch {
    std::size_t solid = kGround;  // kGround: the ground's top, which has no end
    std::size_t face = 0;
    std::size_t family = 0;
    double offset = 0;
    bool is_seen = false;  // a figure was read on it
    Point min = Point::Constant(-std::numeric_limits<double>::infinity());
    Point max = Point::Constant(std::numeric_limits<double>::infinity());
};

class Reader {
  public:
    static constexpr std::size_t kLooksMax = 200'000'000;  // some seconds

    Reader(
        const Example& example,
        std::span<const std::vector<FacePlane>> planes,
        const Topes& topes,
        std::size_t looks_max
    )
        : looks_max_(looks_max),
          example_(example),
          topes_(topes),
          solids_(example),
          extent_(extent_of(example)),
          tolerance_(extent_ * 1e-6) {
        for (std::size_t s = 0; s < example.polyhedra.size(); ++s) {
            const Polyhedron& solid = example.polyhedra[s];
            for (std::size_t f = 0; f < solid.faces.size(); ++f) {
                const FacePlane& plane = planes[s][f];
                if (plane.family == kNoFamily) {
                    continue;
                }
                Patch patch = {s, f, plane.family, plane.offset};
                patch.min = solid.corners[solid.faces[f].front()];
                patch.max = patch.min;
                for (const std::uint32_t corner : solid.faces[f]) {
                    farthest_ = farthest_.cwiseMax(solid.corners[corner]);
                    patch.min = patch.min.cwiseMin(solid.corners[corner]);
                    patch.max = patch.max.cwiseMax(solid.corners[corner]);
                }
                patches_.push_back(patch);
            }
        }
        if (example.ground) {
            Patch ground;
            for (std::size_t family = 0; family < topes.family_count(); ++family) {
                if (topes.normals()[family].y() > 1 - kNormalTolerance) {
                    ground.family = family;
                }
            }
            patches_.push_back(ground);
        }
    }

    Result<std::vector<Figure>> read() {
        read_corners();
        read_lines();
        read_faces();
        if (is_spent()) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "the example's faces meet in so many places that reading them would take too long"}
            );
        }
        if (!faults_.empty()) {
            return tl::unexpected(Error{
                ErrorCode::kInvalidArgument,
                "it cannot be told what the example has where",
                std::move(faults_)});
        }
        figures_.push_back(uniform_figure(topes_, kEmpty));
        return std::move(figures_);
    }

  private:
    // Whether all that may be looked at was looked at.
    [[nodiscard]] bool is_spent() const { return looks_ > looks_max_; }

    [[nodiscard]] bool is_in_bounds(const Point& point) const {
        return !example_.bounds ||
               ((point.array() > example_.bounds->min.array() + tolerance_).all() &&
                (point.array() < example_.bounds->max.array() - tolerance_).all());
    }

    [[nodiscard]] bool overlap(const Patch& a, const Patch& b) const {
        return (a.min.array() <= b.max.array() + tolerance_).all() &&
               (b.min.array() <= a.max.array() + tolerance_).all();
    }

    [[nodiscard]] double distance(const Patch& patch, const Point& point) const {
        return patch.solid == kGround ? std::abs(point.y())
                                      : solids_.distance(patch.solid, patch.face, point);
    }

    // Points that three faces have in common.
    void read_corners() {
        std::vector<std::size_t> near;
        for (std::size_t a = 0; a < patches_.size(); ++a) {
            near.clear();
            for (std::size_t b = a + 1; b < patches_.size(); ++b) {
                if (patches_[a].family != patches_[b].family && overlap(patches_[a], patches_[b])) {
                    near.push_back(b);
                }
            }
            for (std::size_t i = 0; i < near.size(); ++i) {
                const Patch& second = patches_[near[i]];
                const FamilySet line =
                    topes_.lines()[topes_.line_of(patches_[a].family, second.family)].families;
                looks_ += near.size() - i;
                if (is_spent()) {
                    return;
                }
                for (std::size_t j = i + 1; j < near.size(); ++j) {
                    const Patch& third = patches_[near[j]];
                    if ((line >> third.family & 1) == 0 && overlap(second, third)) {
                        read_common_point(patches_[a], second, third);
                    }
                }
            }
        }
    }

    void read_common_point(const Patch& a, const Patch& b, const Patch& c) {
        Eigen::Matrix3d normals;
        normals.row(0) = topes_.normals()[a.family];
        normals.row(1) = topes_.normals()[b.family];
        normals.row(2) = topes_.normals()[c.family];
        const Point point = normals.inverse() * Point(a.offset, b.offset, c.offset);
        if (!is_in_bounds(point) || distance(a, point) > tolerance_ ||
            distance(b, point) > tolerance_ || distance(c, point) > tolerance_) {
            return;
        }
        std::array<std::int64_t, 3> place = {};
        for (int axis = 0; axis < 3; ++axis) {
            place[static_cast<std::size_t>(axis)] = std::llround(point[axis] / (8 * tolerance_));
        }
        if (places_.insert(place).second) {
            corners_.push_back(point);
            read_figure(point, a);
        }
    }

    // Along every line on which two faces meet, such as the edges of a solid: between any two of
    // those points that follow each other there, and before and after them.
    void read_lines() {
        for (std::size_t a = 0; a < patches_.size(); ++a) {
            for (std::size_t b = a + 1; b < patches_.size(); ++b) {
                if (patches_[a].family != patches_[b].family && overlap(patches_[a], patches_[b])) {
                    read_line(patches_[a], patches_[b]);
                }
                if (is_spent()) {
                    return;
                }
            }
        }
    }

    void read_line(const Patch& a, const Patch& b) {
        const Point& na = topes_.normals()[a.family];
        const Point& nb = topes_.normals()[b.family];
        const Point along = na.cross(nb).normalized();
        Eigen::Matrix3d normals;
        normals.row(0) = na;
        normals.row(1) = nb;
        normals.row(2) = along;
        const Point base = normals.inverse() * Point(a.offset, b.offset, 0);
        const auto part = common_part(a, b, base, along);
        if (!part) {
            return;
        }
        std::vector<double> stops = {part->first, part->second};
        looks_ += corners_.size();
        for (const Point& corner : corners_) {
            const double t = (corner - base).dot(along);
            if (t > part->first && t < part->second &&
                (base + t * along - corner).norm() <= tolerance_) {
                stops.push_back(t);
            }
        }
        std::sort(stops.begin(), stops.end());
        for (std::size_t i = 1; i < stops.size(); ++i) {
            const Point middle = base + (stops[i] + stops[i - 1]) / 2 * along;
            if (stops[i] - stops[i - 1] > 16 * tolerance_ && is_in_bounds(middle) &&
                distance(a, middle) <= tolerance_ && distance(b, middle) <= tolerance_) {
                read_figure(middle, a);
            }
        }
    }

    // The part of a line in the boxes around two faces and in the bounds.
    [[nodiscard]] std::optional<std::pair<double, double>> common_part(
        const Patch& a, const Patch& b, const Point& base, const Point& along
    ) const {
        Point low = a.min.cwiseMax(b.min).array() - tolerance_;
        Point high = a.max.cwiseMin(b.max).array() + tolerance_;
        if (example_.bounds) {
            low = low.cwiseMax(example_.bounds->min);
            high = high.cwiseMin(example_.bounds->max);
        }
        double from = -std::numeric_limits<double>::infinity();
        double to = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(along[axis]) < 1e-9) {
                if (base[axis] < low[axis] || base[axis] > high[axis]) {
                    return std::nullopt;
                }
                continue;
            }
            const double first = (low[axis] - base[axis]) / along[axis];
            const double second = (high[axis] - base[axis]) / along[axis];
            from = std::max(from, std::min(first, second));
            to = std::min(to, std::max(first, second));
        }
        return from < to ? std::optional(std::pair(from, to)) : std::nullopt;
    }

    // Places on every face that has no line in the bounds, and on the ground, which may have none
    // where it is bare.
    void read_faces() {
        for (const Patch& patch : patches_) {
            if (patch.is_seen && patch.solid != kGround) {
                continue;
            }
            Point low = patch.min;
            Point high = patch.max;
            if (example_.bounds) {
                low = low.cwiseMax(example_.bounds->min);
                high = high.cwiseMin(example_.bounds->max);
            } else {  // beside all solids
                low = farthest_ + Point::Constant(extent_ / 2);
                high = farthest_ + Point::Constant(extent_);
            }
            constexpr int kPlaces = 5;  // along each axis
            const Point& normal = topes_.normals()[patch.family];
            for (int i = 0; i < kPlaces * kPlaces * kPlaces; ++i) {
                const Point share =
                    Point(i % kPlaces, i / kPlaces % kPlaces, i / kPlaces / kPlaces).array() + 0.5;
                Point place = low + (high - low).cwiseProduct(share) / kPlaces;
                place += normal * (patch.offset - normal.dot(place));
                if (is_in_bounds(place) && distance(patch, place) <= tolerance_) {
                    read_figure(place, patch);
                }
            }
        }
    }

    // How far the inside of a cell is from the nearest of some planes.
    [[nodiscard]] double height_inside(Tope tope, FamilySet families) const {
        double least = 1;
        for (std::size_t family = 0; family < topes_.family_count(); ++family) {
            if ((families >> family & 1) != 0) {
                const double height = std::abs(topes_.normals()[family].dot(topes_.inside(tope)));
                least = std::min(least, height);
            }
        }
        return least;
    }

    // `patch`: to name the place in a fault.
    void read_figure(const Point& point, const Patch& patch) {
        looks_ += 20 * patches_.size();
        if (is_spent()) {
            return;
        }
        FamilySet here = 0;
        double nearest = extent_;
        for (Patch& other : patches_) {
            const Point nearby = point.cwiseMax(other.min).cwiseMin(other.max);
            if ((nearby - point).norm() > std::max(nearest, 4 * tolerance_)) {
                continue;
            }
            const double away = distance(other, point);
            if (away <= 4 * tolerance_) {
                other.is_seen = true;
                here |= only(other.family);
            } else {
                nearest = std::min(nearest, away);
            }
        }
        if (example_.bounds) {  // faces beyond are not known
            nearest = std::min(
                {nearest,
                 (point - example_.bounds->min).minCoeff(),
                 (example_.bounds->max - point).minCoeff()}
            );
        }
        const double reach = nearest / 4;

        // Of the cells that are one for the planes through the point, the one whose inside is
        // farthest from them.
        struct Sample {
            double height = 0;
            Tope tope = 0;
            char object = 0;
        };

        std::map<FamilySet, Sample> samples;
        for (std::size_t t = 0; t < topes_.count(); ++t) {
            const auto tope = static_cast<Tope>(t);
            const double height = height_inside(tope, here);
            Sample& sample = samples[topes_.sides(tope) & here];
            if (height > sample.height) {
                sample = {height, tope, 0};
            }
        }
        for (auto& [sides, sample] : samples) {
            looks_ += 20;
            const Point place = point + reach * topes_.inside(sample.tope);
            sample.object = static_cast<char>(solids_.at(place));
        }
        Figure figure(topes_.count(), '\0');
        for (std::size_t t = 0; t < topes_.count(); ++t) {
            figure[t] = samples[topes_.sides(static_cast<Tope>(t)) & here].object;
        }
        if (reach < 4 * tolerance_ && patch.solid != kGround) {
            faults_.push_back(
                {"/polyhedra/" + std::to_string(patch.solid) + "/faces/" +
                     std::to_string(patch.face),
                 "another face comes nearer than can be told apart"}
            );
        }
        figures_.push_back(std::move(figure));
    }

    std::size_t looks_max_;
    const Example& example_;
    const Topes& topes_;
    Solids solids_;
    Point farthest_ = Point::Zero();  // the solids' largest coordinates
    double extent_;
    double tolerance_;
    std::vector<Patch> patches_;
    std::set<std::array<std::int64_t, 3>> places_;
    std::vector<Point> corners_;
    std::vector<Figure> figures_;
    std::vector<Fault> faults_;
    std::size_t looks_ = 0;  // at faces, about
};

}  // namespace

Result<std::vector<Figure>> read_figures(
    const Example& example,
    std::span<const std::vector<FacePlane>> planes,
    const Topes& topes,
    std::size_t readings
) {
    return Reader(example, planes, topes, Reader::kLooksMax / readings).read();
}

}  // namespace modelsynth::continuous
