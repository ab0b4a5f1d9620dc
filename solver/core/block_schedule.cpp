#include "solver/core/block_schedule.h"

#include <algorithm>
#include <cmath>

namespace modelsynth {

namespace {

// Where blocks start along one axis.
std::vector<std::int32_t> starts(std::int32_t extent, std::int32_t block, double overlap) {
    std::vector<std::int32_t> result = {0};
    const auto step =
        std::max(std::int32_t{1}, static_cast<std::int32_t>(std::lround(block * (1.0 - overlap))));
    while (result.back() + block < extent) {
        result.push_back(std::min(result.back() + step, extent - block));
    }
    return result;
}

// Whether the intervals [a_min, a_max) and [b_min, b_max) overlap or touch.
bool meet(
    std::int32_t a_min,
    std::int32_t a_max,
    std::int32_t b_min,
    std::int32_t b_max,
    bool is_periodic,
    std::int32_t extent
) {
    const auto at = [&](std::int32_t shift) {
        return a_min + shift <= b_max && b_min <= a_max + shift;
    };
    return at(0) || (is_periodic && (at(extent) || at(-extent)));
}

}  // namespace

Result<std::vector<Box>> schedule_blocks(
    const GridSize& model, const BlockLayout& layout, std::size_t block_count_max
) {
    const GridSize block = {
        std::min(model.x, layout.size.x),
        std::min(model.y, layout.size.y),
        std::min(model.z, layout.size.z)};
    const auto xs = starts(model.x, block.x, layout.overlap);
    const auto ys = starts(model.y, block.y, layout.overlap);
    const auto zs = starts(model.z, block.z, layout.overlap);
    const double count = static_cast<double>(xs.size()) * static_cast<double>(ys.size()) *
                         static_cast<double>(zs.size()) * layout.passes;
    if (count > static_cast<double>(block_count_max)) {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "the schedule would have more than " + std::to_string(block_count_max) + " blocks",
            {}});
    }
    std::vector<Box> blocks;
    blocks.reserve(static_cast<std::size_t>(count));
    for (std::uint32_t pass = 0; pass < layout.passes; ++pass) {
        for (const std::int32_t x : xs) {
            for (const std::int32_t z : zs) {
                for (const std::int32_t y : ys) {
                    blocks.push_back({{x, y, z}, {x + block.x, y + block.y, z + block.z}});
                }
            }
        }
    }
    return blocks;
}

std::vector<Box> corners_of(const Box& block) {
    const GridSize size = block.size();
    const std::int32_t width = (3 * size.x + 4) / 5;
    const std::int32_t depth = (3 * size.z + 4) / 5;
    std::vector<Box> parts;
    for (const std::int32_t x : {block.min.x, block.max.x - width}) {
        for (const std::int32_t z : {block.min.z, block.max.z - depth}) {
            const Box part = {{x, block.min.y, z}, {x + width, block.max.y, z + depth}};
            if (part != block && std::find(parts.begin(), parts.end(), part) == parts.end()) {
                parts.push_back(part);
            }
        }
    }
    return parts;
}

bool blocks_meet(const Box& a, const Box& b, const GridSize& model, Periodic periodic) {
    return meet(a.min.x, a.max.x, b.min.x, b.max.x, periodic.x, model.x) &&
           meet(a.min.y, a.max.y, b.min.y, b.max.y, periodic.y, model.y) &&
           meet(a.min.z, a.max.z, b.min.z, b.max.z, periodic.z, model.z);
}

}  // namespace modelsynth
