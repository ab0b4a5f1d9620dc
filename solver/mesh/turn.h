#pragma once

#include "solver/mesh/mesh.h"

namespace modelsynth {

// The vector turned by quarter turns about the vertical axis, counter-clockwise from above: one
// turn takes east (+x) to north (-z). Exact.
[[nodiscard]] constexpr Vec3 turned(const Vec3& v, int quarter_turns) {
    switch ((quarter_turns % 4 + 4) % 4) {
        case 1:
            return {v.z, v.y, -v.x};
        case 2:
            return {-v.x, v.y, -v.z};
        case 3:
            return {-v.z, v.y, v.x};
        default:
            return v;
    }
}

}  // namespace modelsynth
