#pragma once

#include "solver/core/label_set.h"
#include "solver/core/relations.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {

// The images of all labels: those given, and each label itself where nothing is. Labels of a chain
// a to b to c that does not say where it ends, go on from its end to its beginning, so that a pair
// is named once.
// Shape: by label. Requires: every label is below the count.
[[nodiscard]] std::vector<Label> label_images(
    std::size_t label_count, std::span<const std::pair<Label, Label>> given
);

// What is wrong with such a list, if anything is: two labels with the same image, or, where steps
// is not 0, one that does not come back to itself after so many.
[[nodiscard]] std::optional<std::string> find_image_fault(
    std::size_t label_count, std::span<const std::pair<Label, Label>> given, std::size_t steps
);

// Relations with two more for each map of labels to their images (kNoLabel: none): the first of
// them allows each label its image alone, the second is its reverse (2007 paper, 4.1).
// Requires: the reverse of relation r is r ^ 1.
[[nodiscard]] Relations relations_with_images(
    const Relations& relations, std::span<const std::vector<Label>> images
);

}  // namespace modelsynth
