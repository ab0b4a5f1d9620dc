#include "solver/registry/task.h"

#include "solver/continuous/decoration/placed_decorations.h"
#include "solver/continuous/faults.h"
#include "solver/continuous/problem_cache.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/scene.h"
#include "solver/continuous/shapes/placed_shapes.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/synthesis.h"
#include "solver/continuous/warnings.h"
#include "solver/discrete/analysis/infallibility.h"
#include "solver/discrete/faults.h"
#include "solver/discrete/likely_mirror.h"
#include "solver/discrete/scene.h"
#include "solver/discrete/synthesis.h"
#include "solver/registry/model_spaces.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {

namespace {

using DiscreteExample = std::shared_ptr<const discrete::Example>;
using Solids = std::shared_ptr<const continuous::ExampleReading>;

// One of several functions, by the type of its argument.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

// Models of so many cells are made whole within some ten milliseconds; larger ones in blocks all
// the same, so that there is something to watch and work for several threads.
constexpr std::size_t kWholeCellsMax = std::size_t{1} << 18;

// Whether the whole is made in one pass without a dead end, as far as that is proved (thesis
// 3.3.7): then blocks would only cost time.
bool is_made_in_one_pass(const discrete::Parameters& parameters, const discrete::Example& example) {
    const auto is_free = [](const auto& side) {
        return side->kind == discrete::BoundaryKind::kFree;
    };
    const auto* list = std::get_if<discrete::WeightList>(&*parameters.weights);
    const bool removes_none =
        list == nullptr ||
        std::all_of(list->begin(), list->end(), [](const auto& named) { return named.second > 0; });
    return parameters.size->cell_count() <= kWholeCellsMax &&
           parameters.order == discrete::CellOrder{} && parameters.constraints.empty() &&
           std::all_of(parameters.boundary.begin(), parameters.boundary.end(), is_free) &&
           removes_none && discrete::is_proved_infallible(example);
}

}  // namespace

Preparations::Preparations() : continuous(std::make_unique<continuous::ProblemCache>()) {}

Preparations::~Preparations() = default;

std::string_view solver_of(const Example& example) {
    return std::visit(
        Overloaded{
            [](const DiscreteExample&) { return "discrete"; },
            [](const Solids&) { return "continuous"; }},
        example
    );
}

std::string_view name_of(const Example& example) {
    return std::visit(
        Overloaded{
            [](const DiscreteExample& grid) -> std::string_view { return grid->name; },
            [](const Solids& solids) -> std::string_view { return solids->example().name; }},
        example
    );
}

bool solver_has_cells(std::string_view solver) { return solver != "continuous"; }

std::vector<std::string> label_names(const Example& example) {
    std::vector<std::string> names;
    if (const auto* grid = std::get_if<DiscreteExample>(&example)) {
        for (const discrete::Piece& piece : (*grid)->pieces) {
            names.push_back(piece.name);
        }
    }
    return names;
}

Scene example_scene(const Example& example) {
    return std::visit(
        Overloaded{
            [](const DiscreteExample& grid) {
                return grid->size.cell_count() == 0  // rules without an arrangement
                           ? discrete::make_piece_sheet(*grid)
                           : discrete::make_scene(
                                 *grid, grid->size, grid->cells, Box::whole(grid->size)
                             );
            },
            [](const Solids& solids) { return continuous::make_example_scene(*solids); }},
        example
    );
}

std::optional<Scene> pieces_scene(const Example& example) {
    const auto* grid = std::get_if<DiscreteExample>(&example);
    return grid == nullptr ? std::nullopt : std::optional(discrete::make_piece_sheet(**grid));
}

Result<Example> example_for(const Example& example, const Parameters& parameters) {
    const auto* solids = std::get_if<Solids>(&example);
    if (solids == nullptr) {
        return example;
    }
    const continuous::Parameters filled = continuous::fill_defaults(
        std::get<continuous::Parameters>(parameters), (*solids)->example()
    );
    return continuous::ExampleReading::read_for(*solids, filled).map([](auto reading) -> Example {
        return reading;
    });
}

bool are_read_alike(const Example& one, const Example& other) {
    const auto* solids = std::get_if<Solids>(&one);
    return solids == nullptr || (*solids)->options() == std::get<Solids>(other)->options();
}

Parameters with_defaults(const Parameters& parameters, const Example& example) {
    return std::visit(
        Overloaded{
            [&](const DiscreteExample& grid) -> Parameters {
                const auto& given = std::get<discrete::Parameters>(parameters);
                discrete::Parameters filled = discrete::fill_defaults(given, *grid);
                discrete::fill_mirrors(*grid, filled);
                if (!given.blocks && is_made_in_one_pass(filled, *grid)) {
                    filled.blocks.emplace(std::nullopt);
                }
                return filled;
            },
            [&](const Solids& solids) -> Parameters {
                continuous::Parameters filled = continuous::fill_defaults(
                    std::get<continuous::Parameters>(parameters), solids->example()
                );
                continuous::fill_mirrors(*solids, filled);
                return filled;
            }},
        example
    );
}

