#include "solver/registry/task.h"

#include "solver/discrete/analysis/infallibility.h"
#include "solver/discrete/faults.h"
#include "solver/discrete/scene.h"
#include "solver/discrete/synthesis.h"

#include <algorithm>
#include <string>
#include <utility>

namespace modelsynth {

namespace {

// With one solver the variants have one alternative; std::get picks it. The next solver turns
// these into visits.
const discrete::Example& discrete_of(const Example& example) {
    return *std::get<std::shared_ptr<const discrete::Example>>(example);
}

const discrete::Parameters& discrete_of(const Parameters& parameters) {
    return std::get<discrete::Parameters>(parameters);
}

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

std::string_view solver_of(const Example& /*example*/) { return "discrete"; }

std::string_view name_of(const Example& example) { return discrete_of(example).name; }

std::vector<std::string> label_names(const Example& example) {
    std::vector<std::string> names;
    for (const discrete::Piece& piece : discrete_of(example).pieces) {
        names.push_back(piece.name);
    }
    return names;
}

Scene example_scene(const Example& example) {
    const discrete::Example& grid = discrete_of(example);
    if (grid.size.cell_count() == 0) {
        return discrete::make_piece_sheet(grid);  // rules without an arrangement
    }
    return discrete::make_scene(grid, grid.size, grid.cells, Box::whole(grid.size));
}

Scene pieces_scene(const Example& example) {
    return discrete::make_piece_sheet(discrete_of(example));
}

Parameters with_defaults(const Parameters& parameters, const Example& example) {
    const discrete::Parameters& given = discrete_of(parameters);
    discrete::Parameters filled = discrete::fill_defaults(given, discrete_of(example));
    if (!given.blocks && is_made_in_one_pass(filled, discrete_of(example))) {
        filled.blocks.emplace(std::nullopt);
    }
    return filled;
}

std::vector<Fault> find_faults(const Example& example, const Parameters& parameters) {
    return discrete::find_faults(discrete_of(example), discrete_of(parameters));
}

GridSize model_size(const Parameters& parameters) { return *discrete_of(parameters).size; }

Result<Finished> run(
    const Task& task,
    Preparations& preparations,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    const auto& example = std::get<std::shared_ptr<const discrete::Example>>(task.example);
    const discrete::Parameters& parameters = discrete_of(task.parameters);
    // What starts from one model is of no use to the next request.
    const auto preparation =
        task.origin == nullptr
            ? preparations.discrete.find_or_make(example, parameters)
            : discrete::Preparation::make(example, parameters, task.origin.get());
    if (!preparation) {
        return tl::unexpected(preparation.error());
    }
    auto made = discrete::synthesise(**preparation, task.seed, observer, stop, from, threads);
    if (!made) {
        return tl::unexpected(std::move(made.error()));
    }
    return Finished{{made->size, std::move(made->labels)}, std::move(made->stats)};
}

Result<Analysis> analyse(const Example& example, const std::stop_token& stop) {
    auto analysis = discrete::analyse(discrete_of(example), stop);
    if (!analysis) {
        return tl::unexpected(std::move(analysis.error()));
    }
    return Analysis(std::move(*analysis));
}

Scene make_scene(const Example& example, const Model& model, const Box& region) {
    return discrete::make_scene(discrete_of(example), model.size, model.labels, region);
}

}  // namespace modelsynth
