#include "solver/discrete/repeated_tile.h"

#include "solver/core/block_search.h"
#include "solver/core/grid_topology.h"
#include "solver/discrete/plain_layers.h"
#include "solver/discrete/scan_order.h"
#include "solver/discrete/search_keys.h"

#include <algorithm>

namespace modelsynth::discrete {

namespace {

constexpr std::uint32_t kTileAttempts = 4;

// A model of tile_x by tile_z columns that closes on itself, repeated over the whole.
std::optional<std::vector<Label>> find_tile(
    const Problem& problem,
    const std::vector<LabelSet>& floors,
    std::int32_t tile_x,
    std::int32_t tile_z,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    const GridSize size = {tile_x, problem.size.y, tile_z};
    const GridPart part(size, {true, problem.periodic.y, true}, Box::whole(size));
    SiteDomains domains(size.cell_count(), LabelSet::all(problem.relations.label_count()));
    for_each_cell(Box::whole(size), [&](const Cell& cell) {
        domains.narrow(
            static_cast<Site>(size.index(cell)), floors[static_cast<std::size_t>(cell.y)]
        );
    });
    std::vector<Label> tile(size.cell_count(), kNoLabel);
    const std::vector<Site> scan = column_order(size);
    BlockSearch<GridPart> search(problem.relations, domains, problem.weights);
    const BlockResult result = search.modify(
        part,
        std::span<Label>(tile),
        {kTileAttempts, Order::kScan, scan},
        {seed, kTileKey, 0, 0},
        stop
    );
    if (result.outcome != BlockOutcome::kAccepted) {
        return std::nullopt;
    }
    std::vector<Label> model(problem.size.cell_count());
    for_each_cell(Box::whole(problem.size), [&](const Cell& cell) {
        model[problem.size.index(cell)] =
            tile[size.index({cell.x % tile_x, cell.y, cell.z % tile_z})];
    });
    return model;
}

}  // namespace

std::optional<std::vector<Label>> find_any_tile(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
) {
    const std::vector<LabelSet> floors = common_domains(problem);
    const auto divides = [](bool periodic, std::int32_t extent, std::int32_t tile) {
        return tile <= extent && (!periodic || extent % tile == 0);
    };
    for (std::int32_t sum = 2; sum <= 2 * kTileMax; ++sum) {
        for (std::int32_t x = std::max(1, sum - kTileMax); x <= std::min(kTileMax, sum - 1); ++x) {
            const std::int32_t z = sum - x;
            if (stop.stop_requested()) {
                return std::nullopt;
            }
            if (!divides(problem.periodic.x, problem.size.x, x) ||
                !divides(problem.periodic.z, problem.size.z, z)) {
                continue;
            }
            if (auto model = find_tile(problem, floors, x, z, seed, stop)) {
                return model;
            }
        }
    }
    return std::nullopt;
}

}  // namespace modelsynth::discrete
