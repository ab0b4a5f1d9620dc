#pragma once

#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/topes.h"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// A border of an object in a plane along an edge.
struct Border {
    ObjectId object = 0;
    std::uint8_t family = 0;
    bool is_along_normal = true;
    bool is_forth = true;  // it runs along the heading of the edge, not against it
};

// What a figure along a line says of borders along it. Requires: the figures outlive it.
class BorderTable {
  public:
    explicit BorderTable(const Figures& figures) : figures_(figures) {}

    const std::vector<Border>& at(Label edge, Heading heading);

  private:
    void fill(Label edge, Heading heading, std::vector<Border>& borders) const;

    const Figures& figures_;
    std::map<std::pair<Label, Heading>, std::vector<Border>> known_;
};

// Whether an object has a corner where a figure stands: it changes across planes that are not all
// along one line. Requires: the figures outlive it.
class CornerTable {
  public:
    explicit CornerTable(const Figures& figures) : figures_(figures) {}

    bool at(Label label, ObjectId object);

  private:
    const Figures& figures_;
    std::map<std::pair<Label, ObjectId>, bool> known_;
};

}  // namespace modelsynth::continuous
