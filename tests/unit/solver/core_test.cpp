#include "solver/core/block_schedule.h"
#include "solver/core/block_search.h"
#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/core/label_weights.h"
#include "solver/core/random.h"
#include "solver/core/site_domains.h"
#include "tests/support/chi_squared.h"
#include "tests/support/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace modelsynth {
namespace {

using testing::make_colouring;
using testing::whole_graph;

static_assert(Topology<GridTopology> && Topology<GraphTopology>);
static_assert(TopologyPart<GridPart> && TopologyPart<GraphPart>);

TEST(Philox, MatchesThePublishedVectors) {
    // kat_vectors of Random123 for philox4x32-10.
    EXPECT_EQ(
        philox4x32({0, 0, 0, 0}, {0, 0}),
        (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8})
    );
    EXPECT_EQ(
        philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
        (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd})
    );
}

TEST(RandomStream, DependsOnEveryPartOfItsKey) {
    std::set<std::uint32_t> firsts;
    for (const RandomKey& key :
         {RandomKey{1, 0, 0, 0},
          {2, 0, 0, 0},
          {1ULL << 32, 0, 0, 0},
          {1, 1, 0, 0},
          {1, 0, 1, 0},
          {1, 0, 0, 1}}) {
        firsts.insert(RandomStream(key).next());
    }
    EXPECT_EQ(firsts.size(), 6U);
    EXPECT_EQ(RandomStream({5, 6, 7, 8}).next(), RandomStream({5, 6, 7, 8}).next());
}

TEST(RandomStream, BelowIsUniformByChiSquared) {
    RandomStream random({42, 0, 0, 0});
    constexpr int kBins = 10;
    constexpr int kDraws = 100'000;
    std::array<std::uint64_t, kBins> counts = {};
    for (int i = 0; i < kDraws; ++i) {
        ++counts.at(random.below(kBins));
    }
    constexpr std::array<double, kBins> kSame = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    EXPECT_LT(testing::chi_squared_deviation(counts, kSame), 3.1);
}

