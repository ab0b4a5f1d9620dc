// Arc consistency by counting (AC-4: Mohr and Henderson, "Arc and Path Consistency Revisited",
// 1986), which is how Algorithms 3.2 and 3.3 of Merrell's thesis are mostly implemented: instead of
// searching for a label that still supports another one, count them once and count down whenever
// one goes. A label whose count reaches zero in any direction goes too.
//
// All of it is flat. The counters of one cell and direction lie side by side, and the labels that
// a removed one counts down rise, so that a removal touches a line or two of memory a neighbour.

#include "tests/bench/ac4_peer.h"

#include "solver/core/attempt_plan.h"
#include "solver/core/block_search.h"
#include "solver/core/result.h"
#include "solver/discrete/scan_order.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace modelsynth::bench {

Ac4Rules::Ac4Rules(const Relations& relations) : label_count_(relations.label_count()) {
    check(relations.count() == kDirectionCount, "a peer for relations of no grid");
    for (RelationId direction = 0; direction < kDirectionCount; ++direction) {
        for (std::size_t label = 0; label < label_count_; ++label) {
            firsts_.push_back(static_cast<std::uint32_t>(lists_.size()));
            for_each_label(relations.row(direction, static_cast<Label>(label)), [&](Label other) {
                lists_.push_back(other);
            });
        }
    }
    check(
        lists_.size() <= std::numeric_limits<std::uint32_t>::max(), "more pairs than can be counted"
    );
    firsts_.push_back(static_cast<std::uint32_t>(lists_.size()));
}

Ac4Catalog::Ac4Catalog(const GridTopology& topology, const Ac4Rules& rules)
    : topology_(topology), rules_(rules), words_(words_for(rules.label_count())) {
    const std::size_t sites = topology.site_count();
    state_.supports.resize(sites * kDirectionCount * rules.label_count());
    state_.possible.resize(sites * words_);
    state_.left_count.resize(sites);
}

bool Ac4Catalog::start(std::span<const Word> domains) {
    const std::size_t label_count = rules_.label_count();
    std::vector<std::uint16_t> supports(kDirectionCount * label_count);
    for (std::size_t i = 0; i < supports.size(); ++i) {
        const auto direction = static_cast<RelationId>(i / label_count);
        const auto label = static_cast<Label>(i % label_count);
        supports[i] = static_cast<std::uint16_t>(rules_.allowed(direction, label).size());
    }
    const LabelSet all = LabelSet::all(label_count);
    const std::size_t sites = topology_.site_count();
    for (std::size_t site = 0; site < sites; ++site) {
        std::copy_n(
            supports.begin(), supports.size(), state_.supports.data() + site * supports.size()
        );
        std::copy_n(all.words().begin(), words_, state_.possible.data() + site * words_);
    }
    std::fill(
        state_.left_count.begin(), state_.left_count.end(), static_cast<std::uint16_t>(label_count)
    );
    removals_.clear();
    for (std::size_t site = 0; site < sites; ++site) {
        if (!narrow(static_cast<Site>(site), domains.subspan(site * words_, words_))) {
            return false;
        }
    }
    return remove_unsupported() && propagate();
}

// What no label at all supports is never counted down to zero.
bool Ac4Catalog::remove_unsupported() {
    for (Site site = 0; site < topology_.site_count(); ++site) {
        bool consistent = true;
        topology_.for_each_arc(site, [&](Site, RelationId direction) {
            for_each_label(labels(site), [&](Label label) {
                if (rules_.allowed(direction, label).empty()) {
                    consistent = remove(site, label) && consistent;
                }
            });
        });
        if (!consistent) {
            return false;
        }
    }
    return true;
}

bool Ac4Catalog::narrow(Site site, std::span<const Word> allowed) {
    bool consistent = true;
    for_each_label(labels(site), [&](Label label) {
        if ((allowed[label / kWordBits] >> (label % kWordBits) & 1) == 0) {
            consistent = remove(site, label);
        }
    });
    return consistent;
}

void Ac4Catalog::assign(Site site, Label label) {
    for_each_label(labels(site), [&](Label other) {
        if (other != label) {
            remove(site, other);
        }
    });
}

bool Ac4Catalog::propagate() {
    while (!removals_.empty()) {
        const Removal removal = removals_.back();
        removals_.pop_back();
        bool consistent = true;
        topology_.for_each_arc(removal.site, [&](Site neighbour, RelationId direction) {
            // Seen from the neighbour, the label went in the opposite direction.
            consistent = consistent && count_down(
                                           neighbour,
                                           static_cast<RelationId>(direction ^ 1U),
                                           rules_.allowed(direction, removal.label)
                                       );
        });
        if (!consistent) {
            return false;
        }
    }
    return true;
}

void Ac4Catalog::restore(const Ac4State& state) {
    state_ = state;  // of equal sizes: copied in place
    removals_.clear();
    tracking_ = false;
}

bool Ac4Catalog::remove(Site site, Label label) {
    state_.possible.data()[site * words_ + label / kWordBits] &= ~(Word{1} << (label % kWordBits));
    removals_.push_back({site, label});
    if (tracking_) {
        changed_.push_back(site);
    }
    return --state_.left_count.data()[site] != 0;
}

bool Ac4Catalog::count_down(Site site, RelationId direction, std::span<const Label> labels) {
    std::uint16_t* const supports =
        state_.supports.data() + (site * kDirectionCount + direction) * rules_.label_count();
    const Word* const possible = state_.possible.data() + site * words_;
    for (const Label label : labels) {
        if (--supports[label] == 0 &&
            (possible[label / kWordBits] >> (label % kWordBits) & 1) != 0 && !remove(site, label)) {
            return false;
        }
    }
    return true;
}

