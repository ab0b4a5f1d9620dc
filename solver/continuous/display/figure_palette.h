#pragma once

#include "solver/continuous/example.h"

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// How the objects of an example are painted in a drawing. Not thread-safe.
class FigurePalette {
  public:
    explicit FigurePalette(const Example& example);

    // The colour of an object as #rrggbb, as it is, ...
    [[nodiscard]] std::string plain(ObjectId object) const;

    // ... of its surface with a normal, lit from above and left of the front, ...
    [[nodiscard]] std::string surface(ObjectId object, const Point& normal) const;

    // ... and a reference to the pattern of where it is cut by the cube's side of a normal.
    [[nodiscard]] std::string cut(ObjectId object, const Point& normal);

    // The patterns that were referred to, to stand in the drawing's <defs>.
    [[nodiscard]] std::string patterns() const;

  private:
    using Shade = std::array<double, 3>;  // sRGB, 0 ... 1

    std::vector<Shade> shades_;                        // by object; shades_[0] is not used
    std::set<std::pair<ObjectId, std::size_t>> used_;  // patterns, by object and side of the cube
};

}  // namespace modelsynth::continuous
