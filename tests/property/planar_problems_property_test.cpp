// What the bench times in the plane must be the problems that it says they are.

#include "solver/discrete/synthesis.h"
#include "tests/bench/pattern_set.h"
#include "tests/bench/planar_problems.h"
#include "tests/bench/tile_set.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace modelsynth::bench {
namespace {

using testing::find_inconsistency;
using testing::RecordingObserver;

Image make_random_image(RandomStream& random) {
    const std::size_t width = 5 + random.below(4);
    Image image(5 + random.below(4));
    for (std::string& row : image) {
        for (std::size_t x = 0; x < width; ++x) {
            row += random.below(3) == 0 ? 'b' : 'a';
        }
    }
    return image;
}

// The pixel of a window that was turned or mirrored in one of eight ways.
char naive_pixel(
    const Image& image, int window, int left, int top, int symmetry, int column, int row
) {
    const int last = window - 1;
    int x = (symmetry & 1) != 0 ? last - column : column;
    int z = (symmetry & 2) != 0 ? last - row : row;
    if ((symmetry & 4) != 0) {
        std::swap(x, z);
    }
    const auto depth = static_cast<int>(image.size());
    const auto width = static_cast<int>(image.front().size());
    return image.at(static_cast<std::size_t>((top + z) % depth))
        .at(static_cast<std::size_t>((left + x) % width));
}

std::map<std::string, std::uint32_t> find_naively(
    const Image& image, const PatternOptions& options
) {
    const int window = options.window;
    const auto depth = static_cast<int>(image.size());
    const auto width = static_cast<int>(image.front().size());
    std::map<std::string, std::uint32_t> counts;
    for (int top = 0; top < depth; ++top) {
        for (int left = 0; left < width; ++left) {
            if (!options.is_toroidal && (top + window > depth || left + window > width)) {
                continue;
            }
            for (int symmetry = 0; symmetry < (options.has_symmetries ? 8 : 1); ++symmetry) {
                std::string pattern;
                for (int i = 0; i < window * window; ++i) {
                    pattern +=
                        naive_pixel(image, window, left, top, symmetry, i % window, i / window);
                }
                ++counts[pattern];
            }
        }
    }
    return counts;
}

// Whether `upper` agrees with `lower` where it lies dx and dz pixels further on.
bool overlaps(const std::string& lower, const std::string& upper, int window, int dx, int dz) {
    for (int z = dz; z < window; ++z) {
        for (int x = dx; x < window; ++x) {
            const int in_upper = (z - dz) * window + x - dx;
            if (lower[static_cast<std::size_t>(z * window + x)] !=
                upper[static_cast<std::size_t>(in_upper)]) {
                return false;
            }
        }
    }
    return true;
}

using Pairs = std::set<std::tuple<int, int, int>>;  // axis, lower, upper

Pairs pairs_of(const discrete::Example& example) {
    Pairs pairs;
    for (const auto& pair : example.adjacency) {
        pairs.insert({pair.axis, pair.lower, pair.upper});
    }
    EXPECT_EQ(pairs.size(), example.adjacency.size()) << "a pair twice";
    return pairs;
}

void check_patterns(const Image& image, const PatternOptions& options) {
    const PatternSet set = find_patterns(image, options);
    std::map<std::string, std::uint32_t> counts;
    for (std::size_t label = 0; label < set.patterns.size(); ++label) {
        counts[set.patterns[label]] = set.counts[label];
    }
    ASSERT_EQ(counts.size(), set.patterns.size());
    ASSERT_EQ(counts, find_naively(image, options));

    const discrete::Example example = make_pattern_example("test", set);
    Pairs expected;
    const auto count = static_cast<int>(set.patterns.size());
    for (int lower = 0; lower < count; ++lower) {
        for (int upper = 0; upper < count; ++upper) {
            const std::string& a = set.patterns[static_cast<std::size_t>(lower)];
            const std::string& b = set.patterns[static_cast<std::size_t>(upper)];
            if (overlaps(a, b, options.window, 1, 0)) {
                expected.insert({0, lower, upper});
            }
            if (overlaps(a, b, options.window, 0, 1)) {
                expected.insert({2, lower, upper});
            }
        }
    }
    ASSERT_EQ(pairs_of(example), expected);
    for (std::size_t label = 0; label < set.patterns.size(); ++label) {
        ASSERT_EQ(example.pieces[label].weight, static_cast<double>(set.counts[label]));
    }
}

TEST(PatternSet, IsThatOfItsNaiveTwin) {
    for (std::uint64_t seed = 0; seed < 60 && !HasFatalFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomStream random({seed, 0, 0, 55});
        PatternOptions options;
        options.window = static_cast<std::int32_t>(1 + random.below(4));
        options.has_symmetries = random.below(2) == 0;
        options.is_toroidal = random.below(2) == 0;
        check_patterns(make_random_image(random), options);
    }
}

std::optional<std::vector<Label>> synthesise_plane(
    const discrete::Example& example, const GridSize& size, Order order
) {
    discrete::Parameters parameters;
    parameters.size = size;
    parameters.order = order;
    parameters.blocks = std::optional<discrete::Blocks>();
    RecordingObserver observer;
    const auto model = synthesise(example, fill_defaults(parameters, example), 1, observer, {});
    return model ? std::optional(model->labels) : std::nullopt;
}

TEST(PlanarProblems, ImagesHaveNoWindowsButThoseOfTheSample) {
    const GridSize size = {20, 1, 13};
    for (const PlanarSample& sample : make_planar_samples()) {
        SCOPED_TRACE(sample.name);
        const PatternSet set = find_patterns(sample.image, sample.options);
        const auto example = make_pattern_example(sample.name, set);
        const auto labels = synthesise_plane(example, size, Order::kMinEntropy);
        ASSERT_TRUE(labels);
        const Image image = read_image(set, size, *labels);
        ASSERT_EQ(image.size(), static_cast<std::size_t>(size.z + set.window - 1));
        ASSERT_EQ(image.front().size(), static_cast<std::size_t>(size.x + set.window - 1));
        const auto known = find_naively(sample.image, sample.options);
        PatternOptions as_drawn = sample.options;
        as_drawn.has_symmetries = false;
        as_drawn.is_toroidal = false;
        for (const auto& [pattern, count] : find_naively(image, as_drawn)) {
            ASSERT_TRUE(known.contains(pattern)) << pattern;
        }
    }
}

TEST(PlanarProblems, TilesetsHaveModels) {
    const GridSize size = {30, 1, 30};
    for (const auto& example : make_planar_tilesets()) {
        SCOPED_TRACE(example->name);
        const auto labels = synthesise_plane(*example, size, Order::kScan);
        ASSERT_TRUE(labels);
        EXPECT_EQ(find_inconsistency(*example, size, *labels), std::nullopt);
        const std::set<Label> used(labels->begin(), labels->end());
        EXPECT_GT(2 * used.size(), example->pieces.size()) << "too dull to tell anything";
    }
}

TEST(TileSet, NeighboursReadTheirEdgeEachFromItsSide) {
    // Grass north of a shore that has water in the south; the west end of the shore line is at the
    // west edge, read northwards, and at the east edge, read southwards.
    const std::vector<Tile> tiles = {
        {"grass", {"gg", "gg", "gg", "gg"}},
        {"shore", {"gg", "gw", "ww", "wg"}},
        {"water", {"ww", "ww", "ww", "ww"}}};
    const auto example = make_tile_example("test", tiles, Variants::kAsDrawn);
    const Pairs expected = {
        {0, 0, 0}, {0, 1, 1}, {0, 2, 2}, {2, 0, 0}, {2, 0, 1}, {2, 1, 2}, {2, 2, 2}};
    EXPECT_EQ(pairs_of(example), expected);
}

TEST(TileSet, HasEveryVariantThatLooksDifferentOnce) {
    const std::vector<Tile> tiles = {
        {"cross", {"r", "r", "r", "r"}},
        {"line", {"r", ".", "r", "."}},
        {"bend", {"r", "r", ".", "."}},
        {"spiral", {"ab", "ab", "ab", "ab"}},
        {"hook", {"ab", "r", ".", "."}}};
    const auto count = [&](Variants variants) {
        return make_tile_example("test", tiles, variants).pieces.size();
    };
    EXPECT_EQ(count(Variants::kAsDrawn), 5U);
    EXPECT_EQ(count(Variants::kTurned), 1U + 2U + 4U + 1U + 4U);
    EXPECT_EQ(count(Variants::kTurnedAndMirrored), 1U + 2U + 4U + 2U + 8U);
}

// Turning the whole plane takes rows to columns, so with all turns of each tile there are as many
// pairs either way, and mirroring takes every pair to one with its ends exchanged.
TEST(PlanarProblems, TurnedTilesFitTogetherAlikeEitherWay) {
    for (const auto& example : make_planar_tilesets()) {
        SCOPED_TRACE(example->name);
        const auto along_x = std::count_if(
            example->adjacency.begin(),
            example->adjacency.end(),
            [](const auto& pair) { return pair.axis == 0; }
        );
        EXPECT_GT(along_x, 0);
        if (example->name != "wang") {
            EXPECT_EQ(2 * along_x, static_cast<std::ptrdiff_t>(example->adjacency.size()));
        }
    }
}

}  // namespace
}  // namespace modelsynth::bench
