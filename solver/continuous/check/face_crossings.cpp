#include "solver/continuous/check/face_crossings.h"

#include "solver/continuous/check/flat.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/triangulation/triangulation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// The idea: two faces cross where both have area on either side of the other's plane. So heights
// above the other's plane are taken, those within the tolerance are 0, and the stretches of the
// common line that lie in a face are read off twice: with zeros counted as above, and as below.
// What is in both has area on both sides; an edge or a corner that only touches the plane is in at
// most one of them, without cases for how it does.

namespace modelsynth::continuous {

namespace {

using Stretch = std::pair<double, double>;
using Stretches = std::vector<Stretch>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct FacePart {
    Point normal = Point::Zero();  // unit length, or 0 when it has no plane
    double offset = 0;
    Eigen::AlignedBox3d box;
    std::optional<Triangles> triangles;  // of numbers into the face; made when first needed
};

double snapped(double height, double tolerance) {
    return std::abs(height) <= tolerance ? 0 : height;
}

Stretches stretches_beside(
    const std::vector<double>& heights, const std::vector<double>& along, bool zero_is_above
) {
    std::vector<double> places;
    const auto is_above = [&](std::size_t i) {
        return heights[i] > 0 || (zero_is_above && heights[i] == 0);
    };
    for (std::size_t a = heights.size() - 1, b = 0; b < heights.size(); a = b++) {
        if (is_above(a) != is_above(b)) {
            const double t = heights[a] / (heights[a] - heights[b]);
            places.push_back(along[a] + t * (along[b] - along[a]));
        }
    }
    std::sort(places.begin(), places.end());
    Stretches stretches;
    for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
        stretches.emplace_back(places[i], places[i + 1]);
    }
    return stretches;
}

Stretches in_both(const Stretches& a, const Stretches& b) {
    Stretches result;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const Stretch common = {
            std::max(a[i].first, b[j].first), std::min(a[i].second, b[j].second)};
        if (common.first < common.second) {
            result.push_back(common);
        }
        (a[i].second < b[j].second ? i : j) += 1;
    }
    return result;
}

// On which sides of a plane a face has corners.
struct Sides {
    bool above = false;
    bool below = false;
};

// The area that two counter-clockwise triangles have in common (Sutherland and Hodgman 1974).
double common_area(const std::array<Point2, 3>& a, const std::array<Point2, 3>& b) {
    std::vector<Point2> left(a.begin(), a.end());
    for (std::size_t i = 0; i < 3 && !left.empty(); ++i) {
        const Point2& from = b[i];
        const Point2 along = minus(b[(i + 1) % 3], from);
        std::vector<Point2> kept;
        for (std::size_t p = left.size() - 1, q = 0; q < left.size(); p = q++) {
            const double at_p = cross(along, minus(left[p], from));
            const double at_q = cross(along, minus(left[q], from));
            if ((at_p < 0) != (at_q < 0)) {
                const double t = at_p / (at_p - at_q);
                const Point2 step = minus(left[q], left[p]);
                kept.push_back({left[p][0] + t * step[0], left[p][1] + t * step[1]});
            }
            if (at_q >= 0) {
                kept.push_back(left[q]);
            }
        }
        left = std::move(kept);
    }
    double twice = 0;
    for (std::size_t i = 1; i + 1 < left.size(); ++i) {
        twice += cross(minus(left[i], left[0]), minus(left[i + 1], left[0]));
    }
    return twice / 2;
}

