#include "solver/continuous/surface/borders.h"

#include <Eigen/Geometry>

#include <set>

namespace modelsynth::continuous {

namespace {}  // namespace

const std::vector<Border>& BorderTable::at(Label edge, Heading heading) {
    const auto [found, is_new] = known_.try_emplace({edge, heading}, std::vector<Border>());
    if (is_new) {
        fill(edge, heading, found->second);
    }
    return found->second;
}

void BorderTable::fill(Label edge, Heading heading, std::vector<Border>& borders) const {
    const Topes& topes = figures_.topes();
    const Figure& figure = figures_.at(edge);
    const Point along = topes.direction(heading);
    const FamilySet around = topes.lines()[heading / 2].families;
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        if ((around & only(family)) == 0 || (figures_.relevant(edge) & only(family)) == 0) {
            continue;
        }
        const Point left = topes.normals()[family].cross(along);
        const auto object_at = [&](double side, bool is_above) {
            FamilySet sides = topes.sides_along(heading);
            for (std::size_t other = 0; other < topes.family_count(); ++other) {
                const bool is_positive = other == family
                                             ? is_above
                                             : (around & only(other)) != 0 &&
                                                   side * topes.normals()[other].dot(left) > 0;
                sides |= is_positive ? only(other) : 0;
            }
            return static_cast<ObjectId>(figure[topes.tope_of(sides)]);
        };
        const ObjectId left_above = object_at(1, true);
        const ObjectId left_below = object_at(1, false);
        const ObjectId right_above = object_at(-1, true);
        const ObjectId right_below = object_at(-1, false);
        for (const ObjectId object : std::set{left_above, left_below, right_above, right_below}) {
            if (object == kEmpty) {
                continue;
            }
            for (const bool is_along_normal : {true, false}) {
                const auto is_face = [&](ObjectId above, ObjectId below) {
                    return is_along_normal ? below == object && above != object
                                           : above == object && below != object;
                };
                const bool on_left = is_face(left_above, left_below);
                const bool on_right = is_face(right_above, right_below);
                if (on_left != on_right) {
                    borders.push_back(
                        {object,
                         static_cast<std::uint8_t>(family),
                         is_along_normal,
                         on_left == is_along_normal}
                    );
                }
            }
        }
    }
}

bool CornerTable::at(Label label, ObjectId object) {
    const auto [found, is_new] = known_.try_emplace({label, object}, false);
    if (is_new) {
        const Topes& topes = figures_.topes();
        const Figure& figure = figures_.at(label);
        FamilySet changing = 0;
        for (std::size_t tope = 0; tope < topes.count(); ++tope) {
            for (std::size_t family = 0; family < topes.family_count(); ++family) {
                const Tope beyond = topes.across(static_cast<Tope>(tope), family);
                const bool is_here = static_cast<ObjectId>(figure[tope]) == object;
                const bool is_beyond = static_cast<ObjectId>(figure[beyond]) == object;
                changing |= is_here != is_beyond ? only(family) : 0;
            }
        }
        found->second = rank_of(topes, changing) == 3;
    }
    return found->second;
}

}  // namespace modelsynth::continuous