std::vector<Fault> find_faults(const Example& example, const Parameters& parameters) {
    return std::visit(
        Overloaded{
            [&](const DiscreteExample& grid) {
                return discrete::find_faults(*grid, std::get<discrete::Parameters>(parameters));
            },
            [&](const Solids& solids) {
                return continuous::find_faults(
                    *solids, std::get<continuous::Parameters>(parameters)
                );
            }},
        example
    );
}

GridSize model_size(const Parameters& parameters) {
    return std::visit(
        Overloaded{
            [](const discrete::Parameters& grid) { return *grid.size; },
            [](const continuous::Parameters& solids) { return continuous::cells_of(solids); }},
        parameters
    );
}

std::optional<BlockLayout> block_layout(const Parameters& parameters) {
    return std::visit(
        [](const auto& of_solver) {
            return *of_solver.blocks ? std::optional((*of_solver.blocks)->layout) : std::nullopt;
        },
        parameters
    );
}

Result<std::shared_ptr<const ModelSpace>> space_of(
    const Example& example,
    const Parameters& parameters,
    Preparations& preparations,
    const std::stop_token& stop
) {
    using Space = std::shared_ptr<const ModelSpace>;
    if (const auto* grid = std::get_if<DiscreteExample>(&example)) {
        return make_grid_space(*grid, model_size(parameters));
    }
    return preparations.continuous
        ->find_or_make(
            std::get<Solids>(example), std::get<continuous::Parameters>(parameters), stop
        )
        .map([](auto problem) -> Space { return make_vertex_space(std::move(problem)); });
}

namespace {

Result<Finished> run_discrete(
    const Task& task,
    Preparations& preparations,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    const auto& example = std::get<DiscreteExample>(task.example);
    const auto& parameters = std::get<discrete::Parameters>(task.parameters);
    // What starts from one model is of no use to the next request.
    const auto preparation =
        task.origin == nullptr
            ? preparations.discrete.find_or_make(example, parameters, stop)
            : discrete::Preparation::make(
                  example, parameters, &std::get<discrete::Origin>(*task.origin), stop
              );
    if (!preparation) {
        return tl::unexpected(preparation.error());
    }
    auto made = discrete::synthesise(**preparation, task.seed, observer, stop, from, threads);
    if (!made) {
        return tl::unexpected(std::move(made.error()));
    }
    return Finished{
        {make_grid_space(example, made->size), std::move(made->labels)}, std::move(made->stats)};
}

Result<Finished> run_continuous(
    const Task& task,
    Preparations& preparations,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    const auto& parameters = std::get<continuous::Parameters>(task.parameters);
    const auto& solids = std::get<Solids>(task.example);
    const auto problem =
        task.origin == nullptr
            ? preparations.continuous->find_or_make(solids, parameters, stop)
            : continuous::make_problem(
                  solids, parameters, &std::get<continuous::Origin>(*task.origin), stop
              )
                  .map([](continuous::Problem made) {
                      return std::make_shared<const continuous::Problem>(std::move(made));
                  });
    if (!problem) {
        return tl::unexpected(problem.error());
    }
    std::vector<std::string> warnings = continuous::warnings_of(**problem);
    if (!warnings.empty()) {
        observer.on_warnings(warnings);
    }
    auto made =
        continuous::synthesise(**problem, parameters, task.seed, observer, stop, from, threads);
    if (!made) {
        return tl::unexpected(std::move(made.error()));
    }
    const continuous::Surface surface = continuous::make_surface(**problem, made->labels);
    made->stats.polygons = surface.polygons.size();
    made->stats.warnings = std::move(warnings);
    if (!surface.is_closed) {
        made->stats.warnings.emplace_back(
            "the model is open where a free side cuts it: faces are left out there"
        );
    }
    const continuous::PlacedShapes shapes = continuous::place_shapes(solids->example(), surface);
    if (shapes.are_too_many) {
        made->stats.warnings.emplace_back(
            "shapes would come to more than " + std::to_string(continuous::kShapeTrianglesMax) +
            " triangles, so that boxes stand in their places"
        );
    }
    const auto normals = solids->topes().normals();
    if (continuous::place_decorations(solids->example(), normals, surface, shapes).are_too_many) {
        made->stats.warnings.emplace_back(
            "decorations and shapes would come to more than " +
            std::to_string(continuous::kShapeTrianglesMax) +
            " triangles, so that there are no decorations"
        );
    }
    if (made->stats.changed == 0) {
        made->stats.warnings.emplace_back("nothing fits but what the model began as");
    }
    return Finished{{make_vertex_space(*problem), std::move(made->labels)}, std::move(made->stats)};
}

}  // namespace

Result<Finished> run(
    const Task& task,
    Preparations& preparations,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    return std::holds_alternative<DiscreteExample>(task.example)
               ? run_discrete(task, preparations, observer, stop, from, threads)
               : run_continuous(task, preparations, observer, stop, from, threads);
}

Result<Analysis> analyse(const Example& example, const std::stop_token& stop) {
    if (const auto* solids = std::get_if<Solids>(&example)) {
        return Analysis(continuous::analyse(**solids));
    }
    auto analysis = discrete::analyse(*std::get<DiscreteExample>(example), stop);
    if (!analysis) {
        return tl::unexpected(std::move(analysis.error()));
    }
    return Analysis(std::move(*analysis));
}

}  // namespace modelsynth
