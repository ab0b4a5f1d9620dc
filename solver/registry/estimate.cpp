#include "solver/registry/estimate.h"

#include "solver/continuous/reading/reading.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace modelsynth {

namespace {

// Bytes, measured with the built-in examples and rounded up.
constexpr std::uint64_t kAny = std::uint64_t{16} << 20;        // whatever the size
constexpr std::uint64_t kAnySolids = std::uint64_t{32} << 20;  // with KindRelations
constexpr std::uint64_t kCell = 200;                           // labels, events, the GLB
constexpr std::uint64_t kCellOfWhole = 3;                      // for each label, made at once
constexpr std::uint64_t kCellOfRule = 64;                      // for each constraint
constexpr std::uint64_t kCellOfSpacings = 500;                 // between planes of solids
constexpr std::uint64_t kCellOfThreeFamilies = 80;             // for each three that meet in points

Estimate estimate_grid(const discrete::Example& example, const discrete::Parameters& parameters) {
    const std::uint64_t cells = parameters.size->cell_count();
    const bool is_whole = !*parameters.blocks;
    Estimate result;
    result.choices = cells;
    result.memory_bytes =
        kAny + cells * (kCell + (is_whole ? kCellOfWhole * example.pieces.size() : 0) +
                        kCellOfRule * parameters.constraints.size());
    return result;
}

Estimate estimate_solids(
    const continuous::ExampleReading& reading,
    const continuous::Parameters& parameters,
    const GridSize& cells
) {
    const std::uint64_t families = reading.topes().family_count();
    const std::uint64_t threes = families < 3 ? 1 : families * (families - 1) * (families - 2) / 6;
    const std::uint64_t rules = parameters.constraints ? parameters.constraints->size() : 0;
    Estimate result;
    // Planes of three families meet about once in a cell.
    result.choices = cells.cell_count() * threes;
    result.memory_bytes =
        kAnySolids + cells.cell_count() *
                         (kCellOfSpacings + kCellOfThreeFamilies * threes + kCellOfRule * rules);
    return result;
}

// How often blocks cover a cell, all in all.
double coverage(const GridSize& model, const BlockLayout& layout) {
    double times = layout.passes;
    for (const auto& [cells, block] :
         {std::pair(model.x, layout.size.x),
          std::pair(model.y, layout.size.y),
          std::pair(model.z, layout.size.z)}) {
        times /= cells > block ? 1 - layout.overlap : 1;
    }
    return times;
}

}  // namespace

Estimate estimate(const Task& task, std::uint32_t model_count) {
    Estimate result;
    if (const auto* grid = std::get_if<discrete::Parameters>(&task.parameters)) {
        const auto& example = *std::get<std::shared_ptr<const discrete::Example>>(task.example);
        result = estimate_grid(example, *grid);
    } else {
        result = estimate_solids(
            *std::get<std::shared_ptr<const continuous::ExampleReading>>(task.example),
            std::get<continuous::Parameters>(task.parameters),
            model_size(task.parameters)
        );
    }
    double times = std::max(1U, model_count);
    if (const auto layout = block_layout(task.parameters)) {
        times *= coverage(model_size(task.parameters), *layout);
    }
    // Far from what a number holds, whatever was asked for.
    const double choices = std::min(static_cast<double>(result.choices) * times, 1e15);
    result.choices = static_cast<std::uint64_t>(choices);
    return result;
}

}  // namespace modelsynth
