#include "solver/continuous/decoration/face_choice.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace modelsynth::continuous {

namespace {

constexpr double kLevel = 1e-9;           // normals are horizontal or upright so nearly
constexpr double kSameCosine = 1 - 1e-6;  // people give some three decimal places

bool find_others(
    std::span<const FaceChoice> choices,
    std::span<const Point> normals,
    std::vector<std::uint8_t>& is_taken
) {
    if (choices.empty()) {
        return true;
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (is_taken[i] == 0 && is_chosen(choices.front(), normals[i])) {
            is_taken[i] = 1;
            if (find_others(choices.subspan(1), normals, is_taken)) {
                return true;
            }
            is_taken[i] = 0;
        }
    }
    return false;
}

}  // namespace

bool is_chosen(const FaceChoice& choice, const Point& normal) {
    const double y = normal.y();
    switch (choice.kind) {
        case FaceKind::kAny:
            return true;
        case FaceKind::kUp:
            return y >= 1 - kLevel;
        case FaceKind::kDown:
            return y <= -1 + kLevel;
        case FaceKind::kSide:
            return std::abs(y) <= kLevel;
        case FaceKind::kSlope:
            return y > kLevel && y < 1 - kLevel;
        case FaceKind::kOverhang:
            return y < -kLevel && y > -1 + kLevel;
        case FaceKind::kNormal:
            return Point(choice.normal.data()).normalized().dot(normal) >= kSameCosine;
    }
    return false;
}

bool are_chosen(std::span<const FaceChoice> choices, std::span<const Point> normals) {
    std::vector<std::uint8_t> is_taken(normals.size());
    return find_others(choices, normals, is_taken);
}

}  // namespace modelsynth::continuous
