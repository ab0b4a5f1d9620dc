#include "solver/discrete/pair_images.h"

#include "solver/discrete/names.h"

#include <utility>

namespace modelsynth::discrete {

namespace {

// A step of SplitMix64.
std::uint64_t mixed(std::uint64_t value) {
    value += 0x9E3779B97F4A7C15U;
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31U);
}

}  // namespace

std::array<Direction, kDirectionCount> direction_images(Symmetry::Kind kind) {
    constexpr auto kEast = Direction::kEast;
    constexpr auto kWest = Direction::kWest;
    constexpr auto kUp = Direction::kUp;
    constexpr auto kDown = Direction::kDown;
    constexpr auto kSouth = Direction::kSouth;
    constexpr auto kNorth = Direction::kNorth;
    switch (kind) {
        case Symmetry::Kind::kReflectX:
            return {kWest, kEast, kUp, kDown, kSouth, kNorth};
        case Symmetry::Kind::kReflectZ:
            return {kEast, kWest, kUp, kDown, kNorth, kSouth};
        case Symmetry::Kind::kHalfTurn:
            return {kWest, kEast, kUp, kDown, kNorth, kSouth};
        case Symmetry::Kind::kQuarterTurn:
            return {kNorth, kSouth, kUp, kDown, kEast, kWest};
        case Symmetry::Kind::kTranslate:
            break;
    }
    return {kEast, kWest, kUp, kDown, kSouth, kNorth};
}

PairImages::PairImages(const Example& example, Symmetry::Kind kind)
    : directions_(direction_images(kind)),
      are_neighbours_(kAxisCount * example.pieces.size() * example.pieces.size()),
      pairs_of_(example.pieces.size()),
      degrees_(example.pieces.size()) {
    const GridSize size = example.size;
    for_each_cell(Box::whole(size), [&](const Cell& cell) {
        for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
            const Cell step = kDirectionSteps[2 * axis];
            const Cell next = {cell.x + step.x, cell.y + step.y, cell.z + step.z};
            if (size.contains(next)) {
                add_neighbours(
                    axis, example.cells[size.index(cell)], example.cells[size.index(next)]
                );
            }
        }
    });
    for (const AdjacentPair& pair : example.adjacency) {
        add_neighbours(pair.axis, pair.lower, pair.upper);
    }
    add_sides(example);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Pair& pair = pairs_[i];
        pairs_of_[pair.lower].push_back(static_cast<std::uint32_t>(i));
        if (pair.upper != pair.lower) {
            pairs_of_[pair.upper].push_back(static_cast<std::uint32_t>(i));
        }
    }
}

void PairImages::add_neighbours(std::size_t axis, Label lower, Label upper) {
    if (are_neighbours_[bit(axis, lower, upper)]) {
        return;
    }
    are_neighbours_[bit(axis, lower, upper)] = true;
    pairs_.push_back({static_cast<std::uint8_t>(axis), lower, upper});
    ++degrees_[lower][2 * axis];
    ++degrees_[upper][2 * axis + 1];
}

void PairImages::add_sides(const Example& example) {
    const LabelOfName labels = labels_by_name(example);
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        allowed_on_.push_back(allowed_on_side(example, labels, side, example.boundary[side]));
    }
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        // Where all may stand, all images may: that says nothing.
        if (allowed_on_[static_cast<std::size_t>(directions_[side])].count() < label_count()) {
            for_each_label(allowed_on_[side].words(), [&](Label label) {
                pairs_.push_back({static_cast<std::uint8_t>(kAxisCount + side), label, label});
            });
        }
    }
}

std::vector<std::uint64_t> PairImages::colours(bool is_moved, int steps) const {
    std::vector<std::uint64_t> colours(label_count());
    for (int i = 0; i < steps; ++i) {
        std::vector<std::uint64_t> next = colours;
        const auto add = [&](Label label, std::size_t direction, Label neighbour) {
            const auto seen =
                is_moved ? static_cast<std::size_t>(directions_[direction]) : direction;
            next[label] += mixed(colours[neighbour] + seen + 1);  // in whatever order they come
        };
        for (const auto& [place, lower, upper] : pairs_) {
            if (place < kAxisCount) {
                add(lower, std::size_t{2} * place, upper);
                add(upper, std::size_t{2} * place + 1, lower);
            }
        }
        for (std::uint64_t& colour : next) {
            colour = mixed(colour);
        }
        colours = std::move(next);
    }
    return colours;
}

bool PairImages::has_image(std::uint32_t pair, std::span<const Label> images) const {
    const auto& [place, lower, upper] = pairs_[pair];
    if (place >= kAxisCount) {
        const auto side = static_cast<std::size_t>(directions_[place - kAxisCount]);
        return allowed_on_[side].contains(images[lower]);
    }
    const auto direction = static_cast<std::size_t>(directions_[std::size_t{2} * place]);
    return direction % 2 == 0 ? are_neighbours_[bit(direction / 2, images[lower], images[upper])]
                              : are_neighbours_[bit(direction / 2, images[upper], images[lower])];
}

}  // namespace modelsynth::discrete
