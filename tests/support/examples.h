#pragma once

#include "solver/core/observer.h"
#include "solver/core/random.h"
#include "solver/discrete/example.h"
#include "solver/discrete/synthesis.h"

#include <cstdint>
#include <string>
#include <vector>

namespace modelsynth::testing {

// Listens and keeps what was told.
class RecordingObserver final : public Observer {
  public:
    void on_start(std::uint32_t blocks_total, std::span<const Label> initial) override {
        total = blocks_total;
        initial_model.assign(initial.begin(), initial.end());
    }

    void on_block(const BlockReport& report) override {
        reports.push_back(report);
        models.emplace_back(report.model.begin(), report.model.end());
    }

    std::uint32_t total = 0;
    std::vector<Label> initial_model;
    std::vector<BlockReport> reports;
    std::vector<std::vector<Label>> models;  // after each block
};

// An example of labels a, b, c, ... on a grid, without meshes; sides free.
inline discrete::Example make_example(
    const GridSize& size, std::vector<Label> cells, std::size_t piece_count
) {
    discrete::Example example;
    example.name = "test";
    for (std::size_t i = 0; i < piece_count; ++i) {
        example.pieces.push_back({std::string(1, static_cast<char>('a' + i)), {}, 0, 1});
    }
    example.size = size;
    example.cells = std::move(cells);
    return example;
}

// Ground (a) below, air (b) above, and a pillar (c, capped by d) that stands on the ground.
inline discrete::Example make_pillars() {
    // Four floors of 3 x 3; the last is air, so that the cap has something above it.
    return make_example(
        {3, 4, 3},
        {0, 0, 0, 0, 0, 0, 0, 0, 0,  //
         1, 1, 1, 1, 2, 1, 1, 1, 1,  //
         1, 1, 1, 1, 3, 1, 1, 1, 1,  //
         1, 1, 1, 1, 1, 1, 1, 1, 1},
        4
    );
}

// A random example of a few labels; the same for the same seed.
inline discrete::Example make_random_example(std::uint64_t seed) {
    RandomStream random({seed, 0, 0, 99});
    const auto below = [&random](std::uint32_t bound) { return random.below(bound); };
    const std::size_t labels = 2 + below(5);
    const GridSize size = {
        static_cast<std::int32_t>(2 + below(4)),
        static_cast<std::int32_t>(1 + below(3)),
        static_cast<std::int32_t>(2 + below(4))};
    std::vector<Label> cells(size.cell_count());
    for (Label& cell : cells) {
        // Mostly label 0, so that most examples have something that repeats.
        cell = static_cast<Label>(below(3) == 0 ? below(static_cast<std::uint32_t>(labels)) : 0);
    }
    return make_example(size, std::move(cells), labels);
}

// A random example of two to six labels in a plane, of two to four in space. Odd seeds: what stands
// on a small grid. Even ones: any pairs at all, more or less, as no grid of that size could hold.
inline discrete::Example make_tiny_example(std::uint64_t seed, bool is_planar) {
    RandomStream random({seed, 0, 0, 98});
    const auto below = [&random](std::uint32_t bound) { return random.below(bound); };
    const std::uint32_t labels = 2 + below(is_planar ? 5 : 3);
    if (seed % 2 == 1) {
        const auto extent = [&] { return static_cast<std::int32_t>(2 + below(3)); };
        const GridSize size = {extent(), is_planar ? 1 : extent(), extent()};
        std::vector<Label> cells(size.cell_count());
        for (Label& cell : cells) {
            cell = static_cast<Label>(below(labels));
        }
        return make_example(size, std::move(cells), labels);
    }
    discrete::Example example = make_example({0, 0, 0}, {}, labels);
    const std::uint32_t share = 2 + below(5);  // of ten pairs
    for (const std::uint8_t axis : {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{2}}) {
        for (Label a = 0; a < labels; ++a) {
            for (Label b = 0; b < labels; ++b) {
                if ((axis != 1 || !is_planar) && below(10) < share) {
                    example.adjacency.push_back({axis, a, b});
                }
            }
        }
    }
    return example;
}

}  // namespace modelsynth::testing
