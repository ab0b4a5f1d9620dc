#pragma once

#include "solver/core/grid.h"
#include "solver/core/observer.h"
#include "solver/core/result.h"
#include "solver/core/synthesis_stats.h"
#include "solver/discrete/analysis/analysis.h"
#include "solver/discrete/example.h"
#include "solver/discrete/origin.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/preparation.h"
#include "solver/mesh/scene.h"

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string_view>
#include <variant>
#include <vector>

namespace modelsynth {

// The registry: what every solver looks like to the program that runs it. A new solver adds an
// alternative to the variants and a line to each function of task.cpp.
using Example = std::variant<std::shared_ptr<const discrete::Example>>;
using Parameters = std::variant<discrete::Parameters>;

// "discrete", ...: the name under which requests ask for the solver of such examples.
[[nodiscard]] std::string_view solver_of(const Example& example);
[[nodiscard]] std::string_view name_of(const Example& example);

// What a synthesis makes, as far as it has come. A cell of kNoLabel is not made yet.
struct Model {
    GridSize size;
    std::vector<Label> labels;  // x fastest, then z, then y
};

struct Finished {
    Model model;
    SynthesisStats stats;
};

// Names of the labels, by label.
[[nodiscard]] std::vector<std::string> label_names(const Example& example);

// The example as it was given, to look at, and its pieces side by side.
[[nodiscard]] Scene example_scene(const Example& example);
[[nodiscard]] Scene pieces_scene(const Example& example);

// One request, checked and complete: all that a worker needs.
struct Task {
    Example example;
    Parameters parameters;  // defaults filled in
    std::uint64_t seed = 0;
    std::shared_ptr<const discrete::Origin> origin = nullptr;  // null: made from nothing
};

// Where the whole is proved to be made in one pass, that is the default (thesis 3.3.7).
[[nodiscard]] Parameters with_defaults(const Parameters& parameters, const Example& example);
[[nodiscard]] std::vector<Fault> find_faults(const Example& example, const Parameters& parameters);

// How large the model will be.
[[nodiscard]] GridSize model_size(const Parameters& parameters);

// What solvers keep from task to task, so that requests that differ in their seed alone need not
// begin from nothing. It changes no result. Thread-safe.
struct Preparations {
    discrete::PreparationCache discrete;
};

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
using Analysis = std::variant<discrete::Analysis>;
[[nodiscard]] Result<Analysis> analyse(const Example& example, const std::stop_token& stop);

// A region of the model as a scene, in the whole model's frame.
[[nodiscard]] Scene make_scene(const Example& example, const Model& model, const Box& region);

}  // namespace modelsynth
