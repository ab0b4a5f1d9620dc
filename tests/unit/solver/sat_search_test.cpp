// The back end over CaDiCaL against brute force, over random tiny problems.

#include "solver/core/sat/sat_search.h"

#include "solver/core/block_search.h"
#include "solver/core/grid_topology.h"
#include "tests/support/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

namespace modelsynth {
namespace {

// A random graph, loops and double arcs too, of labels that few pairs of may be neighbours.
struct Tiny {
    explicit Tiny(std::uint64_t seed)
        : random({seed, 0, 0, 97}),
          label_count(2 + random.below(9)),
          graph(random_graph()),
          relations(label_count, {1, 0, 2}),
          sets(graph.site_count() * relations.words()),
          weights(LabelWeights(std::vector<double>(label_count, 1.0))) {
        const auto labels = static_cast<std::uint32_t>(label_count);
        const std::uint32_t share = 1 + random.below(5);
        for (Label a = 0; a < label_count; ++a) {
            for (Label b = 0; b < label_count; ++b) {
                for (const RelationId relation : {RelationId{0}, RelationId{2}}) {
                    if (random.below(10) < share) {
                        relations.allow(relation, a, b);
                    }
                }
            }
        }
        for (Word& set : sets) {
            set = LabelSet::all(label_count).words()[0];
            if (random.below(3) == 0) {
                set &= Word{random.below(1U << labels)};
            }
        }
    }

    GraphTopology random_graph() {
        const std::uint32_t sites = 2 + random.below(5);
        std::vector<GraphArc> arcs(1 + random.below(2 * sites));
        for (GraphArc& arc : arcs) {
            const bool is_alike = random.below(3) == 0;
            arc = {random.below(sites), random.below(sites), 0, 1};
            arc.from_a = is_alike ? 2 : 0;
            arc.from_b = is_alike ? 2 : 1;
        }
        return {sites, arcs};
    }

    [[nodiscard]] bool fits(const std::vector<Label>& labels, Site site) const {
        bool all = (sets[site] >> labels[site] & 1) != 0;
        graph.for_each_arc(site, [&](Site far, RelationId relation) {
            all = all && (labels[far] == kNoLabel ||
                          relations.allows(relation, labels[site], labels[far]));
        });
        return all;
    }

    [[nodiscard]] bool can_be(std::vector<Label>& labels, Site site) const {
        if (site == labels.size()) {
            return true;
        }
        for (Label label = 0; label < label_count; ++label) {
            labels[site] = label;
            if (fits(labels, site) && can_be(labels, site + 1)) {
                return true;
            }
        }
        labels[site] = kNoLabel;
        return false;
    }

    SatOutcome solve(std::vector<Label>& labels, std::uint64_t seed = 1) const {
        labels.assign(graph.site_count(), kNoLabel);
        return solve_by_sat(graph, relations, sets, {weights, {}}, {seed, 0, 0, 0}, {}, {}, labels)
            .outcome;
    }

