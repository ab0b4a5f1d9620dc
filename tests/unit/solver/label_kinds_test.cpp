// Labels numbered by kinds of sites: the same models as without, in shorter sets.

#include "solver/core/label_kinds.h"

#include "solver/core/block_schedule.h"
#include "solver/core/block_search.h"
#include "solver/core/kind_relations.h"
#include "solver/core/layered_relations.h"
#include "solver/core/part_numbering.h"
#include "tests/support/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace modelsynth {
namespace {

using testing::part_of_graph;
using testing::whole_graph;

LabelSet range_of(std::size_t label_count, std::size_t first, std::size_t end) {
    LabelSet set(label_count);
    for (std::size_t label = first; label < end; ++label) {
        set.insert(static_cast<Label>(label));
    }
    return set;
}

std::vector<Site> in_order(std::size_t count) {
    std::vector<Site> sites(count);
    std::iota(sites.begin(), sites.end(), Site{0});
    return sites;
}

// What one search or the other came to.
using Outcome = std::tuple<BlockOutcome, std::uint32_t, std::uint32_t, SolvedBy>;

Outcome outcome_of(const BlockResult& result) {
    return {result.outcome, result.attempts, result.backtracks, result.solved_by};
}

TEST(LabelKinds, NumberTheLabelsOfEachKindInTheirOrder) {
    const std::vector<LabelSet> sets = {range_of(150, 3, 140), range_of(150, 60, 70)};
    const LabelKinds kinds(sets);
    EXPECT_EQ(kinds.count(), 2U);
    EXPECT_EQ(kinds.words(), 3U);
    EXPECT_EQ(kinds.labels(1).size(), 10U);
    EXPECT_EQ(kinds.labels(1)[4], 64);
    EXPECT_EQ(kinds.number(1, 64), 4);
    EXPECT_EQ(kinds.number(1, 59), kNoLabel);
    EXPECT_EQ(kinds.number(0, 64), 61);
    LabelSet some(150);
    for (const int label : {2, 3, 66, 69, 70, 139, 140}) {
        some.insert(static_cast<Label>(label));
    }
    std::vector<Word> numbered(3, ~Word{0});
    kinds.put_numbered(1, some.words(), numbered.data());
    EXPECT_EQ(numbered, (std::vector<Word>{Word{1} << 6 | Word{1} << 9, 0, 0}));
    kinds.put_numbered(0, some.words(), numbered.data());
    EXPECT_EQ(
        numbered,
        (std::vector<Word>{
            Word{1} | Word{1} << 63,
            Word{1} << (66 - 64) | Word{1} << (67 - 64),
            Word{1} << (136 - 128)})
    );
}

TEST(LabelKinds, DrawAndMeasureAsTheWholeDoes) {
    RandomStream random({3, 0, 0, 1});
    std::vector<double> given;
    for (int label = 0; label < 150; ++label) {
        given.push_back(label < 40 ? 2 : random.below(5));
    }
    const SiteWeights weights{LabelWeights(given)};
    // The first has one weight, and the second is small beside the words of a set.
    const std::vector<LabelSet> sets = {
        range_of(150, 0, 40), range_of(150, 90, 120), range_of(150, 5, 150)};
    const LabelKinds kinds(sets);
    const SiteWeights numbered = kinds.numbered(weights);
    ASSERT_EQ(numbered.table_count(), 3U);
    for (std::uint64_t draw = 0; draw < 300; ++draw) {
        const auto kind = static_cast<std::uint8_t>(draw % 3);
        LabelSet some(150);
        do {
            for (const Label label : kinds.labels(kind)) {
                if (random.below(3) == 0) {
                    some.insert(label);
                }
            }
        } while (some.empty());
        std::vector<Word> own(kinds.words());
        kinds.put_numbered(kind, some.words(), own.data());
        EXPECT_EQ(numbered.table(kind).entropy(own), weights.table(0).entropy(some.words()));
        RandomStream one({draw, 0, 0, 2});
        RandomStream other({draw, 0, 0, 2});
        const Label drawn = numbered.table(kind).draw(own, one);
        EXPECT_EQ(kinds.labels(kind)[drawn], weights.table(0).draw(some.words(), other));
    }
}

// A grid of random relations, in the layers of which few of many labels can stand.
struct LayeredGrid {
    GridSize size = {9, 5, 8};
    std::size_t label_count;
    Relations relations;
    SiteDomains domains;

