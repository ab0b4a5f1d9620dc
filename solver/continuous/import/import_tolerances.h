#pragma once

#include <Eigen/Geometry>

#include <algorithm>

namespace modelsynth::continuous {

// Shares of the extent.
inline constexpr double kWeldTolerance = 1e-6;
inline constexpr double kMergeTolerance = 4e-7;  // twice this is flat enough for find_families()
inline constexpr double kGroundTolerance = 1e-4;

// How large what is read is, metres; never 0.
inline double extent_of(const Eigen::AlignedBox3d& box) {
    return box.isEmpty() ? 1 : std::max(box.sizes().maxCoeff(), 1e-6);
}

}  // namespace modelsynth::continuous
