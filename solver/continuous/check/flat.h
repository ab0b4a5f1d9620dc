#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/triangulation/triangulation.h"

#include <Eigen/Core>

namespace modelsynth::continuous {

inline double cross(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

inline double dot(const Point2& a, const Point2& b) { return a[0] * b[0] + a[1] * b[1]; }

inline Point2 minus(const Point2& a, const Point2& b) { return {a[0] - b[0], a[1] - b[1]}; }

// The point seen from the side to which the normal points, without the normal's greatest part: what
// is counter-clockwise about the normal stays so, and no place is computed anew.
inline Point2 flattened(const Point& point, const Point& normal) {
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const double u = point[(axis + 1) % 3];
    const double v = point[(axis + 2) % 3];
    return normal[axis] > 0 ? Point2{u, v} : Point2{v, u};
}

}  // namespace modelsynth::continuous
