#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/reading/topes.h"
#include "solver/core/label_set.h"
#include "solver/core/result.h"

#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace modelsynth::continuous {

// What stands around a point, as far as one can see from it (a vertex figure): the object in each
// cell of the central arrangement of all families, byte c for tope c. Equal figures are equal
// strings, which the Boolean expressions of the thesis (4.5.1) are a way to print.
using Figure = std::string;

// The figures of an example, numbered: the labels of continuous model synthesis (4.5.1-4.5.5).
// Closed under looking along any line: whatever one comes into from a figure is one, too.
// Thread-safe.
class Figures {
  public:
    // Requires: `topes` outlives it.
    // Fails: kTooLarge when there would be more than figures_max, or their tables would take long.
    [[nodiscard]] static Result<Figures> make(
        const Topes& topes, const std::vector<Figure>& seeds, std::size_t figures_max
    );

    [[nodiscard]] std::size_t count() const { return figures_.size(); }

    [[nodiscard]] const Figure& at(Label label) const { return *figures_[label]; }

    // kNoLabel when the example has no such figure.
    [[nodiscard]] Label find(const Figure& figure) const;

    // The families across whose planes the figure changes: at a vertex it may stand only where a
    // plane of each of them passes through.
    [[nodiscard]] FamilySet relevant(Label label) const { return relevant_[label]; }

    // What one comes into from the figure along a heading (4.5.5).
    [[nodiscard]] Label along(Label label, Heading heading) const {
        return along_[label * topes_.heading_count() + heading];
    }

    [[nodiscard]] const Topes& topes() const { return topes_; }

  private:
    explicit Figures(const Topes& topes) : topes_(topes) {}

    Label add(Figure figure);

    const Topes& topes_;
    std::unordered_map<Figure, Label> numbers_;
    std::vector<const Figure*> figures_;  // keys of numbers_, which stay where they are
    std::vector<FamilySet> relevant_;
    std::vector<Label> along_;
};

// The number of dimensions that the normals of some families span: 0 inside a solid or empty space,
// 1 on a face, 2 on an edge, 3 at a corner.
[[nodiscard]] int rank_of(const Topes& topes, FamilySet families);

// The figure that is the same object everywhere, ...
[[nodiscard]] Figure uniform_figure(const Topes& topes, ObjectId object);

// ... and that of one object below a family's plane and another above it.
[[nodiscard]] Figure face_figure(
    const Topes& topes, std::size_t family, ObjectId below, ObjectId above
);

// The figures that stand somewhere in the example: at every point that three of its faces have in
// common, between those on every edge, and on every face.
// Requires: the plane of every face, by polyhedron and face, of the families of these topes.
// Fails: kInvalidArgument where it cannot be told apart what is where, with the place; kTooLarge
// when it would take longer than this one's share of some seconds, of so many readings.
[[nodiscard]] Result<std::vector<Figure>> read_figures(
    const Example& example,
    std::span<const std::vector<FacePlane>> planes,
    const Topes& topes,
    std::size_t readings = 1
);

}  // namespace modelsynth::continuous
