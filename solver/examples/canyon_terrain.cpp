#include "solver/examples/canyon_terrain.h"

#include "solver/core/result.h"

#include <algorithm>
#include <array>
#include <optional>

namespace modelsynth::examples {

namespace {

struct CliffLine {
    CliffShape shape;
    int quarter_turns;
};

// Which corners of a cell are rock: bit 0 north-west, 1 north-east, 2 south-west, 3 south-east.
std::optional<CliffLine> cliff_line(unsigned corners) {
    static constexpr std::array<std::array<unsigned, 4>, kCliffShapeCount> kCorners = {
        {{0b0101, 0b1100, 0b1010, 0b0011},
         {0b0100, 0b1000, 0b0010, 0b0001},
         {0b1101, 0b1110, 0b1011, 0b0111}}};
    for (int shape = 0; shape < kCliffShapeCount; ++shape) {
        for (int turns = 0; turns < 4; ++turns) {
            if (kCorners[static_cast<std::size_t>(shape)][static_cast<std::size_t>(turns)] ==
                corners) {
                return CliffLine{static_cast<CliffShape>(shape), turns};
            }
        }
    }
    return std::nullopt;
}

struct Column {
    int low = 0;
    int high = 0;
    CliffLine line = {CliffShape::kEdge, 0};  // where low < high

    [[nodiscard]] char letter(int y) const {
        if (y < low) {
            return kSolid;
        }
        if (y > high) {
            return kAir;
        }
        if (low == high) {
            return low == 0 ? kValley : kTurf;
        }
        const CliffKind kind = y == high  ? CliffKind::kRim
                               : y > low  ? CliffKind::kMiddle
                               : low == 0 ? CliffKind::kValleyFoot
                                          : CliffKind::kTerraceFoot;
        return cliff_letter(kind, line.shape, line.quarter_turns);
    }
};

Column column_at(const std::vector<std::string_view>& heights, std::size_t x, std::size_t z) {
    const std::array<int, 4> corners = {
        heights[z][x] - '0',
        heights[z][x + 1] - '0',
        heights[z + 1][x] - '0',
        heights[z + 1][x + 1] - '0'};
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    Column column = {*low, *high};
    if (column.low == column.high) {
        return column;
    }
    unsigned rock = 0;
    bool two_heights = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        rock |= unsigned{corners[i] == column.high} << i;
        two_heights = two_heights && (corners[i] == column.high || corners[i] == column.low);
    }
    const auto line = cliff_line(rock);
    check(
        two_heights && line,
        ("the canyon's heights do not fit at column " + std::to_string(x) + ", row " +
         std::to_string(z))
            .c_str()
    );
    column.line = *line;
    return column;
}

}  // namespace

char cliff_letter(CliffKind kind, CliffShape shape, int quarter_turns) {
    constexpr int kFirst = 0x80;
    const int index =
        (static_cast<int>(kind) * kCliffShapeCount + static_cast<int>(shape)) * 4 + quarter_turns;
    return static_cast<char>(kFirst + index);
}

std::string cliff_letters(CliffKind kind, CliffShape shape) {
    std::string letters;
    for (int turns = 0; turns < 4; ++turns) {
        letters += cliff_letter(kind, shape, turns);
    }
    return letters;
}

std::vector<std::vector<std::string>> lay_out_terrain(
    const std::vector<std::string_view>& heights,
    const std::vector<std::string_view>& things,
    const std::map<char, Thing>& meaning
) {
    char highest = '0';
    for (const std::string_view row : heights) {
        highest = std::max(highest, *std::max_element(row.begin(), row.end()));
    }
    // A floor for the top of the highest mesa and two for what stands on it and the sky.
    const auto floor_count = static_cast<std::size_t>(highest - '0') + 3;
    const std::size_t width = heights.front().size() - 1;
    const std::size_t depth = heights.size() - 1;
    check(things.size() == depth, "the canyon's things have another depth than its heights");
    std::vector<std::vector<std::string>> floors(
        floor_count, std::vector<std::string>(depth, std::string(width, kAir))
    );
    for (std::size_t z = 0; z < depth; ++z) {
        check(things[z].size() == width, "the canyon's things have another width");
        for (std::size_t x = 0; x < width; ++x) {
            const Column column = column_at(heights, x, z);
            for (std::size_t y = 0; y < floor_count; ++y) {
                floors[y][z][x] = column.letter(static_cast<int>(y));
            }
            const auto thing = meaning.find(things[z][x]);
            if (thing == meaning.end()) {
                check(things[z][x] == '.', "a thing of the canyon that nothing is known of");
                continue;
            }
            const auto turn = static_cast<std::size_t>(column.line.quarter_turns);
            const std::string& stack = thing->second.turned_stack.empty()
                                           ? thing->second.stack
                                           : thing->second.turned_stack[turn];
            for (std::size_t i = 0; i < stack.size(); ++i) {
                if (stack[i] != kAsIs) {
                    floors[static_cast<std::size_t>(column.low) + i][z][x] = stack[i];
                }
            }
        }
    }
    return floors;
}

}  // namespace modelsynth::examples