// What is kept for blocks of one size.
struct Ac4Peer::Workspace {
    struct Base {
        std::vector<std::uint16_t> domains;  // their numbers, by site
        Ac4State state;
    };

    Workspace(const GridTopology& inner, const Ac4Rules& rules)
        : topology(inner), scan(discrete::column_order(inner.size())), catalog(topology, rules) {}

    GridTopology topology;
    std::vector<Site> scan;
    Ac4Catalog catalog;
    // The fixpoints before anything outside is known. A few: for whole models they are large, and
    // blocks differ only by the sides that they touch.
    std::vector<std::unique_ptr<const Base>> bases;
    Ac4State bordered;  // what the surroundings leave of the base
    std::vector<std::uint16_t> domains;
};

Ac4Peer::Ac4Peer(const discrete::Problem& problem, const Ac4Options& options)
    : problem_(problem), options_(options), rules_(problem.relations) {
    check(options.order != Order::kRandom, "the peer knows no random order");
}

Ac4Peer::~Ac4Peer() = default;

std::optional<PeerModel> Ac4Peer::at_once(std::uint64_t seed) {
    PeerModel model;
    model.labels.assign(problem_.size.cell_count(), kNoLabel);
    const auto attempts = modify(Box::whole(problem_.size), model.labels, {seed, 0, 0, 0});
    if (!attempts) {
        return std::nullopt;
    }
    model.accepted = 1;
    model.attempts = *attempts;
    return model;
}

PeerModel Ac4Peer::in_blocks(
    std::span<const Box> schedule, std::vector<Label> initial, std::uint64_t seed
) {
    PeerModel model;
    model.labels = std::move(initial);
    for (std::size_t block = 0; block < schedule.size(); ++block) {
        const auto attempts =
            modify(schedule[block], model.labels, {seed, static_cast<std::uint32_t>(block), 0, 0});
        ++(attempts ? model.accepted : model.reverted);
        model.attempts += attempts.value_or(options_.attempts);
    }
    return model;
}

std::optional<std::uint32_t> Ac4Peer::modify(
    const Box& block, std::span<Label> model, RandomKey key
) {
    const GridPart part(problem_.size, problem_.periodic, block);
    Workspace& workspace = workspace_for(part);
    Ac4Catalog& catalog = workspace.catalog;
    const Ac4State* start = find_or_make_base(part, workspace);
    if (start == nullptr) {
        return std::nullopt;
    }
    catalog.restore(*start);
    if (!(block == Box::whole(problem_.size))) {
        if (!narrow_border(part, model, catalog) || !catalog.propagate()) {
            return std::nullopt;
        }
        workspace.bordered = catalog.state();
        start = &workspace.bordered;
    }
    key.purpose = kPurposeSearch;
    for (key.attempt = 1; key.attempt <= options_.attempts; ++key.attempt) {
        if (key.attempt > 1) {
            catalog.restore(*start);
        }
        if (attempt(workspace, key)) {
            for_each_site(part, [&](Site inside, Site whole) {
                for_each_label(catalog.labels(inside), [&](Label label) { model[whole] = label; });
            });
            return key.attempt;
        }
    }
    return std::nullopt;
}

bool Ac4Peer::attempt(Workspace& workspace, const RandomKey& key) const {
    Ac4Catalog& catalog = workspace.catalog;
    RandomStream random(key);
    const auto run = [&](auto picker) {
        Site site = 0;
        while (picker.next(catalog, site)) {
            catalog.assign(site, problem_.weights.table(0).draw(catalog.labels(site), random));
            if (!catalog.propagate()) {
                return false;
            }
        }
        return true;
    };
    return options_.order == Order::kScan
               ? run(ScanPicker(workspace.scan))
               : run(LeastOpenPicker(
                     catalog, PartWeights{problem_.weights, {}}, random, Openness::kEntropy
                 ));
}

bool Ac4Peer::narrow_border(const GridPart& part, std::span<const Label> model, Ac4Catalog& catalog)
    const {
    bool consistent = true;
    part.for_each_outward_arc([&](Site inside, Site outside, RelationId direction) {
        const RelationId inward = problem_.relations.reverse(direction);
        consistent =
            consistent && catalog.narrow(inside, problem_.relations.row(inward, model[outside]));
    });
    return consistent;
}

// The size of a block also says which of its axes are closed.
Ac4Peer::Workspace& Ac4Peer::workspace_for(const GridPart& part) {
    const auto known =
        std::find_if(workspaces_.begin(), workspaces_.end(), [&](const auto& workspace) {
            return workspace->topology == part.inner();
        });
    if (known != workspaces_.end()) {
        return **known;
    }
    workspaces_.push_back(std::make_unique<Workspace>(part.inner(), rules_));
    return *workspaces_.back();
}

// Null when nothing fits.
const Ac4State* Ac4Peer::find_or_make_base(const GridPart& part, Workspace& workspace) const {
    workspace.domains.resize(workspace.topology.site_count());
    for_each_site(part, [&](Site inside, Site whole) {
        workspace.domains[inside] = problem_.domains.number(whole);
    });
    for (const auto& base : workspace.bases) {
        if (base->domains == workspace.domains) {
            return &base->state;
        }
    }
    std::vector<Word> sets;
    for_each_site(part, [&](Site, Site whole) {
        const std::span<const Word> own = problem_.domains.words(whole);
        sets.insert(sets.end(), own.begin(), own.end());
    });
    if (!workspace.catalog.start(sets)) {
        return nullptr;
    }
    workspace.bases.push_back(std::make_unique<const Workspace::Base>(Workspace::Base{
        workspace.domains, workspace.catalog.state()}));
    return &workspace.bases.back()->state;
}

}  // namespace modelsynth::bench
