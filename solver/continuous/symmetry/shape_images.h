#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/example.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/topes.h"
#include "solver/continuous/reading/variants.h"

#include <span>
#include <vector>

namespace modelsynth::continuous {

// Shapes in models with symmetries. What stands for a box looks some way, and where it grows evenly
// its box is cut some way; its image may look and be cut otherwise. Such an image is an object of
// its own (ObjectType::variant_of), and the example is read as if it had the figures with it.

// The symmetries of a request that turn or reflect, in their order, if there is a shape that is
// not its own image by one of them, or is read with variants; or else none. Requires: defaults
// filled in.
[[nodiscard]] std::vector<SymmetryRule> symmetries_of_shapes(
    const Example& example, const Parameters& parameters
);

// The objects with shapes, and what was cut off them, by number in rising order.
[[nodiscard]] std::vector<ObjectId> shapes_of(const Example& example);

// What the rules turn a model by.
[[nodiscard]] std::vector<TurnMatrix> turns_of(std::span<const SymmetryRule> rules);

// The image of every object, empty space first: that of a shape as it becomes by the turn, where
// there is one, and else as `mirror` says. Requires: the objects of the mirror are known.
[[nodiscard]] std::vector<Label> object_images(const Example& example, const SymmetryRule& rule);

// Whether an object's image follows from its shape, so that `mirror` has nothing to say.
[[nodiscard]] bool has_image_by_shape(const Example& example, ObjectId object);

// Adds the images of all figures with such shapes, and theirs; of more than `count_max` figures no
// more are added. Those of the example come first. Nothing is added where a family has no image,
// which is a fault of the request.
void add_images_of_shapes(
    std::vector<Figure>& figures,
    const Topes& topes,
    const Example& example,
    std::span<const SymmetryRule> rules,
    std::size_t count_max
);

}  // namespace modelsynth::continuous