    LayeredGrid(std::size_t labels, std::uint64_t seed)
        : label_count(labels),
          relations(labels, {1, 0, 3, 2, 5, 4}),
          domains(size.cell_count(), LabelSet::all(labels)) {
        RandomStream random({seed, 0, 0, 1});
        const auto a_layer = labels / static_cast<std::size_t>(size.y);
        const auto of_layer = [&](std::size_t layer) {
            return static_cast<Label>(
                layer * a_layer + random.below(static_cast<std::uint32_t>(a_layer))
            );
        };
        for (std::size_t layer = 0; layer < static_cast<std::size_t>(size.y); ++layer) {
            for (std::size_t i = 0; i < a_layer; ++i) {
                const auto label = static_cast<Label>(layer * a_layer + i);
                relations.allow(0, label, label);
                relations.allow(4, label, label);
                if (layer > 0) {
                    relations.allow(2, static_cast<Label>(label - a_layer), label);
                }
            }
            for (std::size_t pairs = 0; pairs < 4 * a_layer; ++pairs) {
                relations.allow(0, of_layer(layer), of_layer(layer));
                relations.allow(4, of_layer(layer), of_layer(layer));
                if (layer + 1 < static_cast<std::size_t>(size.y)) {
                    relations.allow(2, of_layer(layer), of_layer(layer + 1));
                }
            }
        }
        for_each_cell(Box::whole({size.x, 1, size.z}), [&](const Cell& cell) {
            domains.narrow(static_cast<Site>(size.index(cell)), range_of(labels, 0, a_layer));
        });
        for (int i = 0; i < 6; ++i) {  // some cells are told apart
            const Site site = random.below(static_cast<std::uint32_t>(size.cell_count()));
            LabelSet allowed = LabelSet::all(labels);
            for (std::size_t label = 0; label < labels; label += 3) {
                if (label != plain(site)) {
                    allowed.erase(static_cast<Label>(label));
                }
            }
            domains.narrow(site, allowed);
        }
    }

    // Of a model that fits everywhere.
    [[nodiscard]] Label plain(Site site) const {
        const auto layer = static_cast<std::size_t>(size.cell(site).y);
        return static_cast<Label>(layer * (label_count / static_cast<std::size_t>(size.y)));
    }
};

// Every two labels side by side are allowed, and each at its site.
void expect_consistent(const LayeredGrid& grid, const std::vector<Label>& labels) {
    const GridTopology topology(grid.size);
    for (Site site = 0; site < labels.size(); ++site) {
        if (labels[site] == kNoLabel) {
            continue;
        }
        EXPECT_TRUE(grid.domains.at(site).contains(labels[site]));
        topology.for_each_arc(site, [&](Site far, RelationId relation) {
            EXPECT_TRUE(
                labels[far] == kNoLabel ||
                grid.relations.allows(relation, labels[site], labels[far])
            );
        });
    }
}

TEST(LayeredRelations, MakeTheSameModelsInShorterSets) {
    std::size_t accepted = 0;
    std::size_t backtracks = 0;
    std::size_t changed = 0;
    for (const std::size_t labels : {80U, 150U, 330U}) {
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            const LayeredGrid grid(labels, seed);
            std::vector<double> given;
            for (std::size_t label = 0; label < labels; ++label) {
                given.push_back(static_cast<double>(1 + label % 4));
            }
            std::vector<LabelWeights> tables = {LabelWeights(given)};
            std::vector<std::uint16_t> table_of_site;
            if (seed % 2 != 0) {
                std::reverse(given.begin(), given.end());
                tables.emplace_back(given);
                for (std::size_t site = 0; site < grid.size.cell_count(); ++site) {
                    table_of_site.push_back(static_cast<std::uint16_t>(site / 7 % 2));
                }
            }
            const SiteWeights weights(std::move(tables), std::move(table_of_site));
            const auto layers =
                LayeredRelations::make(grid.relations, grid.domains, weights, grid.size);
            ASSERT_NE(layers, nullptr);
            EXPECT_LT(layers->words(), grid.relations.words());
            BlockBases<GridTopology> bases;
            BlockSearch<GridPart> whole(grid.relations, grid.domains, weights);
            BlockSearch<GridPart> layered(
                grid.relations, grid.domains, weights, &bases, layers.get()
            );
            std::vector<Label> one;
            for (Site site = 0; site < grid.size.cell_count(); ++site) {
                one.push_back(grid.plain(site));
            }
            std::vector<Label> other = one;
            // All at once, then blocks as high as the grid, and lower ones.
            std::vector<Box> boxes = {Box::whole(grid.size)};
            for (const GridSize& block : {GridSize{4, 5, 4}, GridSize{5, 3, 4}}) {
                const auto more = schedule_blocks(grid.size, {block, 0.5, 1}, 1000);
                boxes.insert(boxes.end(), more->begin(), more->end());
            }
            for (std::uint32_t index = 0; index < boxes.size(); ++index) {
                const GridPart part(grid.size, {}, boxes[index]);
                const std::vector<Site> scan = in_order(part.inner().site_count());
                const Order order = index % 2 == 0 ? Order::kScan : Order::kMinEntropy;
                BlockOptions options = {6, order, scan};
                options.by_sat = SatLimits{100'000, 200};
                const RandomKey key = {seed, index, 0, 0};
                const BlockResult a = whole.modify(part, one, options, key, {});
                const BlockResult b = layered.modify(part, other, options, key, {});
                if (boxes[index].size().y < grid.size.y) {
                    // It knows what the layers above and below tell, and may take another way.
                    ASSERT_NE(b.outcome, BlockOutcome::kImpossible);
                    expect_consistent(grid, other);
                    one = other;
                    continue;
                }
                ASSERT_EQ(outcome_of(a), outcome_of(b)) << labels << ' ' << seed << ' ' << index;
                ASSERT_EQ(one, other) << labels << ' ' << seed << ' ' << index;
                accepted += a.outcome == BlockOutcome::kAccepted ? 1U : 0U;
                backtracks += a.backtracks;
            }
            for (Site site = 0; site < one.size(); ++site) {
                changed += one[site] != grid.plain(site) ? 1U : 0U;
            }
        }
    }
    EXPECT_GT(accepted, 100U);
    EXPECT_GT(backtracks, 10U);
    EXPECT_GT(changed, 500U);
}

TEST(LayeredRelations, AreNotMadeWhereSetsStayAsLong) {
    const LayeredGrid few(60, 1);  // one word as it is
    const std::vector<double> given(60, 1);
    const SiteWeights weights{LabelWeights(given)};
    EXPECT_EQ(LayeredRelations::make(few.relations, few.domains, weights, few.size), nullptr);

    Relations any(150, {1, 0, 3, 2, 5, 4});
    for (RelationId relation = 0; relation < 6; relation += 2) {
        for (Label label = 0; label < 150; ++label) {
            any.allow(relation, label, label);
        }
    }
    const SiteDomains all(few.size.cell_count(), LabelSet::all(150));
    const std::vector<double> more(150, 1);
    const SiteWeights same{LabelWeights(more)};
    EXPECT_EQ(LayeredRelations::make(any, all, same, few.size), nullptr);

    SiteDomains impossible = all;
    for_each_cell(Box::whole({few.size.x, 1, few.size.z}), [&](const Cell& cell) {
        impossible.narrow(static_cast<Site>(few.size.index(cell)), LabelSet(150));
    });
    EXPECT_EQ(LayeredRelations::make(any, impossible, same, few.size), nullptr);
}

// A random graph of sites of three kinds, which take few of many labels, and two relations.
struct KindedGraph {
    static constexpr std::size_t kSites = 60;
    std::size_t label_count;
    Relations relations;
    std::vector<GraphArc> arcs;
    SiteDomains domains;