    RandomStream random;
    std::size_t label_count;
    GraphTopology graph;
    Relations relations;
    std::vector<Word> sets;
    SiteWeights weights;
};

TEST(SatSearch, AgreesWithBruteForce) {
    std::size_t possible = 0;
    constexpr std::size_t kCases = 600;
    for (std::uint64_t seed = 0; seed < kCases; ++seed) {
        const Tiny tiny(seed);
        std::vector<Label> labels(tiny.graph.site_count(), kNoLabel);
        const bool expected = tiny.can_be(labels, 0);
        possible += expected ? 1U : 0U;
        const SatOutcome outcome = tiny.solve(labels);
        ASSERT_EQ(outcome, expected ? SatOutcome::kSolved : SatOutcome::kImpossible) << seed;
        for (Site site = 0; site < labels.size(); ++site) {
            ASSERT_TRUE(expected ? tiny.fits(labels, site) : labels[site] == kNoLabel) << seed;
        }
    }
    EXPECT_GT(possible, kCases / 5);
    EXPECT_LT(possible, kCases * 4 / 5);
}

// Under the guards of a core alone there is nothing, and the core is of what was assumed.
TEST(SatSearch, GuardsOfACoreCannotHoldTogether) {
    std::size_t cores = 0;
    for (std::uint64_t seed = 0; seed < 800; ++seed) {
        Tiny tiny(seed);
        const std::vector<Word> narrow = tiny.sets;
        const Word all = LabelSet::all(tiny.label_count).words()[0];
        std::fill(tiny.sets.begin(), tiny.sets.end(), all);
        LabelFormula formula(tiny.relations, tiny.sets, 100'000, 1);
        formula.add_arcs(tiny.graph);
        std::vector<LabelFormula::Guard> guards;
        for (Site site = 0; site < narrow.size(); ++site) {
            guards.push_back(formula.narrow_if_assumed(site, {&narrow[site], 1}));
        }
        std::vector<Label> labels(narrow.size(), kNoLabel);
        const bool open_can_be = tiny.can_be(labels, 0);
        ASSERT_EQ(
            formula.solve({}, 1000, {}),
            open_can_be ? CnfOutcome::kSatisfied : CnfOutcome::kUnsatisfiable
        );
        if (formula.solve(guards, 1000, {}) == CnfOutcome::kSatisfied) {
            for (Site site = 0; site < narrow.size(); ++site) {
                ASSERT_NE(narrow[site] >> formula.label(site) & 1, Word{0}) << seed;
            }
            continue;
        }
        for (Site site = 0; site < narrow.size(); ++site) {
            tiny.sets[site] = formula.is_in_core(guards[site]) ? narrow[site] : all;
            cores += formula.is_in_core(guards[site]) ? 1U : 0U;
        }
        labels.assign(narrow.size(), kNoLabel);
        ASSERT_FALSE(tiny.can_be(labels, 0)) << seed;
    }
    EXPECT_GT(cores, std::size_t{60});
}

// Three colours on a grid that closes on itself along x and z: what the block search makes is
// possible, and so is every part of it that is made anew with the rest as it is.
TEST(SatSearch, SolvesWhatTheSearchSolves) {
    const GridSize size = {6, 3, 6};
    const std::size_t cells = size.cell_count();
    Relations relations(3, {1, 0, 3, 2, 5, 4});
    for (Label a = 0; a < 3; ++a) {
        for (Label b = 0; b < 3; ++b) {
            if (a != b) {
                relations.allow(0, a, b);
                relations.allow(2, a, b);
                relations.allow(4, a, b);
            }
        }
    }
    const SiteDomains domains(cells, LabelSet::all(3));
    const SiteWeights weights{LabelWeights(std::vector<double>{1, 2, 3})};
    const GridPart whole(size, {true, false, true}, Box::whole(size));
    std::vector<Site> scan(cells);
    std::iota(scan.begin(), scan.end(), Site{0});
    BlockSearch<GridPart> search(relations, domains, weights);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::vector<Label> model(cells, kNoLabel);
        const RandomKey key = {seed, 0, 0, 0};
        const auto made = search.modify(whole, model, {8, Order::kScan, scan}, key, {});
        ASSERT_EQ(made.outcome, BlockOutcome::kAccepted);
        // Every other cell as it is, the others open.
        std::vector<Word> sets(cells, Word{7});
        for (std::size_t cell = 0; cell < cells; cell += 2) {
            sets[cell] = Word{1} << model[cell];
        }
        std::vector<Label> labels(cells, kNoLabel);
        ASSERT_EQ(
            solve_by_sat(whole.inner(), relations, sets, {weights, {}}, key, {}, {}, labels)
                .outcome,
            SatOutcome::kSolved
        );
        for (std::size_t cell = 0; cell < cells; ++cell) {
            ASSERT_NE(sets[cell] >> labels[cell] & 1, Word{0});
            whole.inner().for_each_arc(static_cast<Site>(cell), [&](Site far, RelationId) {
                ASSERT_NE(labels[cell], labels[far]);
            });
        }
    }
}

TEST(SatSearch, EqualSeedsGiveEqualModelsAndOthersOthers) {
    const std::size_t sites = 40;
    std::vector<GraphArc> arcs;
    for (Site site = 0; site < sites; ++site) {
        arcs.push_back({site, static_cast<Site>((site + 1) % sites), 0, 0});
    }
    const GraphTopology ring(sites, arcs);
    const Relations relations = testing::make_colouring(4);
    const SiteWeights weights{LabelWeights(std::vector<double>{1, 1, 1, 1})};
    const std::vector<Word> sets(sites, Word{15});
    std::set<std::vector<Label>> models;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        std::vector<Label> first(sites);
        std::vector<Label> second(sites);
        for (std::vector<Label>* labels : {&first, &second}) {
            ASSERT_EQ(
                solve_by_sat(ring, relations, sets, {weights, {}}, {seed}, {}, {}, *labels).outcome,
                SatOutcome::kSolved
            );
        }
        EXPECT_EQ(first, second);
        models.insert(first);
    }
    EXPECT_EQ(models.size(), std::size_t{10});
}

// Where neighbours need not differ, each label is as often as its weight asks, more or less.
TEST(SatSearch, PrefersLabelsByWeight) {
    const std::size_t sites = 1000;
    const GraphTopology lonely(sites, {});
    const Relations relations = testing::make_colouring(2);
    const SiteWeights weights{LabelWeights(std::vector<double>{1, 3})};
    const std::vector<Word> sets(sites, Word{3});
    std::vector<Label> labels(sites);
    ASSERT_EQ(
        solve_by_sat(lonely, relations, sets, {weights, {}}, {5}, {}, {}, labels).outcome,
        SatOutcome::kSolved
    );
    const std::size_t ones = std::accumulate(labels.begin(), labels.end(), std::size_t{0});
    EXPECT_NEAR(static_cast<double>(ones), 750, 70);  // five standard deviations
}

// Pigeons and holes: n + 1 sites that all differ and n labels, hard for resolution.
struct Pigeons {
    explicit Pigeons(std::size_t holes)
        : graph(all_joined(holes + 1)),
          relations(testing::make_colouring(holes)),
          sets(holes + 1, (Word{1} << holes) - 1) {}

