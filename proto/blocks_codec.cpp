#include "proto/blocks_codec.h"

namespace modelsynth::proto {

std::optional<Blocks> read_blocks(const Value& value, const RequestLimits& limits, Blocks blocks) {
    if (value.json().is_null()) {
        return std::nullopt;
    }
    ObjectReader reader(value);
    if (const auto size = reader.optional("size")) {
        if (const auto cell = size->cell(1, limits.block_extent_max)) {
            blocks.layout.size = {cell->x, cell->y, cell->z};
        }
    }
    if (const auto overlap = reader.optional("overlap")) {
        blocks.layout.overlap = overlap->number(0, 0.95).value_or(blocks.layout.overlap);
    }
    if (const auto passes = reader.optional("passes")) {
        blocks.layout.passes = static_cast<std::uint32_t>(passes->integer(1, 100).value_or(1));
    }
    if (const auto attempts = reader.optional("attempts")) {
        blocks.attempts = static_cast<std::uint32_t>(attempts->integer(1, 1000).value_or(1));
    }
    reader.finish();
    return blocks;
}

OrderedJson write_blocks(const std::optional<Blocks>& blocks) {
    if (!blocks) {
        return nullptr;
    }
    const BlockLayout& layout = blocks->layout;
    return {
        {"size", OrderedJson::array({layout.size.x, layout.size.y, layout.size.z})},
        {"overlap", layout.overlap},
        {"passes", layout.passes},
        {"attempts", blocks->attempts}};
}

}  // namespace modelsynth::proto
