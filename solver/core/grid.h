#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace modelsynth {

// A place in a grid of cells, y upwards.
struct Cell {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;

    friend bool operator==(const Cell&, const Cell&) = default;
};

// How many cells a grid has along each axis. Flat arrays have x fastest, then z, then y: floor
// by floor, the bottom first.
struct GridSize {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;

    [[nodiscard]] constexpr std::size_t cell_count() const {
        return static_cast<std::size_t>(x) * static_cast<std::size_t>(y) *
               static_cast<std::size_t>(z);
    }

    [[nodiscard]] constexpr std::size_t index(const Cell& cell) const {
        return static_cast<std::size_t>(cell.x) +
               static_cast<std::size_t>(x) *
                   (static_cast<std::size_t>(cell.z) +
                    static_cast<std::size_t>(z) * static_cast<std::size_t>(cell.y));
    }

    [[nodiscard]] constexpr Cell cell(std::size_t index) const {
        const auto width = static_cast<std::size_t>(x);
        const auto depth = static_cast<std::size_t>(z);
        return {
            static_cast<std::int32_t>(index % width),
            static_cast<std::int32_t>(index / (width * depth)),
            static_cast<std::int32_t>(index / width % depth)};
    }

    [[nodiscard]] constexpr bool contains(const Cell& cell) const {
        return cell.x >= 0 && cell.x < x && cell.y >= 0 && cell.y < y && cell.z >= 0 && cell.z < z;
    }

    friend bool operator==(const GridSize&, const GridSize&) = default;
};

// A box of cells: min is inside, max is outside.
struct Box {
    Cell min;
    Cell max;

    [[nodiscard]] constexpr GridSize size() const {
        return {max.x - min.x, max.y - min.y, max.z - min.z};
    }

    [[nodiscard]] constexpr bool contains(const Cell& cell) const {
        return cell.x >= min.x && cell.x < max.x && cell.y >= min.y && cell.y < max.y &&
               cell.z >= min.z && cell.z < max.z;
    }

    static constexpr Box whole(const GridSize& size) { return {{}, {size.x, size.y, size.z}}; }

    // Of that size in the middle of the whole, as far as there is room.
    static constexpr Box middle(const GridSize& whole, const GridSize& size) {
        const GridSize cut = {
            std::min(whole.x, size.x), std::min(whole.y, size.y), std::min(whole.z, size.z)};
        const Cell min = {(whole.x - cut.x) / 2, (whole.y - cut.y) / 2, (whole.z - cut.z) / 2};
        return {min, {min.x + cut.x, min.y + cut.y, min.z + cut.z}};
    }

    friend bool operator==(const Box&, const Box&) = default;
};

// Calls visit(Cell) for every cell of the box in the order of flat arrays.
template <class Visit>
constexpr void for_each_cell(const Box& box, Visit visit) {
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
            for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
                visit(Cell{x, y, z});
            }
        }
    }
}

// Calls visit(Cell first, std::size_t count) for every row of the box: cells that follow each other
// along x. In the order of flat arrays.
template <class Visit>
constexpr void for_each_row(const Box& box, Visit visit) {
    const auto count = static_cast<std::size_t>(std::max(0, box.max.x - box.min.x));
    for (std::int32_t y = box.min.y; count > 0 && y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
            visit(Cell{box.min.x, y, z}, count);
        }
    }
}

// The six directions of a grid, each also the number of the relation along it. A direction and
// its opposite differ in the lowest bit.
enum class Direction : std::uint8_t { kEast, kWest, kUp, kDown, kSouth, kNorth };
inline constexpr std::size_t kDirectionCount = 6;
inline constexpr std::array<Cell, kDirectionCount> kDirectionSteps = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

}  // namespace modelsynth
