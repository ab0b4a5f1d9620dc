#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/parameters.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/reading/figures.h"
#include "solver/continuous/reading/nudge.h"
#include "solver/continuous/reading/topes.h"
#include "solver/continuous/shapes/bounding_volumes.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

// What a request changes of how its example is read.
struct ReadingOptions {
    Variants variants;
    std::vector<ObjectId> apart;  // those that become objects of their own; see turned_apart()
    // Those that shapes need images for, mirrors filled in; see shape_images.h.
    std::vector<SymmetryRule> symmetries;
    std::vector<BoundingVolume> bounding_volumes;
    double nudge_degrees = 0;
    std::array<double, 3> steps = {};  // of the lattice to nudge to, metres; or 0

    friend bool operator==(const ReadingOptions&, const ReadingOptions&) = default;
};

// An example and what was read from it: all that most requests do not change. Thread-safe.
class ExampleReading {
  public:
    // Fails: kInvalidArgument with all that find_solid_faults() finds, and when its ground is bare
    // nowhere, so that nothing could be begun with; as find_families(), Topes::make() and
    // read_figures(); kTooLarge.
    [[nodiscard]] static Result<std::shared_ptr<const ExampleReading>> make(
        Example example, ReadingOptions options = {}
    );

    // The same example as a request with these parameters has it read: itself, as a rule. What is
    // read anew is kept while anyone has it. Requires: defaults filled in.
    // Fails: kInvalidArgument, as bounding_volumes_of(); kTooLarge.
    [[nodiscard]] static Result<std::shared_ptr<const ExampleReading>> read_for(
        const std::shared_ptr<const ExampleReading>& reading, const Parameters& parameters
    );

    ExampleReading(const ExampleReading&) = delete;
    ExampleReading& operator=(const ExampleReading&) = delete;

    [[nodiscard]] const Example& example() const { return example_; }

    [[nodiscard]] const ReadingOptions& options() const { return options_; }

    // Of its models, whose faces may be nudged.
    [[nodiscard]] const Topes& topes() const { return topes_; }

    [[nodiscard]] const Figures& figures() const { return *figures_; }

    // The family of a normal or its opposite, of any length: one that faces of the example have, or
    // have once they are nudged.
    [[nodiscard]] std::optional<std::size_t> find_family(const Point& normal) const;

    // Null when nothing was turned: it was not asked for, or need not or cannot be.
    [[nodiscard]] const Nudged* nudged() const { return nudged_ ? &*nudged_ : nullptr; }

    // Relation h: what may stand at the far end of an edge along heading h.
    [[nodiscard]] const Relations& relations() const { return *relations_; }

    // The family of horizontal planes; nothing when there is none.
    [[nodiscard]] std::optional<std::size_t> horizontal() const;

  private:
    [[nodiscard]] static Result<std::shared_ptr<ExampleReading>> make_unshared(
        Example example, ReadingOptions options
    );

    ExampleReading(Example example, ReadingOptions options, std::vector<Point> normals, Topes topes)
        : example_(std::move(example)),
          options_(std::move(options)),
          normals_(std::move(normals)),
          topes_(std::move(topes)) {}

    std::shared_ptr<const ExampleReading> plain_;  // without options; null: this is it
    Example example_;
    ReadingOptions options_;
    std::vector<Point> normals_;  // by family, as faces of the example have them
    std::optional<Nudged> nudged_;
    Topes topes_;
    std::optional<Figures> figures_;  // refers to topes_
    std::optional<Relations> relations_;
    mutable std::mutex mutex_;
    mutable std::vector<std::pair<ReadingOptions, std::weak_ptr<const ExampleReading>>> others_;
};

}  // namespace modelsynth::continuous
