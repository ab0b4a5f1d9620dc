#include "solver/continuous/symmetry/motion.h"

namespace modelsynth::continuous {

using Kind = SymmetryRule::Kind;

Motion motion_of(const SymmetryRule& rule, const std::array<double, 3>& size) {
    Motion motion = {Eigen::Matrix3d::Identity(), Point::Zero()};
    switch (rule.kind) {
        case Kind::kReflectX:
            motion.turn(0, 0) = -1;
            break;
        case Kind::kReflectZ:
            motion.turn(2, 2) = -1;
            break;
        case Kind::kHalfTurn:
            motion.turn(0, 0) = motion.turn(2, 2) = -1;
            break;
        case Kind::kQuarterTurn:
            motion.turn << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // x to -z: the east to the north
            break;
        case Kind::kTranslate:
            motion.shift = Point(rule.translation[0], rule.translation[1], rule.translation[2]);
            return motion;
    }
    const Point middle(size[0] / 2, 0, size[2] / 2);
    motion.shift = middle - motion.turn * middle;
    return motion;
}

std::size_t order_of(Kind kind) {
    return kind == Kind::kTranslate ? 0 : kind == Kind::kQuarterTurn ? 4 : 2;
}

}  // namespace modelsynth::continuous
