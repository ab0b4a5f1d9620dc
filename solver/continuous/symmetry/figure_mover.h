#pragma once

#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/topes.h"
#include "solver/core/label_set.h"

#include <Eigen/Core>

#include <vector>

namespace modelsynth::continuous {

// Figures as a turn and a map of objects leave them. Thread-safe.
class FigureMover {
  public:
    // Requires: every family has an image by the turn.
    FigureMover(const Topes& topes, const Eigen::Matrix3d& turn);

    // Shape: the image of every object, empty space first.
    [[nodiscard]] Figure moved(const Figure& figure, const std::vector<Label>& objects) const;

  private:
    std::vector<Tope> images_;  // by tope
};

}  // namespace modelsynth::continuous