    KindedGraph(std::size_t labels, std::uint64_t seed)
        : label_count(labels),
          relations(labels, {1, 0, 2}),
          domains(kSites, LabelSet::all(labels)) {
        RandomStream random({seed, 0, 0, 1});
        const auto any_of = [&random](std::size_t count) {
            return random.below(static_cast<std::uint32_t>(count));
        };
        const auto pairs = static_cast<std::uint32_t>(labels * labels / 3);
        for (std::uint32_t i = 0; i < pairs; ++i) {
            const auto a = static_cast<Label>(any_of(labels));
            const auto b = static_cast<Label>(any_of(labels));
            relations.allow(i % 2 == 0 ? RelationId{0} : RelationId{2}, a, b);
        }
        for (std::size_t i = 0; i < 3 * kSites / 2; ++i) {
            const auto a = static_cast<Site>(any_of(kSites));
            const auto b = static_cast<Site>(any_of(kSites));
            if (a != b) {
                const bool is_same = i % 3 == 0;
                arcs.push_back(
                    {a,
                     b,
                     is_same ? RelationId{2} : RelationId{0},
                     is_same ? RelationId{2} : RelationId{1}}
                );
            }
        }
        const std::vector<LabelSet> sets = {
            range_of(labels, labels / 2, labels / 2 + 70),
            range_of(labels, 0, 30),
            range_of(labels, labels / 2 + 5, labels / 2 + 20),
            range_of(labels, 10, 60)};
        for (Site site = 0; site < kSites; ++site) {
            domains.narrow(site, sets[any_of(sets.size())]);
        }
    }
};

TEST(KindRelations, AllowWhatTheWholeAllows) {
    const KindedGraph graph(270, 3);
    const std::vector<double> given(270, 1);
    const SiteWeights weights{LabelWeights(given)};
    const GraphTopology topology(KindedGraph::kSites, graph.arcs);
    const auto by_kind =
        KindRelations::make(graph.relations, graph.domains, weights, whole_graph(topology));
    ASSERT_NE(by_kind, nullptr);
    std::vector<Site> sites;
    for (Site site = 0; site < KindedGraph::kSites; site += 2) {
        sites.push_back(site);
    }
    const GraphPart part = part_of_graph(graph.arcs, sites);
    KindNumbering<GraphPart, KindRelations> numbering(
        *by_kind, graph.relations, graph.domains, weights
    );
    numbering.enter(part, true);
    std::size_t strangers = 0;  // labels where no new one could stand
    std::size_t allowed = 0;
    part.for_each_outward_arc([&](Site inside, Site outside, RelationId outward) {
        const std::uint8_t kind = by_kind->kind_at(part.global(inside), graph.domains);
        const std::uint8_t far_kind = by_kind->kind_at(outside, graph.domains);
        for (Label label = 0; label < 270; ++label) {
            std::vector<Word> expected(by_kind->words());
            const RelationId inward = graph.relations.reverse(outward);
            for_each_label(graph.relations.row(inward, label), [&](Label near) {
                const auto labels = by_kind->kinds().labels(kind);
                const auto found = std::lower_bound(labels.begin(), labels.end(), near);
                if (found != labels.end() && *found == near) {
                    const auto number = static_cast<std::size_t>(found - labels.begin());
                    expected[number / kWordBits] |= Word{1} << (number % kWordBits);
                }
            });
            const Word* const told = numbering.allowed(inside, outside, outward, label);
            EXPECT_TRUE(std::equal(expected.begin(), expected.end(), told));
            strangers += by_kind->kinds().number(far_kind, label) == kNoLabel ? 1U : 0U;
            allowed += count_labels(expected);
        }
    });
    EXPECT_GT(strangers, 1000U);
    EXPECT_GT(allowed, 1000U);
}

TEST(KindRelations, MakeTheSameModelsInShorterSets) {
    std::size_t accepted = 0;
    std::size_t backtracks = 0;
    for (const std::size_t labels : {140U, 270U, 600U}) {
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            const KindedGraph graph(labels, seed);
            std::vector<double> given;
            for (std::size_t label = 0; label < labels; ++label) {
                given.push_back(static_cast<double>(label % 5));
            }
            const SiteWeights weights{LabelWeights(given)};
            const GraphTopology topology(KindedGraph::kSites, graph.arcs);
            const GraphPart all = whole_graph(topology);
            const auto by_kind = KindRelations::make(graph.relations, graph.domains, weights, all);
            ASSERT_NE(by_kind, nullptr);
            EXPECT_EQ(by_kind->words(), 2U);
            EXPECT_EQ(by_kind->kinds().count(), 3U);  // the smallest set is part of another
            BlockSearch<GraphPart> whole(graph.relations, graph.domains, weights);
            BlockSearch<GraphPart> kinded(
                graph.relations, graph.domains, weights, nullptr, by_kind.get()
            );
            const std::vector<LabelSet> growing = {range_of(labels, 12, 40)};
            const LabelSet pinned = range_of(labels, labels / 2 + 4, labels / 2 + 12);
            std::vector<Label> one(KindedGraph::kSites, kNoLabel);
            std::vector<Label> other = one;
            for (std::uint32_t index = 0; index < 12; ++index) {
                // Some sites while the others stand; one of them may have a label that no site of
                // its kind takes.
                std::vector<Site> sites;
                for (Site site = 0; site < KindedGraph::kSites; ++site) {
                    if (index == 0 || (site + index) % 4 != 0) {
                        sites.push_back(site);
                    }
                }
                const GraphPart part = part_of_graph(graph.arcs, sites);
                const std::vector<Site> scan = in_order(sites.size());
                const Order order = index % 2 == 0 ? Order::kRandom : Order::kMinEntropy;
                BlockOptions options = {6, order, scan};
                if (index % 3 == 1) {
                    options.growing = growing;
                }
                if (index % 4 == 2) {
                    options.pin = Pin{3, &pinned};
                }
                if (index == 7) {  // outside of the part
                    one[1] = other[1] = static_cast<Label>(labels - 1);
                }
                const RandomKey key = {seed, index, 0, 0};
                const BlockResult a = whole.modify(part, one, options, key, {});
                const BlockResult b = kinded.modify(part, other, options, key, {});
                ASSERT_EQ(outcome_of(a), outcome_of(b)) << labels << ' ' << seed << ' ' << index;
                ASSERT_EQ(one, other) << labels << ' ' << seed << ' ' << index;
                accepted += a.outcome == BlockOutcome::kAccepted ? 1U : 0U;
                backtracks += a.backtracks;
            }
        }
    }
    EXPECT_GT(accepted, 50U);
    EXPECT_GT(backtracks, 50U);
}

}  // namespace
}  // namespace modelsynth
