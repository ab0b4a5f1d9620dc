#pragma once

#include "solver/continuous/analysis.h"
#include "solver/continuous/origin.h"
#include "solver/continuous/parameters.h"
#include "solver/core/observer.h"
#include "solver/core/result.h"
#include "solver/core/synthesis_stats.h"
#include "solver/discrete/analysis/analysis.h"
#include "solver/discrete/example.h"
#include "solver/discrete/origin.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/preparation.h"
#include "solver/mesh/scene.h"
#include "solver/registry/model_space.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string_view>
#include <variant>
#include <vector>

namespace modelsynth::continuous {
class ExampleReading;
class ProblemCache;
}  // namespace modelsynth::continuous

namespace modelsynth {

// The registry: what every solver looks like to the program that runs it. A new solver adds an
// alternative to the variants and a line to each function of task.cpp.
using Example = std::variant<
    std::shared_ptr<const discrete::Example>,
    std::shared_ptr<const continuous::ExampleReading>>;
using Parameters = std::variant<discrete::Parameters, continuous::Parameters>;
using Origin = std::variant<discrete::Origin, continuous::Origin>;

// "discrete", ...: the name under which requests ask for the solver of such examples.
[[nodiscard]] std::string_view solver_of(const Example& example);
[[nodiscard]] std::string_view name_of(const Example& example);

// Whether the labels of a solver's models stand in the cells of a grid.
[[nodiscard]] bool solver_has_cells(std::string_view solver);

struct Finished {
    Model model;
    SynthesisStats stats;
};

// Names of the labels, by label; nothing where labels have none.
[[nodiscard]] std::vector<std::string> label_names(const Example& example);

// The example as it was given, to look at, and its pieces side by side, where it has pieces.
[[nodiscard]] Scene example_scene(const Example& example);
[[nodiscard]] std::optional<Scene> pieces_scene(const Example& example);

// One request, checked and complete: all that a worker needs.
struct Task {
    Example example;
    Parameters parameters;  // defaults filled in
    std::uint64_t seed = 0;
    std::shared_ptr<const Origin> origin = nullptr;  // null: made from nothing
};

// The example as a request with these parameters has it read: with turned variants, for one.
// Equal requests get the same. Requires: defaults need not be filled in.
// Fails: kTooLarge.
[[nodiscard]] Result<Example> example_for(const Example& example, const Parameters& parameters);

// Whether labels of one mean what those of the other do, read from one and the same example.
[[nodiscard]] bool are_read_alike(const Example& one, const Example& other);

// Where the whole is proved to be made in one pass, that is the default (thesis 3.3.7).
[[nodiscard]] Parameters with_defaults(const Parameters& parameters, const Example& example);
[[nodiscard]] std::vector<Fault> find_faults(const Example& example, const Parameters& parameters);

// How large the model will be, in cells. Requires: defaults filled in.
[[nodiscard]] GridSize model_size(const Parameters& parameters);

// How it is cut into blocks; nothing where it is made at once. Requires: defaults filled in.
[[nodiscard]] std::optional<BlockLayout> block_layout(const Parameters& parameters);

// What solvers keep from task to task, so that requests that differ in their seed alone need not
// begin from nothing. It changes no result. Thread-safe.
struct Preparations {
    Preparations();
    ~Preparations();

    discrete::PreparationCache discrete;
    std::unique_ptr<continuous::ProblemCache> continuous;
};

// What the labels of a task's model stand for. Fails: as run(), where the example and the
// parameters alone tell so.
[[nodiscard]] Result<std::shared_ptr<const ModelSpace>> space_of(
    const Example& example,
    const Parameters& parameters,
    Preparations& preparations,
    const std::stop_token& stop = {}
);

// Runs the synthesis, from the start or from a checkpoint of the same task; see the solver's own
// header for what it ensures and how it fails. The number of threads changes no result.
[[nodiscard]] Result<Finished> run(
    const Task& task,
    Preparations& preparations,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from = nullptr,
    std::uint32_t threads = 1
);

// What can be said of an example before anything is made of it; see the solver's own header.
using Analysis = std::variant<discrete::Analysis, continuous::Analysis>;
[[nodiscard]] Result<Analysis> analyse(const Example& example, const std::stop_token& stop);

}  // namespace modelsynth
