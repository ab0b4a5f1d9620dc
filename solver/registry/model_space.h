#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/mesh/scene.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace modelsynth {

// What the labels of a model stand for: the cells of a grid, or points that lie in such cells. To
// whoever keeps and sends models a label has a number, and blocks are boxes of cells. Thread-safe.
class ModelSpace {
  public:
    ModelSpace() = default;
    ModelSpace(const ModelSpace&) = delete;
    ModelSpace& operator=(const ModelSpace&) = delete;
    virtual ~ModelSpace() = default;

    [[nodiscard]] virtual GridSize size() const = 0;

    // How many labels a model has.
    [[nodiscard]] virtual std::size_t site_count() const = 0;

    // Whether there is one site a cell, so that labels mean something to whoever knows the grid.
    [[nodiscard]] virtual bool is_grid() const = 0;

    // The labels of a box, in the order of sites: out of the model and back into it.
    // Shape: `labels` has as many as the box has sites.
    [[nodiscard]] virtual std::vector<Label> copy_out(std::span<const Label> model, const Box& box)
        const = 0;
    virtual void copy_in(std::span<const Label> labels, const Box& box, std::span<Label> model)
        const = 0;

    // The part of a model in a box as a scene, in the whole model's frame. What is not made yet is
    // left out.
    [[nodiscard]] virtual Scene make_scene(std::span<const Label> model, const Box& box) const = 0;
};

// What a synthesis makes, as far as it has come. A site of kNoLabel is not made yet.
struct Model {
    std::shared_ptr<const ModelSpace> space;
    std::vector<Label> labels;  // by site
};

// All of a model.
[[nodiscard]] inline Scene whole_scene(const Model& model) {
    return model.space->make_scene(model.labels, Box::whole(model.space->size()));
}

}  // namespace modelsynth
