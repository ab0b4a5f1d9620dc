// The peer that the bench measures our solver against must be right, or its times say nothing.

#include "solver/core/block_schedule.h"
#include "solver/core/catalog.h"
#include "solver/discrete/block_solver.h"
#include "solver/discrete/synthesis.h"
#include "tests/bench/ac4_peer.h"
#include "tests/support/consistency_checker.h"
#include "tests/support/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace modelsynth::bench {
namespace {

using testing::find_inconsistency;
using testing::make_random_example;
using testing::RecordingObserver;

// Relations of any number of labels, some of which nothing supports.
Relations make_random_relations(std::size_t label_count, RandomStream& random) {
    Relations relations(label_count, {1, 0, 3, 2, 5, 4});
    const auto draw = [&] {
        return static_cast<Label>(random.below(static_cast<std::uint32_t>(label_count)));
    };
    for (RelationId direction = 0; direction < kDirectionCount; direction += 2) {
        for (std::size_t pairs = 0; pairs < 4 * label_count; ++pairs) {
            relations.allow(direction, draw(), draw());
        }
    }
    return relations;
}

// A set for each site: most have every label, some lack a few.
std::vector<Word> make_random_domains(
    std::size_t site_count, std::size_t label_count, RandomStream& random
) {
    std::vector<Word> domains;
    for (std::size_t site = 0; site < site_count; ++site) {
        LabelSet set = LabelSet::all(label_count);
        for (std::size_t i = random.below(4) == 0 ? label_count / 3 : 0; i > 0; --i) {
            set.erase(static_cast<Label>(random.below(static_cast<std::uint32_t>(label_count))));
        }
        domains.insert(domains.end(), set.words().begin(), set.words().end());
    }
    return domains;
}

bool are_equal(std::span<const Word> a, std::span<const Word> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

// Both catalogs through the same narrowings and choices, to the end or to a contradiction. How many
// propagations there were.
std::size_t compare_catalogs(
    const GridTopology& grid, const Relations& relations, RandomStream& random
) {
    const std::size_t label_count = relations.label_count();
    const std::vector<Word> domains = make_random_domains(grid.site_count(), label_count, random);
    const Ac4Rules rules(relations);
    Ac4Catalog peer(grid, rules);
    Catalog<GridTopology, 0> ours(grid, relations);
    ours.restore(domains);
    ours.enqueue_all();
    bool consistent = ours.propagate({}) == Propagation::kConsistent;
    EXPECT_EQ(peer.start(domains), consistent);
    std::size_t propagations = 1;
    const Ac4State start = peer.state();
    while (consistent) {
        EXPECT_TRUE(are_equal(peer.state().possible, ours.all_labels()));
        std::vector<Site> open;
        for (Site site = 0; site < grid.site_count(); ++site) {
            if (has_several(ours.labels(site))) {
                open.push_back(site);
            }
        }
        if (open.empty() || ::testing::Test::HasFailure()) {
            break;
        }
        const Site site = open[random.below(static_cast<std::uint32_t>(open.size()))];
        const LabelWeights weights(std::vector<double>(label_count, 1.0));
        const Label label = weights.draw(ours.labels(site), random);
        if (random.below(3) == 0) {
            LabelSet others = LabelSet::all(label_count);
            others.erase(label);
            EXPECT_TRUE(peer.narrow(site, others.words()));
            EXPECT_TRUE(ours.narrow(site, others.words().data()));
        } else {
            peer.assign(site, label);
            ours.assign(site, label);
        }
        consistent = ours.propagate({}) == Propagation::kConsistent;
        EXPECT_EQ(peer.propagate(), consistent);
        ++propagations;
    }
    if (propagations > 1) {
        peer.restore(start);
        ours.restore(domains);
        ours.enqueue_all();
        EXPECT_EQ(ours.propagate({}), Propagation::kConsistent);
        EXPECT_TRUE(are_equal(peer.state().possible, ours.all_labels()));
        EXPECT_TRUE(peer.propagate()) << "nothing is left to do after restore()";
        EXPECT_TRUE(are_equal(peer.state().possible, ours.all_labels()));
    }
    return propagations;
}

TEST(Ac4Peer, PropagatesToTheFixpointOfOurCatalog) {
    std::size_t propagations = 0;
    for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomStream random({seed, 0, 0, 77});
        const auto below = [&](std::uint32_t bound) {
            return static_cast<std::int32_t>(random.below(bound));
        };
        const GridTopology grid(
            {1 + below(5), 1 + below(4), 1 + below(5)},
            {below(2) == 0, below(2) == 0, below(2) == 0}
        );
        if (seed % 2 == 0) {
            const Relations relations = find_transitions(make_random_example(seed));
            propagations += compare_catalogs(grid, relations, random);
        } else {
            const auto labels = static_cast<std::size_t>(5 + below(150));
            propagations += compare_catalogs(grid, make_random_relations(labels, random), random);
        }
    }
    EXPECT_GT(propagations, 1000U);  // or the cases test nothing
}

struct Case {
    std::shared_ptr<const discrete::Example> example;
    discrete::Parameters parameters;
    std::array<bool, 3> periodic = {false, false, false};
};

Case make_case(std::uint64_t seed, bool in_blocks) {
    RandomStream random({seed, 1, 0, 77});
    const auto below = [&](std::uint32_t bound) {
        return static_cast<std::int32_t>(random.below(bound));
    };
    Case made;
    made.example = std::make_shared<const discrete::Example>(make_random_example(seed));
    made.parameters.size = GridSize{1 + below(12), 1 + below(5), 1 + below(12)};
    made.parameters.order = random.below(3) == 0 ? Order::kMinEntropy : Order::kScan;
    made.parameters.blocks = std::optional<discrete::Blocks>();
    if (in_blocks) {
        discrete::Blocks blocks;
        blocks.layout.size = {2 + below(7), 1 + below(5), 2 + below(7)};
        made.parameters.blocks = blocks;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t kind = random.below(4);
        discrete::SideBoundary boundary;
        if (kind == 0) {
            boundary.kind = discrete::BoundaryKind::kPeriodic;
            made.periodic[axis] = true;
        } else if (kind == 1) {
            boundary.kind = discrete::BoundaryKind::kExample;
        }
        made.parameters.boundary[2 * axis] = boundary;
        made.parameters.boundary[2 * axis + 1] = boundary;
    }
    made.parameters = fill_defaults(made.parameters, *made.example);
    return made;
}

struct Tally {
    int solved = 0;
    int refused = 0;
    int equal = 0;  // to ours, because neither met a contradiction
};

// One request by the peer; where no attempt failed it must be the model that ours makes.
void check_models(std::uint64_t seed, bool in_blocks, Tally& tally) {
    const Case wanted = make_case(seed, in_blocks);
    const auto made = discrete::Preparation::make(wanted.example, wanted.parameters);
    if (!made) {
        ++tally.refused;
        return;
    }
    const discrete::Problem& problem = (*made)->problem();
    Ac4Peer peer(problem, {wanted.parameters.order});
    std::vector<Box> schedule;
    if (in_blocks) {
        const auto& layout = (*wanted.parameters.blocks)->layout;
        schedule = schedule_blocks(problem.size, layout, discrete::kBlockCountMax).value();
    }
    RecordingObserver observer;
    const auto ours = synthesise(**made, seed, observer, {});
    const auto make = [&]() -> std::optional<PeerModel> {
        if (!in_blocks) {
            return peer.at_once(seed);
        }
        return ours ? std::optional(peer.in_blocks(schedule, observer.initial_model, seed))
                    : std::nullopt;
    };
    const auto model = make();
    if (!model) {
        ++tally.refused;
        return;
    }
    ++tally.solved;
    ASSERT_TRUE(ours);
    ASSERT_EQ(
        find_inconsistency(*wanted.example, problem.size, model->labels, wanted.periodic),
        std::nullopt
    );
    for (std::size_t site = 0; site < model->labels.size(); ++site) {
        ASSERT_TRUE(problem.domains.at(static_cast<Site>(site)).contains(model->labels[site]));
    }
    ASSERT_EQ(model->accepted + model->reverted, in_blocks ? schedule.size() : 1);
    if (model->reverted == 0 && model->attempts == model->accepted) {
        ++tally.equal;
        ASSERT_EQ(model->labels, ours->labels);
    }
    // What it keeps from model to model changes none.
    const auto again = make();
    ASSERT_TRUE(again);
    ASSERT_EQ(again->labels, model->labels);
}

TEST(Ac4Peer, ModelsAreConsistentAndOursWhereNothingFailed) {
    for (const bool in_blocks : {false, true}) {
        Tally tally;
        for (std::uint64_t seed = 0; seed < 300; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed) + (in_blocks ? " in blocks" : " whole"));
            check_models(seed, in_blocks, tally);
            if (HasFatalFailure()) {
                return;
            }
        }
        // The cases must reach all ends, or they test nothing.
        EXPECT_GT(tally.solved, 100);
        EXPECT_GT(tally.equal, 50);
        EXPECT_GT(tally.refused, 10);
    }
}

}  // namespace
}  // namespace modelsynth::bench