TEST(LabelWeights, DrawByWeightAndNeverOutsideTheSet) {
    const std::array<double, 4> given = {1, 0, 3, 100};
    const LabelWeights weights(given);
    LabelSet set(4);
    set.insert(0);
    set.insert(1);
    set.insert(2);
    RandomStream random({7, 0, 0, 0});
    std::map<Label, int> counts;
    for (int i = 0; i < 40'000; ++i) {
        ++counts[weights.draw(set.words(), random)];
    }
    EXPECT_EQ(counts[1], 0);
    EXPECT_EQ(counts[3], 0);
    EXPECT_NEAR(counts[0], 10'000, 400);
    EXPECT_NEAR(counts[2], 30'000, 400);
}

// Over sets of any width, in words and without and with the groups; expectations of a count stay
// above five, where chi-squared is good.
TEST(LabelWeights, DrawIsUnbiasedByChiSquared) {
    RandomStream random({11, 0, 0, 0});
    double most = 0;
    for (const std::size_t label_count : {2U, 5U, 63U, 64U, 65U, 128U, 200U, 300U}) {
        for (const bool by_groups : {false, true}) {
            std::vector<double> given(label_count);
            LabelSet set(label_count);
            for (std::size_t label = 0; label < label_count; ++label) {
                given[label] = 1 + random.below(50);
                if (random.below(3) > 0 || label < 2) {
                    set.insert(static_cast<Label>(label));
                }
            }
            LabelWeights weights(given);
            if (by_groups) {
                weights.add_up_groups();
            }
            std::vector<double> wanted = given;
            for (std::size_t label = 0; label < label_count; ++label) {
                if (!set.contains(static_cast<Label>(label))) {
                    wanted[label] = 0;
                }
            }
            std::vector<std::uint64_t> counts(label_count);
            for (int i = 0; i < 200'000; ++i) {
                ++counts[weights.draw(set.words(), random)];
            }
            const double deviation = testing::chi_squared_deviation(counts, wanted);
            EXPECT_LT(deviation, 3.7) << label_count;  // once in ten thousand times
            most = std::max(most, std::abs(deviation));
        }
    }
    EXPECT_GT(most, 0.1);  // counts that fit too well were not drawn
}

TEST(LabelWeights, EntropyOfEqualLabelsIsTheLogOfTheirNumber) {
    const std::array<double, 8> given = {5, 5, 5, 5, 5, 5, 5, 5};
    const LabelWeights weights(given);
    EXPECT_NEAR(weights.entropy(LabelSet::all(8).words()), 3 << 16, 64);
    LabelSet one(8);
    one.insert(3);
    EXPECT_NEAR(weights.entropy(one.words()), 0, 64);
    for (const std::uint64_t value : {1ULL, 2ULL, 3ULL, 1000ULL, 1ULL << 40, ~0ULL}) {
        EXPECT_NEAR(fixed_log2(value) / 65536.0, std::log2(static_cast<double>(value)), 1e-3);
    }
}

TEST(LabelWeights, EntropyIsTheSameByGroups) {
    RandomStream random({8, 0, 0, 0});
    for (const std::size_t label_count : {1U, 3U, 4U, 63U, 64U, 66U, 200U}) {
        std::vector<double> given;
        for (std::size_t label = 0; label < label_count; ++label) {
            given.push_back(random.below(4) == 0 ? 0 : random.below(1000));
        }
        const LabelWeights weights(given);
        LabelWeights by_groups = weights;
        by_groups.add_up_groups();
        for (int i = 0; i < 50; ++i) {
            LabelSet set(label_count);
            for (std::size_t label = 0; label < label_count; ++label) {
                if (random.below(50) >= static_cast<std::uint32_t>(i)) {
                    set.insert(static_cast<Label>(label));
                }
            }
            EXPECT_EQ(by_groups.entropy(set.words()), weights.entropy(set.words()));
        }
    }
}

TEST(GridTopology, JoinsNeighboursBothWaysWithReverseRelations) {
    for (const Periodic periodic : {Periodic{}, Periodic{true, false, true}, {true, true, true}}) {
        const GridTopology grid({3, 2, 4}, periodic);
        for (Site site = 0; site < grid.site_count(); ++site) {
            grid.for_each_arc(site, [&](Site to, RelationId relation) {
                bool back = false;
                grid.for_each_arc(to, [&](Site from, RelationId reverse) {
                    back = back || (from == site && reverse == (relation ^ 1U));
                });
                EXPECT_TRUE(back) << site << " to " << to;
            });
        }
    }
    int arcs = 0;
    GridTopology({3, 2, 4}).for_each_arc(0, [&arcs](Site, RelationId) { ++arcs; });
    EXPECT_EQ(arcs, 3);
    arcs = 0;
    GridTopology({3, 2, 4}, {true, true, true}).for_each_arc(0, [&arcs](Site, RelationId) {
        ++arcs;
    });
    EXPECT_EQ(arcs, 6);
}

TEST(GridPart, TogetherWithItsOutwardArcsHasEveryArcOfTheWhole) {
    const GridSize size = {5, 4, 6};
    const Periodic periodic = {true, false, false};
    const GridTopology whole(size, periodic);
    for (const Box& box :
         {Box{{0, 0, 0}, {5, 4, 6}}, Box{{1, 1, 1}, {3, 3, 4}}, Box{{3, 0, 2}, {5, 2, 6}}}) {
        const GridPart part(size, periodic, box);
        using Arc = std::array<std::uint32_t, 3>;
        std::multiset<Arc> found;
        for (Site site = 0; site < part.inner().site_count(); ++site) {
            part.inner().for_each_arc(site, [&](Site to, RelationId relation) {
                found.insert({part.global(site), part.global(to), relation});
            });
        }
        part.for_each_outward_arc([&](Site inside, Site outside, RelationId relation) {
            found.insert({part.global(inside), outside, relation});
        });
        std::multiset<Arc> in_all;
        std::multiset<Arc> in_groups;
        part.for_each_outward_arc([&](Site inside, Site outside, RelationId relation) {
            in_all.insert({inside, outside, relation});
        });
        for (std::size_t group = 0; group < GridPart::kOutwardGroups; ++group) {
            part.for_each_outward_arc(group, [&](Site inside, Site outside, RelationId relation) {
                in_groups.insert({inside, outside, relation});
            });
        }
        EXPECT_EQ(in_groups, in_all);
        std::multiset<Arc> expected;
        for (Site site = 0; site < whole.site_count(); ++site) {
            if (box.contains(size.cell(site))) {
                whole.for_each_arc(site, [&](Site to, RelationId relation) {
                    expected.insert({site, to, relation});
                });
            }
        }
        EXPECT_EQ(found, expected);
    }
}

TEST(GridPart, IsAfterAMoveAsIfMadeAnew) {
    const GridSize size = {5, 4, 6};
    const Periodic periodic = {true, false, false};
    const std::vector<Box> boxes = {
        {{0, 0, 0}, {3, 2, 2}},
        {{2, 1, 4}, {5, 3, 6}},  // of the same shape
        {{0, 0, 0}, {5, 2, 2}},  // closed along x
        {{0, 2, 4}, {5, 4, 6}},
        {{1, 1, 1}, {2, 2, 2}}};
    const auto describe = [](const GridPart& part) {
        std::vector<std::array<std::size_t, 4>> all;
        part.for_each_run([&](Site inside, Site whole, std::size_t count) {
            all.push_back({0, inside, whole, count});
        });
        part.for_each_outward_arc([&](Site inside, Site outside, RelationId relation) {
            all.push_back({1, inside, outside, relation});
        });
        for (Site site = 0; site < part.inner().site_count(); ++site) {
            part.inner().for_each_arc(site, [&](Site to, RelationId relation) {
                all.push_back({2, site, to, relation});
            });
        }
        return all;
    };
    GridPart moved(size, periodic, boxes.front());
    for (const Box& box : boxes) {
        moved.move_to(box);
        EXPECT_EQ(describe(moved), describe(GridPart(size, periodic, box)));
    }
}

TEST(Schedule, CoversEveryCellAndEndsWithTheModel) {
    const auto blocks = schedule_blocks({23, 7, 10}, {{10, 10, 4}, 0.5, 1}, 1000);
    ASSERT_TRUE(blocks);
    std::set<std::size_t> covered;
    const GridSize size = {23, 7, 10};
    for (const Box& block : *blocks) {
        for_each_cell(block, [&](const Cell& cell) {
            ASSERT_TRUE(size.contains(cell));
            covered.insert(size.index(cell));
        });
    }
    EXPECT_EQ(covered.size(), size.cell_count());
    EXPECT_EQ(schedule_blocks({40, 10, 40}, {}, 1000)->size(), 49U);  // as in the contract
    EXPECT_EQ(schedule_blocks({40, 10, 40}, {{10, 10, 10}, 0.5, 3}, 1000)->size(), 147U);
    EXPECT_EQ(schedule_blocks({40, 10, 40}, {}, 48).error().code, ErrorCode::kTooLarge);
}

TEST(BlockSearch, ColoursAGeneralGraph) {
    // The Petersen graph needs three colours.
    std::vector<GraphArc> arcs;
    for (Site i = 0; i < 5; ++i) {
        arcs.push_back({i, (i + 1) % 5, 0, 0});
        arcs.push_back({i, i + 5, 0, 0});
        arcs.push_back({i + 5, (i + 2) % 5 + 5, 0, 0});
    }
    const GraphTopology graph(10, arcs);
    const GraphPart part = whole_graph(graph);
    const Relations relations = make_colouring(3);
    const SiteDomains domains(10, LabelSet::all(3));
    const std::array<double, 3> given = {1, 1, 1};
    const SiteWeights weights{LabelWeights(given)};
    std::vector<Label> labels(10, kNoLabel);
    std::vector<Site> scan(10);
    std::iota(scan.begin(), scan.end(), Site{0});
    BlockSearch<GraphPart> search(relations, domains, weights);
    for (const Order order : {Order::kScan, Order::kMinEntropy, Order::kRandom}) {
        const BlockResult result =
            search.modify(part, std::span<Label>(labels), {50, order, scan}, {3, 0, 0, 0}, {});
        ASSERT_EQ(result.outcome, BlockOutcome::kAccepted);
        for (Site site = 0; site < 10; ++site) {
            graph.for_each_arc(site, [&](Site to, RelationId) {
                EXPECT_NE(labels[site], labels[to]);
            });
        }
    }
}

TEST(BlockSearch, ProvesThatATriangleHasNoTwoColoursOnceOneIsFixed) {
    const std::array<GraphArc, 3> arcs = {{{0, 1, 0, 0}, {1, 2, 0, 0}, {2, 0, 0, 0}}};
    const GraphTopology graph(3, arcs);
    const Relations relations = make_colouring(2);
    SiteDomains domains(3, LabelSet::all(2));
    LabelSet first(2);
    first.insert(0);
    domains.narrow(0, first);
    const std::array<double, 2> given = {1, 1};
    std::vector<Label> labels(3, 1);
    const std::vector<Site> scan = {0, 1, 2};
    const SiteWeights weights{LabelWeights(given)};
    const BlockResult result =
        BlockSearch<GraphPart>(relations, domains, weights)
            .modify(whole_graph(graph), std::span<Label>(labels), {5, Order::kScan, scan}, {}, {});
    EXPECT_EQ(result.outcome, BlockOutcome::kImpossible);
    EXPECT_EQ(labels, (std::vector<Label>{1, 1, 1}));  // as it was
}

TEST(BlockSearch, KnowledgeKeptFromBlockToBlockChangesNoResult) {
    const GridSize size = {14, 3, 9};
    RandomStream random({11, 0, 0, 1});
    Relations relations(9, {1, 0, 3, 2, 5, 4});
    for (RelationId r = 0; r < 6; r += 2) {
        for (int pairs = 0; pairs < 40; ++pairs) {
            relations.allow(
                r, static_cast<Label>(random.below(9)), static_cast<Label>(random.below(9))
            );
        }
        for (Label label = 0; label < 9; ++label) {
            relations.allow(r, label, label);
        }
    }
    SiteDomains domains(size.cell_count(), LabelSet::all(9));
    LabelSet some(9);
    for (Label label = 0; label < 6; ++label) {
        some.insert(label);
    }
    for (Site site = 0; site < 30; ++site) {
        domains.narrow(site, some);
    }
    const std::vector<double> given(9, 1);
    const SiteWeights weights{LabelWeights(given)};
    std::vector<Label> with(size.cell_count(), 3);
    std::vector<Label> without = with;
    BlockBases<GridTopology> bases;
    BlockSearch<GridPart> keeping(relations, domains, weights, &bases);
    // 4x3x5 and 5x3x4 have as many sites each: only the topology tells them apart.
    const std::vector<Box> blocks = {
        {{0, 0, 0}, {4, 3, 5}},
        {{5, 0, 4}, {9, 3, 9}},
        {{5, 0, 5}, {10, 3, 9}},
        {{9, 0, 0}, {14, 3, 4}},
        {{0, 0, 0}, {4, 3, 5}}};
    for (std::uint32_t index = 0; index < blocks.size(); ++index) {
        const GridPart part(size, {}, blocks[index]);
        std::vector<Site> scan(blocks[index].size().cell_count());
        std::iota(scan.begin(), scan.end(), Site{0});
        const BlockOptions options = {4, Order::kScan, scan};
        const RandomKey key = {5, index, 0, 0};
        BlockSearch<GridPart> forgetful(relations, domains, weights);
        EXPECT_EQ(keeping.modify(part, with, options, key, {}).outcome, BlockOutcome::kAccepted)
            << index;
        EXPECT_EQ(
            forgetful.modify(part, without, options, key, {}).outcome, BlockOutcome::kAccepted
        ) << index;
        EXPECT_EQ(with, without) << index;
    }
    EXPECT_NE(with, std::vector<Label>(size.cell_count(), 3));

    // Block after block, as of a schedule: what stands to the east and south is as it was.
    const std::vector<Label> usual(size.cell_count(), 3);
    const std::vector<Box> schedule = *schedule_blocks(size, {{4, 3, 4}, 0.5, 2}, 1000);
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        with = without = usual;
        for (std::uint32_t index = 0; index < schedule.size(); ++index) {
            const GridPart part(size, {}, schedule[index]);
            std::vector<Site> scan(part.inner().site_count());
            std::iota(scan.begin(), scan.end(), Site{0});
            BlockOptions options = {4, Order::kScan, scan};
            options.usual = usual;
            const RandomKey key = {seed, index, 0, 0};
            const BlockResult kept = keeping.modify(part, with, options, key, {});
            BlockSearch<GridPart> forgetful(relations, domains, weights);
            const BlockResult made = forgetful.modify(part, without, options, key, {});
            EXPECT_EQ(kept.outcome, made.outcome);
            EXPECT_EQ(kept.attempts, made.attempts);
            EXPECT_EQ(with, without) << seed << ' ' << index;
        }
    }
}

TEST(BlockBases, KnowWhatTheyCameOf) {
    const GridTopology topology({2, 1, 2}, {});
    using Bases = BlockBases<GridTopology>;
    Bases bases;
    const Bases::Key key = {5, {1, 2, 3}, {0, 0, 1, 0}};
    EXPECT_FALSE(bases.is_asked_again(key));
    EXPECT_TRUE(bases.is_asked_again(key));
    EXPECT_EQ(bases.find(topology, key), nullptr);
    bases.keep({topology, key, {7}});
    ASSERT_NE(bases.find(topology, key), nullptr);
    EXPECT_EQ(bases.find(topology, key)->sets, std::vector<Word>{7});
    for (const Bases::Key& other :
         {Bases::Key{4, {1, 2, 3}, {0, 0, 1, 0}},
          Bases::Key{5, {1, 3, 2}, {0, 0, 1, 0}},
          Bases::Key{5, {1, 2, 3}, {0, 1, 0, 0}},
          Bases::Key{0, {}, {0, 0, 1, 0}}}) {
        EXPECT_EQ(bases.find(topology, other), nullptr);
        EXPECT_FALSE(bases.is_asked_again(other));
    }
    EXPECT_EQ(bases.find(GridTopology({4, 1, 1}, {}), key), nullptr);
    // Of more than there is memory for, the oldest go.
    const std::vector<Word> half(std::size_t{1} << 19);
    bases.keep({topology, {1, {}, {}}, half});
    EXPECT_NE(bases.find(topology, key), nullptr);
    bases.keep({topology, {2, {}, {}}, half});
    EXPECT_EQ(bases.find(topology, key), nullptr);
    EXPECT_NE(bases.find(topology, {2, {}, {}}), nullptr);
}

TEST(LabelSet, GroupsHoldTheLabelsOfTheSet) {
    LabelSet set(131);
    std::set<std::size_t> expected;
    for (const std::size_t label : {0U, 3U, 4U, 63U, 64U, 70U, 130U}) {
        set.insert(static_cast<Label>(label));
        expected.insert(label);
    }
    const auto expect_all = [&]<std::size_t kBits>() {
        std::set<std::size_t> found;
        for_each_group<kBits>(set.words(), [&](std::size_t group, std::size_t members) {
            EXPECT_NE(members, 0U);
            for (std::size_t i = 0; i < kBits; ++i) {
                if ((members >> i & 1) != 0) {
                    EXPECT_TRUE(found.insert(kBits * group + i).second);
                }
            }
        });
        EXPECT_EQ(found, expected);
    };
    expect_all.operator()<4>();
    expect_all.operator()<8>();
}

TEST(BlockSearch, StopsWhenAskedAndLeavesTheModel) {
    std::stop_source stop;
    stop.request_stop();
    const GridSize size = {40, 40, 40};  // enough sites that propagation looks at the token
    const GridPart part(size, {}, Box::whole(size));
    Relations relations(3, {1, 0, 3, 2, 5, 4});
    for (RelationId r = 0; r < 6; r += 2) {
        for (Label a = 0; a < 3; ++a) {
            relations.allow(r, a, a);
        }
    }
    const SiteDomains domains(size.cell_count(), LabelSet::all(3));
    const std::array<double, 3> given = {1, 1, 1};
    std::vector<Label> labels(size.cell_count(), 2);
    const SiteWeights weights{LabelWeights(given)};
    const BlockResult result =
        BlockSearch<GridPart>(relations, domains, weights)
            .modify(part, std::span<Label>(labels), {1, Order::kRandom, {}}, {}, stop.get_token());
    EXPECT_EQ(result.outcome, BlockOutcome::kStopped);
    EXPECT_TRUE(std::all_of(labels.begin(), labels.end(), [](Label l) { return l == 2; }));
}

TEST(SiteDomains, NarrowingKeepsTheIntersectionAndSharesSets) {
    SiteDomains domains(100, LabelSet::all(5));
    LabelSet even(5);
    even.insert(0);
    even.insert(2);
    LabelSet low(5);
    low.insert(0);
    low.insert(1);
    for (Site site = 0; site < 50; ++site) {
        domains.narrow(site, even);
    }
    domains.narrow(7, low);
    EXPECT_EQ(domains.at(7).count(), 1U);
    EXPECT_TRUE(domains.at(7).contains(0));
    EXPECT_EQ(domains.at(8), even);
    EXPECT_EQ(domains.at(60).count(), 5U);
}

// Sites of one set are kept many at a time: the same must come of it at their borders.
TEST(SiteDomains, TellEverySitesNumberHoweverManyAreAskedForAtOnce) {
    constexpr std::size_t kSites = 333;
    SiteDomains domains(kSites, LabelSet::all(4));
    std::vector<std::set<Label>> expected(kSites, {0, 1, 2, 3});
    const auto narrow = [&](Site first, Site last, Label gone) {
        LabelSet allowed = LabelSet::all(4);
        allowed.erase(gone);
        for (Site site = first; site <= last; ++site) {
            domains.narrow(site, allowed);
            expected[site].erase(gone);
        }
    };
    narrow(64, 127, 0);
    narrow(100, 200, 1);
    narrow(332, 332, 2);
    domains.repeat(5, 332);
    expected[5] = expected[332];
    domains.repeat(100, 0);
    expected[100] = expected[0];
    for (std::size_t count : {std::size_t{1}, std::size_t{10}, std::size_t{64}, kSites}) {
        for (std::size_t first = 0; first + count <= kSites; ++first) {
            std::vector<std::uint16_t> numbers(count);
            domains.copy_numbers(static_cast<Site>(first), numbers);
            std::vector<std::uint16_t> of_runs;
            domains.for_each_run(
                static_cast<Site>(first),
                count,
                [&](Site site, std::size_t run, std::uint16_t number) {
                    ASSERT_EQ(site, first + of_runs.size());
                    of_runs.insert(of_runs.end(), run, number);
                }
            );
            ASSERT_EQ(numbers, of_runs);
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(numbers[i], domains.number(static_cast<Site>(first + i)));
                std::set<Label> labels;
                for_each_label(domains.set(numbers[i]).words(), [&labels](Label label) {
                    labels.insert(label);
                });
                ASSERT_EQ(labels, expected[first + i]) << first + i;
            }
        }
    }
}

}  // namespace
}  // namespace modelsynth