    static GraphTopology all_joined(std::size_t sites) {
        std::vector<GraphArc> arcs;
        for (Site a = 0; a < sites; ++a) {
            for (Site b = 0; b < a; ++b) {
                arcs.push_back({a, b, 0, 0});
            }
        }
        return {sites, arcs};
    }

    SatOutcome solve(const SatLimits& limits, const std::stop_token& stop = {}) const {
        const SiteWeights weights{LabelWeights(std::vector<double>(sets.size() - 1, 1.0))};
        std::vector<Label> labels(sets.size());
        return solve_by_sat(graph, relations, sets, {weights, {}}, {1}, limits, stop, labels)
            .outcome;
    }

    GraphTopology graph;
    Relations relations;
    std::vector<Word> sets;
};

TEST(SatSearch, GivesUpAtItsLimits) {
    EXPECT_EQ(Pigeons(6).solve({}), SatOutcome::kImpossible);
    EXPECT_EQ(Pigeons(11).solve({3'000'000, 500}), SatOutcome::kGaveUp);
    const Pigeons small(6);
    LabelFormula formula(small.relations, small.sets, 1'000'000, 1);
    formula.add_arcs(small.graph);
    EXPECT_EQ(small.solve({formula.literal_count(), 20'000}), SatOutcome::kImpossible);
    EXPECT_EQ(small.solve({formula.literal_count() - 1, 20'000}), SatOutcome::kGaveUp);
}

TEST(SatSearch, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(
        Pigeons(12).solve({3'000'000, 1'000'000'000}, stop.get_token()), SatOutcome::kStopped
    );
}

}  // namespace
}  // namespace modelsynth