std::vector<FaceCrossing> sorted(std::vector<FaceCrossing> found) {
    std::sort(found.begin(), found.end(), [](const FaceCrossing& a, const FaceCrossing& b) {
        return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
    return found;
}

// Compares the faces of one solid.
class FacePairs {
  public:
    FacePairs(const Polyhedron& solid, double tolerance, std::size_t& work)
        : solid_(solid), tolerance_(tolerance), work_(work) {
        for (const Face& face : solid.faces) {
            parts_.push_back(part_of(face));
        }
    }

    std::optional<std::vector<FaceCrossing>> find(std::size_t count_max) {
        const std::vector<std::uint32_t> order = sweep_order();
        std::vector<FaceCrossing> found;
        std::vector<std::uint32_t> open;
        for (const std::uint32_t face : order) {
            const double from = parts_[face].box.min()[axis_];
            std::size_t kept = 0;
            for (const std::uint32_t other : open) {
                if (parts_[other].box.max()[axis_] < from) {
                    continue;
                }
                open[kept++] = other;
                if (!parts_[other].box.intersects(parts_[face].box)) {
                    continue;
                }
                pay(solid_.faces[face].size() + solid_.faces[other].size());
                auto crossing = compare(std::min(face, other), std::max(face, other));
                if (is_spent_) {
                    return std::nullopt;
                }
                if (crossing) {
                    found.push_back(std::move(*crossing));
                }
                if (found.size() >= count_max) {
                    return sorted(std::move(found));
                }
            }
            open.resize(kept);
            open.push_back(face);
        }
        return sorted(std::move(found));
    }

  private:
    FacePart part_of(const Face& face) const {
        FacePart part;
        for (const std::uint32_t corner : face) {
            part.box.extend(solid_.corners[corner]);
        }
        const Point area = area_vector(solid_, face);
        if (area.norm() <= tolerance_ * tolerance_) {
            return part;
        }
        part.normal = area.normalized();
        for (const std::uint32_t corner : face) {
            part.offset +=
                part.normal.dot(solid_.corners[corner]) / static_cast<double>(face.size());
        }
        const std::vector<double> heights = heights_of(face, part);
        if (std::any_of(heights.begin(), heights.end(), [](double h) { return h != 0; })) {
            part.normal.setZero();
        }
        return part;
    }

    // Along the axis on which faces are shortest beside the solid.
    std::vector<std::uint32_t> sweep_order() {
        Eigen::AlignedBox3d all;
        Point sum = Point::Zero();
        for (const FacePart& part : parts_) {
            all.extend(part.box);
            sum += part.box.sizes();
        }
        Eigen::Index axis = 0;
        sum.cwiseQuotient(all.sizes().cwiseMax(tolerance_)).minCoeff(&axis);
        axis_ = axis;
        std::vector<std::uint32_t> order;
        for (std::uint32_t face = 0; face < parts_.size(); ++face) {
            if (!parts_[face].normal.isZero()) {
                order.push_back(face);
            }
        }
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(parts_[a].box.min()[axis_], a) <
                   std::pair(parts_[b].box.min()[axis_], b);
        });
        return order;
    }

    void pay(std::size_t amount) {
        is_spent_ = is_spent_ || amount > work_;
        work_ -= std::min(amount, work_);
    }

    std::vector<double> heights_of(const Face& face, const FacePart& plane) const {
        std::vector<double> heights;
        heights.reserve(face.size());
        for (const std::uint32_t corner : face) {
            heights.push_back(
                snapped(plane.normal.dot(solid_.corners[corner]) - plane.offset, tolerance_)
            );
        }
        return heights;
    }

    // As heights_of(), for the most pairs, which end here.
    Sides sides_of(const Face& face, const FacePart& plane) const {
        Sides sides;
        for (const std::uint32_t corner : face) {
            const double height = plane.normal.dot(solid_.corners[corner]) - plane.offset;
            sides.above = sides.above || height > tolerance_;
            sides.below = sides.below || height < -tolerance_;
        }
        return sides;
    }

    std::optional<FaceCrossing> compare(std::uint32_t first, std::uint32_t second) {
        const Sides of_second = sides_of(solid_.faces[second], parts_[first]);
        if (!of_second.above && !of_second.below) {
            return overlap(first, second);
        }
        if (!of_second.above || !of_second.below) {
            return std::nullopt;
        }
        const Sides of_first = sides_of(solid_.faces[first], parts_[second]);
        return of_first.above && of_first.below ? crossing(first, second) : std::nullopt;
    }

    std::optional<FaceCrossing> crossing(std::uint32_t first, std::uint32_t second) const {
        const Point& n = parts_[first].normal;
        const Point& m = parts_[second].normal;
        const Point line = n.cross(m);
        const double sine = line.norm();
        if (sine < kNormalTolerance) {
            return std::nullopt;
        }
        const auto stretches = [&](const Face& face, const FacePart& plane) {
            const std::vector<double> heights = heights_of(face, plane);
            std::vector<double> along;
            along.reserve(face.size());
            for (const std::uint32_t corner : face) {
                along.push_back(line.dot(solid_.corners[corner]) / sine);
            }
            return in_both(
                stretches_beside(heights, along, true), stretches_beside(heights, along, false)
            );
        };
        const Stretches common = in_both(
            stretches(solid_.faces[first], parts_[second]),
            stretches(solid_.faces[second], parts_[first])
        );
        for (const auto& [from, to] : common) {
            // Where planes meet at a small angle, noise moves their line by more.
            if (to - from > 4 * tolerance_ / sine) {
                const double cosine = n.dot(m);
                const double a = parts_[first].offset;
                const double b = parts_[second].offset;
                const Point foot = ((a - b * cosine) * n + (b - a * cosine) * m) / (sine * sine);
                return FaceCrossing{first, second, foot + line / sine * ((from + to) / 2), false};
            }
        }
        return std::nullopt;
    }

    const Triangles& triangles_of(std::uint32_t face) {
        std::optional<Triangles>& triangles = parts_[face].triangles;
        if (!triangles) {
            std::vector<Point2> points;
            Loop loop;
            for (const std::uint32_t corner : solid_.faces[face]) {
                loop.push_back(static_cast<std::uint32_t>(points.size()));
                points.push_back(flattened(solid_.corners[corner], parts_[face].normal));
            }
            triangles = triangulate(points, loop, {});
        }
        return *triangles;
    }

    std::optional<FaceCrossing> overlap(std::uint32_t first, std::uint32_t second) {
        const Point& normal = parts_[first].normal;
        if (normal.dot(parts_[second].normal) < 0) {
            return std::nullopt;
        }
        const Triangles& of_first = triangles_of(first);
        const Triangles& of_second = triangles_of(second);
        pay(of_first.size() * of_second.size());
        if (is_spent_) {
            return std::nullopt;
        }
        const auto corners_of = [&](std::uint32_t face, const std::array<std::uint32_t, 3>& t) {
            std::array<Point2, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) {
                corners[i] = flattened(solid_.corners[solid_.faces[face][t[i]]], normal);
            }
            return corners;
        };
        const double reach = parts_[first].box.sizes().norm() + parts_[second].box.sizes().norm();
        for (const auto& a : of_first) {
            const auto corners = corners_of(first, a);
            for (const auto& b : of_second) {
                const auto others = corners_of(second, b);
                if (common_area(corners, others) > tolerance_ * reach) {
                    Point middle = Point::Zero();
                    for (const std::uint32_t i : b) {
                        middle += solid_.corners[solid_.faces[second][i]] / 3;
                    }
                    return FaceCrossing{first, second, middle, true};
                }
            }
        }
        return std::nullopt;
    }

    const Polyhedron& solid_;
    double tolerance_;
    std::size_t& work_;
    bool is_spent_ = false;
    std::vector<FacePart> parts_;
    Eigen::Index axis_ = 0;
};

}  // namespace

std::optional<std::vector<FaceCrossing>> find_crossings(
    const Polyhedron& solid, double tolerance, std::size_t count_max, std::size_t& work
) {
    return FacePairs(solid, tolerance, work).find(count_max);
}

}  // namespace modelsynth::continuous
