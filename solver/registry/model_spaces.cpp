#include "solver/registry/model_spaces.h"

#include "solver/continuous/scene.h"
#include "solver/continuous/surface/surface.h"
#include "solver/discrete/box_labels.h"
#include "solver/discrete/scene.h"

#include <utility>

namespace modelsynth {

namespace {

class GridSpace final : public ModelSpace {
  public:
    GridSpace(std::shared_ptr<const discrete::Example> example, const GridSize& size)
        : example_(std::move(example)), size_(size) {}

    [[nodiscard]] GridSize size() const override { return size_; }

    [[nodiscard]] std::size_t site_count() const override { return size_.cell_count(); }

    [[nodiscard]] bool is_grid() const override { return true; }

    [[nodiscard]] std::vector<Label> copy_out(std::span<const Label> model, const Box& box)
        const override {
        std::vector<Label> labels;
        discrete::copy_out(size_, model, box, labels);
        return labels;
    }

    void copy_in(std::span<const Label> labels, const Box& box, std::span<Label> model)
        const override {
        discrete::copy_in(size_, labels, box, model);
    }

    [[nodiscard]] Scene make_scene(std::span<const Label> model, const Box& box) const override {
        return discrete::make_scene(*example_, size_, model, box);
    }

  private:
    std::shared_ptr<const discrete::Example> example_;
    GridSize size_;
};

class VertexSpace final : public ModelSpace {
  public:
    explicit VertexSpace(std::shared_ptr<const continuous::Problem> problem)
        : problem_(std::move(problem)) {}

    [[nodiscard]] GridSize size() const override { return problem_->arrangement.frame().cells; }

    [[nodiscard]] std::size_t site_count() const override {
        return problem_->arrangement.vertex_count();
    }

    [[nodiscard]] bool is_grid() const override { return false; }

    [[nodiscard]] std::vector<Label> copy_out(std::span<const Label> model, const Box& box)
        const override {
        std::vector<Label> labels;
        problem_->arrangement.for_each_vertex(box, [&](Site site) {
            labels.push_back(model[site]);
        });
        return labels;
    }

    void copy_in(std::span<const Label> labels, const Box& box, std::span<Label> model)
        const override {
        std::size_t next = 0;
        problem_->arrangement.for_each_vertex(box, [&](Site site) {
            model[site] = labels[next++];
        });
    }

    [[nodiscard]] Scene make_scene(std::span<const Label> model, const Box& box) const override {
        const continuous::Surface surface = continuous::make_surface(*problem_, model);
        if (box == Box::whole(size())) {
            return continuous::make_scene(*problem_->reading, surface);
        }
        const double cell = problem_->arrangement.frame().cell;
        const continuous::Bounds part = {
            continuous::Point(box.min.x, box.min.y, box.min.z) * cell,
            continuous::Point(box.max.x, box.max.y, box.max.z) * cell};
        return continuous::make_scene(*problem_->reading, surface, part);
    }

  private:
    std::shared_ptr<const continuous::Problem> problem_;
};

}  // namespace

std::shared_ptr<const ModelSpace> make_grid_space(
    std::shared_ptr<const discrete::Example> example, const GridSize& size
) {
    return std::make_shared<const GridSpace>(std::move(example), size);
}

std::shared_ptr<const ModelSpace> make_vertex_space(
    std::shared_ptr<const continuous::Problem> problem
) {
    return std::make_shared<const VertexSpace>(std::move(problem));
}

}  // namespace modelsynth
