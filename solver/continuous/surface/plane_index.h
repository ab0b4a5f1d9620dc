#pragma once

#include "solver/continuous/reading/topes.h"
#include "solver/continuous/surface/surface.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// Finds the polygons of a surface that lie in a plane of some family and are near a point: those
// within whose boxes it is. Polygons in sides of the model's box are not known here.
// Cost: about that of what is found, where polygons of one plane are of about one size.
// Thread-safe.
class PlaneIndex {
  public:
    // Requires: the surface outlives it.
    PlaneIndex(const Surface& surface, const Topes& topes);

    // Of all families, in no order. Each once a family.
    void find(const Point& point, std::vector<std::size_t>& polygons) const;

    // Calls visit(a, b) for polygons of one plane whose boxes touch; each pair at least once.
    template <class Visit>
    void for_each_touching(Visit visit) const {
        for (const auto& [key, plane] : planes_) {
            for (const std::vector<std::size_t>& bucket : plane.buckets) {
                for (std::size_t i = 0; i < bucket.size(); ++i) {
                    for (std::size_t j = 0; j < i; ++j) {
                        if (touch(extents_[bucket[i]], extents_[bucket[j]])) {
                            visit(bucket[j], bucket[i]);
                        }
                    }
                }
            }
        }
    }

  private:
    // Polygons by where they are along the axis in which they are spread most.
    struct Plane {
        std::vector<std::size_t> polygons;
        Eigen::Index axis = 0;
        double low = 0;
        double width = 1;  // of a bucket
        std::vector<std::vector<std::size_t>> buckets;
    };

    using Key = std::pair<std::size_t, std::int64_t>;  // family, and the offset in tolerances

    void divide(Plane& plane) const;
    [[nodiscard]] bool touch(const Bounds& a, const Bounds& b) const;
    [[nodiscard]] std::int64_t step_of(double offset) const;

    std::span<const Point> normals_;
    double tolerance_;
    std::vector<Bounds> extents_;  // by polygon
    std::map<Key, Plane> planes_;
};

}  // namespace modelsynth::continuous
