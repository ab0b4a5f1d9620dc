#include "solver/continuous/surface/plane_index.h"

#include <algorithm>
#include <cmath>

namespace modelsynth::continuous {

namespace {

Bounds bounds_of(const Surface& surface, const SurfacePolygon& polygon) {
    const Point& first = surface.points[polygon.loops.front().front()];
    Bounds bounds = {first, first};
    for (const std::uint32_t point : polygon.loops.front()) {
        bounds.min = bounds.min.cwiseMin(surface.points[point]);
        bounds.max = bounds.max.cwiseMax(surface.points[point]);
    }
    return bounds;
}

}  // namespace

PlaneIndex::PlaneIndex(const Surface& surface, const Topes& topes) : normals_(topes.normals()) {
    Bounds all;
    for (const Point& point : surface.points) {
        all.min = all.min.cwiseMin(point);
        all.max = all.max.cwiseMax(point);
    }
    tolerance_ = 1e-7 * std::max(1e-9, (all.max - all.min).maxCoeff());
    for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
        const SurfacePolygon& polygon = surface.polygons[p];
        extents_.push_back(bounds_of(surface, polygon));
        if (polygon.family != kNoFamily) {
            const Point& point = surface.points[polygon.loops.front().front()];
            planes_[{polygon.family, step_of(normals_[polygon.family].dot(point))}]
                .polygons.push_back(p);
        }
    }
    for (auto& [key, plane] : planes_) {
        divide(plane);
    }
}

void PlaneIndex::find(const Point& point, std::vector<std::size_t>& polygons) const {
    for (std::size_t family = 0; family < normals_.size(); ++family) {
        const std::int64_t step = step_of(normals_[family].dot(point));
        auto at = planes_.lower_bound({family, step - 1});
        for (; at != planes_.end() && at->first <= Key(family, step + 1); ++at) {
            const Plane& plane = at->second;
            const double along = (point[plane.axis] - plane.low) / plane.width;
            const auto last = static_cast<double>(plane.buckets.size() - 1);
            const auto bucket = static_cast<std::size_t>(std::clamp(std::floor(along), 0.0, last));
            for (const std::size_t polygon : plane.buckets[bucket]) {
                if (touch(extents_[polygon], {point, point})) {
                    polygons.push_back(polygon);
                }
            }
        }
    }
}

void PlaneIndex::divide(Plane& plane) const {
    Bounds all = extents_[plane.polygons.front()];
    for (const std::size_t polygon : plane.polygons) {
        all.min = all.min.cwiseMin(extents_[polygon].min);
        all.max = all.max.cwiseMax(extents_[polygon].max);
    }
    const double length = (all.max - all.min).maxCoeff(&plane.axis);
    plane.low = all.min[plane.axis];
    plane.width = std::max(length / static_cast<double>(plane.polygons.size()), tolerance_);
    plane.buckets.resize(plane.polygons.size());
    const auto bucket_of = [&plane](double place) {
        const auto last = static_cast<double>(plane.buckets.size() - 1);
        return static_cast<std::size_t>(
            std::clamp(std::floor((place - plane.low) / plane.width), 0.0, last)
        );
    };
    for (const std::size_t polygon : plane.polygons) {
        const std::size_t first = bucket_of(extents_[polygon].min[plane.axis] - tolerance_);
        const std::size_t last = bucket_of(extents_[polygon].max[plane.axis] + tolerance_);
        for (std::size_t bucket = first; bucket <= last; ++bucket) {
            plane.buckets[bucket].push_back(polygon);
        }
    }
}

bool PlaneIndex::touch(const Bounds& a, const Bounds& b) const {
    return (a.min.array() <= b.max.array() + tolerance_).all() &&
           (b.min.array() <= a.max.array() + tolerance_).all();
}

std::int64_t PlaneIndex::step_of(double offset) const {
    return std::llround(offset / (8 * tolerance_));
}

}  // namespace modelsynth::continuous
