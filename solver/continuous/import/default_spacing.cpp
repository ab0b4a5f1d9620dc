#include "solver/continuous/import/default_spacing.h"

#include "solver/continuous/reading/families.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace modelsynth::continuous {

namespace {

// What is thinner is noise or decoration.
constexpr double kThinnest = 1e-3;

}  // namespace

double default_spacing(const Example& example) {
    const auto families = find_families(std::span(&example, 1));
    if (!families) {
        return 1;  // the example is refused for that when it is read
    }
    std::vector<std::vector<double>> offsets(families->normals.size());
    for (const std::vector<FacePlane>& planes : families->planes) {
        for (const FacePlane& plane : planes) {
            if (plane.family != kNoFamily) {
                offsets[plane.family].push_back(plane.offset);
            }
        }
    }
    const double thinnest = kThinnest * extent_of(example);
    double spacing = std::numeric_limits<double>::infinity();
    for (std::size_t family = 0; family < offsets.size(); ++family) {
        std::vector<double>& places = offsets[family];
        if (example.ground && families->normals[family].y() > 1 - kNormalTolerance) {
            places.push_back(0);
        }
        std::sort(places.begin(), places.end());
        for (std::size_t low = 0, high = 0; high < places.size(); ++high) {
            while (places[high] - places[low] > thinnest) {
                ++low;
            }
            if (low > 0) {
                spacing = std::min(spacing, places[high] - places[low - 1]);
            }
        }
    }
    return std::isfinite(spacing) ? spacing : 1;
}

}  // namespace modelsynth::continuous
