#pragma once

#include "solver/continuous/example.h"
#include "solver/continuous/families.h"
#include "solver/continuous/figures.h"
#include "solver/continuous/topes.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"

#include <memory>
#include <optional>

namespace modelsynth::continuous {

// An example and what was read from it: all that does not depend on a request. Thread-safe.
class ExampleReading {
  public:
    // Fails: kInvalidArgument with all that find_solid_faults() finds, and when its ground is bare
    // nowhere, so that nothing could be begun with; as find_families(), Topes::make() and
    // read_figures(); kTooLarge.
    [[nodiscard]] static Result<std::shared_ptr<const ExampleReading>> make(Example example);

    ExampleReading(const ExampleReading&) = delete;
    ExampleReading& operator=(const ExampleReading&) = delete;

    [[nodiscard]] const Example& example() const { return example_; }

    [[nodiscard]] const Families& families() const { return families_; }

    [[nodiscard]] const Topes& topes() const { return topes_; }

    [[nodiscard]] const Figures& figures() const { return *figures_; }

    // Relation h: what may stand at the far end of an edge along heading h.
    [[nodiscard]] const Relations& relations() const { return *relations_; }

    // The family of horizontal planes; nothing when there is none.
    [[nodiscard]] std::optional<std::size_t> horizontal() const;

  private:
    ExampleReading(Example example, Families families, Topes topes)
        : example_(std::move(example)), families_(std::move(families)), topes_(std::move(topes)) {}

    Example example_;
    Families families_;
    Topes topes_;
    std::optional<Figures> figures_;  // refers to topes_
    std::optional<Relations> relations_;
};

}  // namespace modelsynth::continuous
