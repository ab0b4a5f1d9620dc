#include "solver/discrete/parameters.h"

namespace modelsynth::discrete {

namespace {

// Models up to this height are made in blocks that reach from floor to sky: a tower that a block
// cuts in two can only keep its height.
constexpr std::int32_t kFullHeightMax = 16;

Blocks default_blocks(const GridSize& size) {
    Blocks blocks;
    if (size.y <= kFullHeightMax) {
        blocks.layout.size.y = size.y;
    }
    return blocks;
}

}  // namespace

Parameters fill_defaults(Parameters parameters, const Example& example) {
    if (!parameters.size) {
        parameters.size = example.default_size;
    }
    if (!parameters.blocks) {
        parameters.blocks = default_blocks(*parameters.size);
    }
    if (!parameters.weights) {
        parameters.weights = example.default_weights;
    }
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        if (!parameters.boundary[side]) {
            parameters.boundary[side] = example.boundary[side];
        }
    }
    return parameters;
}

}  // namespace modelsynth::discrete
