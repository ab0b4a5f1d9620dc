#include "solver/discrete/explanation/irreducible.h"

#include "solver/core/random.h"
#include "solver/discrete/explanation/contradiction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace modelsynth::discrete {
namespace {

using Set = std::vector<int>;

bool holds_all(std::span<const int> set, const Set& wanted) {
    return std::all_of(wanted.begin(), wanted.end(), [&set](int item) {
        return std::find(set.begin(), set.end(), item) != set.end();
    });
}

// Conflicts are the sets that hold all of one of a few random cores.
TEST(FindIrreducible, FindsOneOfTheCores) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        RandomStream random({seed, 0, 0, 96});
        Set items(1 + random.below(60));
        std::iota(items.begin(), items.end(), 0);
        std::vector<Set> cores(1 + random.below(3));
        for (Set& core : cores) {
            for (const int item : items) {
                if (random.below(static_cast<std::uint32_t>(items.size())) < 3) {
                    core.push_back(item);
                }
            }
        }
        std::size_t asked = 0;
        const auto is_conflict = [&](std::span<const int> set) {
            ++asked;
            return std::any_of(cores.begin(), cores.end(), [&set](const Set& core) {
                return holds_all(set, core);
            });
        };
        Set found = find_irreducible(std::span<const int>(items), is_conflict);
        std::sort(found.begin(), found.end());
        EXPECT_NE(std::find(cores.begin(), cores.end(), found), cores.end()) << seed;
        EXPECT_LE(asked, 1 + found.size() * 14) << seed;  // 2 log2(60) and 2 for each
    }
}

TEST(FindIrreducible, PrefersWhatComesFirst) {
    const Set items = {1, 2, 3, 4, 5, 6};
    const auto is_conflict = [](std::span<const int> set) {
        return holds_all(set, {1, 2}) || holds_all(set, {5, 6}) || holds_all(set, {2, 5});
    };
    EXPECT_EQ(find_irreducible(std::span<const int>(items), is_conflict), (Set{1, 2}));
}

TEST(FindIrreducible, NeedsNothingWhereNothingIsAConflictAlready) {
    const Set items = {1, 2, 3};
    const auto always = [](std::span<const int>) { return true; };
    EXPECT_TRUE(find_irreducible(std::span<const int>(items), always).empty());
    EXPECT_TRUE(find_irreducible(std::span<const int>(), always).empty());
}

// Who answers no without knowing gets more than is needed, but a conflict still.
TEST(FindIrreducible, KeepsAConflictWhenAnswersEnd) {
    Set items(40);
    std::iota(items.begin(), items.end(), 0);
    const Set core = {3, 17, 30};
    for (int answers = 0; answers < 30; ++answers) {
        int left = answers;
        const Set found =
            find_irreducible(std::span<const int>(items), [&](std::span<const int> set) {
                return left-- > 0 && holds_all(set, core);
            });
        EXPECT_TRUE(holds_all(found, core)) << answers;
    }
}

TEST(HottestOf, ListsTheMostOftenFirstAndNoMoreThanEight) {
    const GridSize size = {4, 1, 3};
    const std::vector<std::uint32_t> counts = {0, 5, 1, 1, 9, 1, 1, 1, 1, 1, 0, 5};
    const auto hottest = hottest_of(size, counts).hottest;
    ASSERT_EQ(hottest.size(), std::size_t{8});
    EXPECT_EQ(hottest[0].cell, (Cell{0, 0, 1}));
    EXPECT_EQ(hottest[0].times, 9U);
    EXPECT_EQ(hottest[1].cell, (Cell{1, 0, 0}));
    EXPECT_EQ(hottest[2].cell, (Cell{3, 0, 2}));
    EXPECT_EQ(hottest[3].cell, (Cell{2, 0, 0}));
    EXPECT_EQ(hottest[7].times, 1U);
    EXPECT_TRUE(hottest_of(size, std::vector<std::uint32_t>(12)).hottest.empty());
}

}  // namespace
}  // namespace modelsynth::discrete
