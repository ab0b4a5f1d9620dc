#include "solver/continuous/symmetry/plane_images.h"

#include <algorithm>

namespace modelsynth::continuous {

namespace {

constexpr double kSamePlace = 1e-6;  // of the model's extent

}  // namespace

bool has_plane_at(const PlaneOffsets& planes, double offset, double tolerance) {
    const auto next = std::lower_bound(planes.begin(), planes.end(), offset - tolerance);
    return next != planes.end() && *next <= offset + tolerance;
}

std::optional<FamilyImage> family_image(
    const Topes& topes, std::size_t family, const Eigen::Matrix3d& turn
) {
    const Point normal = turn * topes.normals()[family];
    const auto image = topes.find_family(normal);
    if (!image) {
        return std::nullopt;
    }
    return FamilyImage{*image, normal.dot(topes.normals()[*image]) < 0};
}

bool have_images(const Topes& topes, const Eigen::Matrix3d& turn) {
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        if (!family_image(topes, family, turn)) {
            return false;
        }
    }
    return true;
}

std::optional<double> plane_without_image(
    const Topes& topes,
    std::size_t family,
    const Motion& motion,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
) {
    const FamilyImage image = family_image(topes, family, motion.turn).value();
    const Point& normal = topes.normals()[image.family];
    const double sign = image.is_turned_round ? -1 : 1;
    const PlaneOffsets& others = planes[image.family];
    double low = 0;
    double high = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = normal[axis] * size[static_cast<std::size_t>(axis)];
        low += std::min(0.0, reach);
        high += std::max(0.0, reach);
    }
    const double tolerance = kSamePlace * (high - low);
    for (const double offset : planes[family]) {
        const double moved = sign * offset + normal.dot(motion.shift);
        const bool is_inside = moved > low + tolerance && moved < high - tolerance;
        if (is_inside && !has_plane_at(others, moved, tolerance)) {
            return offset;
        }
    }
    return std::nullopt;
}

}  // namespace modelsynth::continuous
