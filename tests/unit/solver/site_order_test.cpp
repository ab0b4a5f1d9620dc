#include "solver/core/site_order.h"

#include "solver/core/catalog.h"
#include "solver/core/graph_topology.h"
#include "solver/core/grid_topology.h"
#include "solver/discrete/preparation.h"
#include "solver/discrete/scan_order.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"
#include "tests/support/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace modelsynth {
namespace {

using discrete::ScanAxes;

TEST(ScanOrder, HasEverySiteOnceAndTheSlowestAxisFirst) {
    const GridSize size = {3, 4, 5};
    ScanAxes axes = {0, 1, 2};
    std::set<std::vector<Site>> orders;
    do {
        const std::vector<Site> order = discrete::scan_order(size, axes);
        EXPECT_EQ(std::set<Site>(order.begin(), order.end()).size(), size.cell_count());
        const auto place = [&](Site site) {
            const Cell cell = size.cell(site);
            const std::array<std::int32_t, 3> at = {cell.x, cell.y, cell.z};
            return std::array<std::int32_t, 3>{at[axes[0]], at[axes[1]], at[axes[2]]};
        };
        EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [&](Site a, Site b) {
            return place(a) < place(b);
        }));
        orders.insert(order);
    } while (std::next_permutation(axes.begin(), axes.end()));
    EXPECT_EQ(orders.size(), 6U);
}

template <class T>
Catalog<T, 1> open_catalog(const T& topology, const Relations& relations) {
    Catalog<T, 1> catalog(topology, relations);
    catalog.fill(LabelSet::all(relations.label_count()).words());
    return catalog;
}

TEST(GrowingSites, AreEachBesideOneBeforeOrDecidedFromTheBeginning) {
    const GridTopology grid({6, 2, 5});
    Relations relations(3, {1, 0, 3, 2, 5, 4});
    for (RelationId r = 0; r < 6; r += 2) {
        for (Label a = 0; a < 3; ++a) {
            for (Label b = 0; b < 3; ++b) {
                relations.allow(r, a, b);
            }
        }
    }
    auto catalog = open_catalog(grid, relations);
    const std::set<Site> seeds = {7, 40};
    for (const Site seed : seeds) {
        catalog.assign(seed, 1);
    }
    std::set<std::vector<Site>> orders;
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        RandomStream random({seed, 0, 0, 1});
        const std::vector<Site> order = growing_sites(catalog, grid, random);
        std::set<Site> before;
        for (const Site site : order) {
            bool is_beside = false;
            grid.for_each_arc(site, [&](Site to, RelationId) {
                is_beside = is_beside || before.contains(to);
            });
            EXPECT_TRUE(is_beside || seeds.contains(site)) << site;
            before.insert(site);
        }
        EXPECT_EQ(before.size(), grid.site_count());
        EXPECT_EQ(order.size(), grid.site_count());
        orders.insert(order);
    }
    EXPECT_EQ(orders.size(), 5U);
}

TEST(GrowingSites, ReachWhatDoesNotHangTogether) {
    const std::array<GraphArc, 2> arcs = {{{0, 1, 0, 0}, {3, 4, 0, 0}}};
    const GraphTopology graph(6, arcs);
    const Relations relations = testing::make_colouring(3);
    const auto catalog = open_catalog(graph, relations);
    RandomStream random({1, 0, 0, 1});
    const std::vector<Site> order = growing_sites(catalog, graph, random);
    EXPECT_EQ(std::set<Site>(order.begin(), order.end()).size(), 6U);
}

TEST(LeastOpenPicker, TakesFewestLabelsOrLeastEntropyAsAsked) {
    // Three likely labels are more open than four of which one is all but certain.
    const std::vector<double> given = {1000, 1, 1, 1, 1000, 1000, 1000};
    const SiteWeights everywhere{LabelWeights(given)};
    const PartWeights weights = {everywhere, {}};
    const GraphTopology graph(2, {});
    const Relations relations = testing::make_colouring(7);
    for (const auto& [openness, expected] :
         {std::pair(Openness::kEntropy, Site{0}), std::pair(Openness::kLabelCount, Site{1})}) {
        Catalog<GraphTopology, 1> catalog(graph, relations);
        const std::vector<Word> sets = {0b0001111, 0b1110000};
        catalog.restore(sets);
        RandomStream random({1, 0, 0, 1});
        LeastOpenPicker picker(catalog, weights, random, openness);
        Site site = 9;
        ASSERT_TRUE(picker.next(catalog, site));
        EXPECT_EQ(site, expected);
    }
}

TEST(Order, ChosenForAnExampleIsOneThatCanBeAskedFor) {
    for (const auto& example : examples::built_in()) {
        discrete::Parameters parameters;
        parameters.size = GridSize{24, 8, 24};
        parameters.order.is_chosen_for_it = true;
        parameters = discrete::fill_defaults(parameters, *example);
        const auto chosen = discrete::Preparation::make(example, parameters).value();
        parameters.order = {chosen->order()};
        const auto asked_for = discrete::Preparation::make(example, parameters).value();
        testing::RecordingObserver observer;
        const auto a = discrete::synthesise(*chosen, 3, observer, {}).value();
        const auto b = discrete::synthesise(*asked_for, 3, observer, {}).value();
        EXPECT_EQ(a.labels, b.labels);
    }
}

// The trial asks how often a search succeeds; other seeds have to bear it out.
TEST(Order, ChosenByTrialSucceedsMoreOften) {
    constexpr std::uint64_t kExamples = 400;
    constexpr std::uint64_t kSeeds = 6;

    struct Successes {
        int examples = 0;
        int by_scan = 0;
        int by_entropy = 0;
    };

    std::array<Successes, 2> of_chosen;  // scan, least entropy
    for (std::uint64_t number = 1; number <= kExamples; ++number) {
        const auto example =
            std::make_shared<const discrete::Example>(testing::make_tiny_example(number, true));
        discrete::Parameters parameters;
        parameters.size = GridSize{20, 1, 20};
        parameters.blocks = std::optional<Blocks>();
        parameters = discrete::fill_defaults(parameters, *example);
        parameters.order.is_chosen_for_it = true;
        const auto chosen = discrete::Preparation::make(example, parameters);
        if (!chosen) {
            continue;  // nothing of that size has its pairs
        }
        const auto successes = [&](Order order) {
            parameters.order = {order};
            const auto preparation = discrete::Preparation::make(example, parameters).value();
            constexpr auto kFirstTry = static_cast<std::size_t>(SolvedBy::kFirstTry);
            int count = 0;
            for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
                testing::RecordingObserver observer;
                const auto made = discrete::synthesise(*preparation, seed, observer, {});
                count += made && made->stats.blocks.solved_by.at(kFirstTry) == 1 ? 1 : 0;
            }
            return count;
        };
        Successes& sums = of_chosen.at((*chosen)->order() == Order::kScan ? 0 : 1);
        ++sums.examples;
        sums.by_scan += successes(Order::kScan);
        sums.by_entropy += successes(Order::kMinEntropy);
    }
    EXPECT_GT(of_chosen[0].examples, 0);
    EXPECT_GE(of_chosen[0].by_scan, of_chosen[0].by_entropy);
    EXPECT_GT(of_chosen[1].examples, 0);
    EXPECT_GT(of_chosen[1].by_entropy, of_chosen[1].by_scan);
}

}  // namespace
}  // namespace modelsynth
