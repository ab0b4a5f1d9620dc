#include "solver/continuous/symmetry/figure_mover.h"

#include "solver/continuous/symmetry/plane_images.h"

#include <cstddef>

namespace modelsynth::continuous {

FigureMover::FigureMover(const Topes& topes, const Eigen::Matrix3d& turn) {
    std::vector<FamilyImage> families;
    for (std::size_t i = 0; i < topes.family_count(); ++i) {
        families.push_back(family_image(topes, i, turn).value());
    }
    for (std::size_t t = 0; t < topes.count(); ++t) {
        FamilySet sides = 0;
        for (std::size_t i = 0; i < families.size(); ++i) {
            const bool is_above = (topes.sides(static_cast<Tope>(t)) >> i & 1) != 0;
            if (is_above != families[i].is_turned_round) {
                sides |= only(families[i].family);
            }
        }
        images_.push_back(topes.tope_of(sides));
    }
}

Figure FigureMover::moved(const Figure& figure, const std::vector<Label>& objects) const {
    Figure moved(figure.size(), 0);
    for (std::size_t t = 0; t < figure.size(); ++t) {
        moved[images_[t]] = static_cast<char>(objects[static_cast<ObjectId>(figure[t])]);
    }
    return moved;
}

}  // namespace modelsynth::continuous
