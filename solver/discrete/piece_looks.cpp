#include "solver/discrete/piece_looks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace modelsynth::discrete {

namespace {

constexpr std::size_t kX = 0;
constexpr std::size_t kZ = 2;

PieceLook look_of(const Mesh& mesh, double unit) {
    PieceLook look;
    std::array<double, 3> sum = {};
    std::array<double, 3> square = {};
    double product = 0;
    double count = 0;
    for (const Primitive& primitive : mesh.primitives) {
        for (const Vec3& corner : primitive.positions) {
            const std::array<double, 3> at = {
                double{corner.x} / unit, double{corner.y} / unit, double{corner.z} / unit};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto value = static_cast<float>(at[axis]);
                look.min[axis] = count == 0 ? value : std::min(look.min[axis], value);
                look.max[axis] = count == 0 ? value : std::max(look.max[axis], value);
                sum[axis] += at[axis];
                square[axis] += at[axis] * at[axis];
            }
            product += at[kX] * at[kZ];
            ++count;
        }
    }
    look.is_drawn = count > 0;
    for (std::size_t axis = 0; axis < 3 && count > 0; ++axis) {
        look.mean[axis] = static_cast<float>(sum[axis] / count);
        look.square[axis] = static_cast<float>(square[axis] / count);
    }
    look.product = count > 0 ? static_cast<float>(product / count) : 0;
    return look;
}

// In the middle of an axis.
void reflect(PieceLook& look, std::size_t axis) {
    look.min[axis] = -std::exchange(look.max[axis], -look.min[axis]);
    look.mean[axis] = -look.mean[axis];
    look.product = -look.product;
}

// A quarter turn is a reflection in the diagonal and then one in z.
void turn(PieceLook& look) {
    for (auto* numbers : {&look.min, &look.max, &look.mean, &look.square}) {
        std::swap((*numbers)[kX], (*numbers)[kZ]);
    }
    reflect(look, kZ);
}

}  // namespace

std::vector<PieceLook> piece_looks(const Example& example) {
    std::vector<PieceLook> of_meshes;
    for (const Mesh& mesh : example.kit->meshes) {
        of_meshes.push_back(look_of(mesh, std::max(example.cell[kX], example.cell[kZ])));
    }
    std::vector<PieceLook> looks;
    for (const Piece& piece : example.pieces) {
        PieceLook look = piece.mesh ? of_meshes.at(*piece.mesh) : PieceLook();
        for (int i = 0; i < piece.quarter_turns; ++i) {
            turn(look);
        }
        looks.push_back(look);
    }
    return looks;
}

PieceLook moved(const PieceLook& look, Symmetry::Kind kind) {
    PieceLook image = look;
    switch (kind) {
        case Symmetry::Kind::kReflectX:
            reflect(image, kX);
            break;
        case Symmetry::Kind::kReflectZ:
            reflect(image, kZ);
            break;
        case Symmetry::Kind::kHalfTurn:
            turn(image);
            turn(image);
            break;
        case Symmetry::Kind::kQuarterTurn:
            turn(image);
            break;
        case Symmetry::Kind::kTranslate:
            break;
    }
    return image;
}

float difference(const PieceLook& a, const PieceLook& b) {
    if (a.is_drawn != b.is_drawn) {
        return std::numeric_limits<float>::infinity();
    }
    float largest = std::fabs(a.product - b.product);
    for (const auto numbers :
         {&PieceLook::min, &PieceLook::max, &PieceLook::mean, &PieceLook::square}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            largest = std::max(largest, std::fabs((a.*numbers)[axis] - (b.*numbers)[axis]));
        }
    }
    return largest;
}

}  // namespace modelsynth::discrete
