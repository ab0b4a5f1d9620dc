// With n the faces' normals, a point x of a sweep is that with n0 x = p and n1 x = q, relative to
// the edge. In the plane across the edge that are two equations for two unknowns. At a mitre the
// third one says the same of the next edge: where face 0 is common, n0 x = p, n1 x = q, m1 x = q.
// All of it is linear in p and q, so that cross-sections are flat.

#include "solver/continuous/decoration/mitres.h"

#include "solver/continuous/surface/sides.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace modelsynth::continuous {

namespace {

constexpr double kFlattest = 1e-9;  // of the volume that normals span

// Where the common face's offset is `common` and that of either other face `other`.
struct MitreAxes {
    Point common;
    Point other;
};

MitreAxes mitre_axes(const Point& common, const Point& a, const Point& b, double volume) {
    return {a.cross(b) / volume, (b.cross(common) + common.cross(a)) / volume};
}

}  // namespace

void MitredSweeps::add(const DecoratedEdge& edge) {
    Swept swept = {edge, {capped_end(edge, 0), capped_end(edge, 1)}};
    if (is_within_reach(swept.ends[0])) {
        swept_.push_back(std::move(swept));
    }
}

void MitredSweeps::append_to(std::vector<Sweep>& sweeps) {
    join_at_corners();
    part_those_that_cross();
    for (const Swept& swept : swept_) {
        sweeps.push_back({object_, &decoration_, swept.ends});
    }
}

SweepEnd MitredSweeps::capped_end(const DecoratedEdge& edge, std::size_t end) const {
    const auto& [a, b] = edge.normals;
    const double cosine = a.dot(b);
    const double squared_sine = a.cross(b).squaredNorm();
    return {edge.ends.at(end), (a - cosine * b) / squared_sine, (b - cosine * a) / squared_sine};
}

bool MitredSweeps::is_within_reach(const SweepEnd& end) const {
    double offset_max = 0;
    double distance_max = 0;
    for (const auto& [p, q] : decoration_.profile) {
        offset_max = std::max({offset_max, std::abs(p), std::abs(q)});
        distance_max = std::max(distance_max, (p * end.of_p + q * end.of_q).norm());
    }
    return distance_max <= kReachMax * offset_max;
}

bool MitredSweeps::crosses_itself(const Swept& swept) const {
    const auto& [first, last] = swept.ends;
    const Point along = last.at - first.at;
    return std::any_of(
        decoration_.profile.begin(),
        decoration_.profile.end(),
        [&](const ProfilePoint& point) {
            const Point offset =
                point[0] * (last.of_p - first.of_p) + point[1] * (last.of_q - first.of_q);
            return (along + offset).dot(along) <= 1e-6 * along.squaredNorm();
        }
    );
}

void MitredSweeps::join_at_corners() {
    std::map<std::size_t, std::vector<End>> by_corner;
    for (std::size_t i = 0; i < swept_.size(); ++i) {
        for (std::size_t end = 0; end < 2; ++end) {
            if (swept_[i].edge.corners.at(end) != kNoSide) {
                by_corner[swept_[i].edge.corners.at(end)].push_back(2 * i + end);
            }
        }
    }
    for (const auto& [corner, ends] : by_corner) {
        if (ends.size() == 2) {
            join(ends[0], ends[1]);
        }
    }
}

void MitredSweeps::join(End a, End b) {
    Swept& first = swept_[a / 2];
    Swept& second = swept_[b / 2];
    if (a % 2 == b % 2) {
        return;  // one would have to be swept backwards
    }
    for (std::size_t common = 0; common < 2; ++common) {
        if (first.edge.polygons.at(common) != second.edge.polygons.at(common)) {
            continue;
        }
        const Point& normal = first.edge.normals.at(common);
        const Point& other = first.edge.normals.at(1 - common);
        const Point& next = second.edge.normals.at(1 - common);
        const double volume = normal.dot(other.cross(next));
        if (std::abs(volume) < kFlattest) {
            continue;
        }
        const MitreAxes axes = mitre_axes(normal, other, next, volume);
        const SweepEnd end = {
            first.edge.ends.at(a % 2),
            common == 0 ? axes.common : axes.other,
            common == 0 ? axes.other : axes.common,
            true};
        if (is_within_reach(end)) {
            first.ends.at(a % 2) = end;
            second.ends.at(b % 2) = end;
            first.partners.at(a % 2) = b;
            second.partners.at(b % 2) = a;
            return;
        }
    }
}

// Without its mitres a sweep is a prism, which crosses nothing; but those beside it have one mitre
// less, and are looked at again.
void MitredSweeps::part_those_that_cross() {
    std::vector<std::size_t> to_look_at;
    for (std::size_t i = swept_.size(); i > 0; --i) {
        to_look_at.push_back(i - 1);
    }
    while (!to_look_at.empty()) {
        Swept& swept = swept_[to_look_at.back()];
        to_look_at.pop_back();
        if (!crosses_itself(swept)) {
            continue;
        }
        for (std::size_t end = 0; end < 2; ++end) {
            const End partner = swept.partners.at(end);
            if (partner == kNoEnd) {
                continue;
            }
            Swept& beside = swept_[partner / 2];
            swept.ends.at(end) = capped_end(swept.edge, end);
            beside.ends.at(partner % 2) = capped_end(beside.edge, partner % 2);
            swept.partners.at(end) = kNoEnd;
            beside.partners.at(partner % 2) = kNoEnd;
            to_look_at.push_back(partner / 2);
        }
    }
}

}  // namespace modelsynth::continuous
