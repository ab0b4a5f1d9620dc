// The search against brute force, over random small problems.

#include "solver/core/search.h"

#include "solver/core/attempt_plan.h"
#include "solver/core/block_search.h"
#include "solver/core/catalog.h"
#include "tests/support/graph.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace modelsynth {
namespace {

// Three colours for random graphs of about as many edges as still allow it: propagation alone
// sees little, and most early choices are found wrong late.
constexpr std::size_t kLabels = 3;
constexpr std::size_t kSites = 24;
constexpr std::size_t kEdges = 52;

using GraphCatalog = Catalog<GraphTopology, 1>;

GraphTopology random_graph(std::uint64_t seed) {
    RandomStream random({seed, 0, 0, 1});
    std::vector<GraphArc> arcs;
    for (std::size_t edge = 0; edge < kEdges; ++edge) {
        const auto a = static_cast<Site>(random.below(kSites));
        const auto b = static_cast<Site>((a + 1 + random.below(kSites - 1)) % kSites);
        arcs.push_back({a, b, 0, 0});
    }
    return {kSites, arcs};
}

bool fits(const GraphTopology& graph, const std::vector<Label>& labels, Site site) {
    bool differs = true;
    graph.for_each_arc(site, [&](Site to, RelationId) {
        differs = differs && labels[to] != labels[site];
    });
    return differs;
}

// By brute force.
bool can_be_coloured(const GraphTopology& graph, std::vector<Label>& labels, Site site) {
    if (site == labels.size()) {
        return true;
    }
    for (Label label = 0; label < kLabels; ++label) {
        labels[site] = label;
        if (fits(graph, labels, site) && can_be_coloured(graph, labels, site + 1)) {
            return true;
        }
    }
    labels[site] = kNoLabel;
    return false;
}

struct Result {
    SearchOutcome outcome;
    std::vector<Label> labels;
    std::uint32_t backtracks;
};

template <class MakePicker>
Result search(
    const GraphTopology& graph, std::uint64_t seed, std::uint32_t budget, MakePicker make_picker
) {
    const Relations relations = testing::make_colouring(kLabels);
    RandomStream random({seed, 0, 0, 2});
    const std::vector<double> given(kLabels, 1);
    const SiteWeights everywhere{LabelWeights(given)};
    const PartWeights weights = {everywhere, {}};
    GraphCatalog catalog(graph, relations);
    catalog.fill(LabelSet::all(kLabels).words());
    catalog.enqueue_all();
    EXPECT_EQ(catalog.propagate({}), Propagation::kConsistent);
    auto picker = make_picker(catalog, weights, random);
    Search search(catalog, picker, weights, {}, random, {});
    Result result = {search.run({budget}), {}, search.backtracks()};
    if (result.outcome == SearchOutcome::kSolved) {
        for (Site site = 0; site < kSites; ++site) {
            EXPECT_EQ(count_labels(catalog.labels(site)), 1U);
            for_each_label(catalog.labels(site), [&](Label label) {
                result.labels.push_back(label);
            });
        }
    }
    return result;
}

TEST(Search, SolvesWhatCanBeSolvedAndNothingElseWhenItMayTakeEnoughBack) {
    std::vector<Site> scan(kSites);
    std::iota(scan.begin(), scan.end(), Site{0});
    const auto by_scan = [&](auto&, const auto&, auto&) { return ScanPicker(scan); };
    const auto by_entropy = [](auto& catalog, const auto& weights, auto& random) {
        return LeastOpenPicker(catalog, weights, random, Openness::kEntropy);
    };
    std::size_t soluble = 0;
    std::size_t missed_without = 0;
    constexpr std::size_t kGraphs = 150;
    for (std::uint64_t seed = 0; seed < kGraphs; ++seed) {
        const GraphTopology graph = random_graph(seed);
        std::vector<Label> none(kSites, kNoLabel);
        const bool is_soluble = can_be_coloured(graph, none, 0);
        soluble += std::size_t{is_soluble};
        for (const std::uint32_t budget : {0U, 5U, 10'000U}) {
            for (const Result& result :
                 {search(graph, seed, budget, by_scan), search(graph, seed, budget, by_entropy)}) {
                const bool is_solved = result.outcome == SearchOutcome::kSolved;
                EXPECT_LE(result.backtracks, budget);
                EXPECT_TRUE(is_soluble || !is_solved) << seed;
                EXPECT_TRUE(is_solved || !is_soluble || budget < 10'000) << seed;
                for (Site site = 0; is_solved && site < kSites; ++site) {
                    EXPECT_TRUE(fits(graph, result.labels, site)) << seed;
                }
                missed_without += std::size_t{budget == 0 && is_soluble && !is_solved};
            }
        }
    }
    // The graphs are such that all of this is seen.
    EXPECT_GT(soluble, kGraphs / 5);
    EXPECT_LT(soluble, kGraphs * 4 / 5);
    EXPECT_GT(missed_without, kGraphs / 10);
}

TEST(AttemptPlan, BeginsWithTheOrderAskedForAndTakesBackMoreAndMore) {
    std::uint32_t before = 0;
    for (std::uint32_t attempt = 1; attempt < 200; attempt += 2) {
        EXPECT_FALSE(attempt_plan(attempt).is_other_order);
        EXPECT_TRUE(attempt_plan(attempt + 1).is_other_order);
        EXPECT_GE(attempt_plan(attempt).budget.backtracks, before);
        before = attempt_plan(attempt).budget.backtracks;
        EXPECT_LE(attempt_plan(attempt + 1).budget.backtracks, before);
    }
    EXPECT_EQ(attempt_plan(1).budget.backtracks, 8U);
    EXPECT_EQ(attempt_plan(2).budget.backtracks, 0U);
    EXPECT_EQ(before, 1000U);
}

}  // namespace
}  // namespace modelsynth
