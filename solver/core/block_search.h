#pragma once

#include "solver/core/block_bases.h"
#include "solver/core/catalog.h"
#include "solver/core/constraints/constraint_board.h"
#include "solver/core/graph_topology.h"
#include "solver/core/grid_topology.h"
#include "solver/core/growing_sets.h"
#include "solver/core/label_chooser.h"
#include "solver/core/part_numbering.h"
#include "solver/core/random.h"
#include "solver/core/sat/sat_search.h"
#include "solver/core/search.h"
#include "solver/core/search_tally.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_order.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

namespace modelsynth {

enum class BlockOutcome : std::uint8_t {
    kAccepted,    // the block has new labels
    kReverted,    // every attempt failed; the block keeps its old labels
    kImpossible,  // proved: no labels fit (cannot happen when the old labels did)
    kStopped,     // the stop token was requested; the block keeps its old labels
};

struct BlockResult {
    BlockOutcome outcome = BlockOutcome::kReverted;
    std::uint32_t attempts = 0;
    SolvedBy solved_by = SolvedBy::kFirstTry;  // of an accepted block
    std::uint32_t backtracks = 0;              // of all attempts
    Site impossible_site = 0;                  // of the whole; where kImpossible was seen, ...
    // ... or which constraint of the board it came of.
    std::optional<std::size_t> impossible_constraint = std::nullopt;
};

// A site of a part that has to take one of some labels.
struct Pin {
    Site inside = 0;
    const LabelSet* labels = nullptr;
};

// Has the last word on labels that relations and constraints allow.
class PartJudge {
  public:
    PartJudge() = default;
    PartJudge(const PartJudge&) = delete;
    PartJudge& operator=(const PartJudge&) = delete;
    virtual ~PartJudge() = default;

    // `model` has the new labels. False: they are taken back, and the next attempt is made.
    [[nodiscard]] virtual bool accepts(std::span<const Label> model) = 0;
};

struct BlockOptions {
    std::uint32_t attempts = 8;
    Order order = Order::kScan;  // of the odd attempts; see attempt_plan()
    std::span<const Site> scan;  // every site of the part once, the order of kScan
    // Constraints beside the relations. They hold for the model as it is where it is complete, and
    // their board stands with it; the same is so afterwards. Null: none.
    ConstraintBoard* board = nullptr;
    std::optional<Pin> pin = std::nullopt;
    const LabelChooser* chooser = nullptr;  // in place of the weights alone; null: none
    PartJudge* judge = nullptr;             // of every attempt that comes to its end; null: none
    // What these sets are of grows from where it was begun and does not begin by itself: sites all
    // of whose labels are of one of them come before all others, whatever the order, and elsewhere
    // other labels are drawn as long as there are any, unless there is a chooser.
    std::span<const LabelSet> growing = {};
    std::span<std::uint32_t> dead_ends = {};  // by site of the part, as of SearchAids
    // After all attempts, which may be none, CaDiCaL is asked, when there is neither board nor
    // judge; none: it is not.
    std::optional<SatLimits> by_sat = std::nullopt;
    // The model before the first block, by site of the whole: where it still stands around many
    // parts, what follows from it is kept for them. It changes no result. Empty: nothing is known.
    std::span<const Label> usual = {};
};

// How an attempt at a block goes about it.
struct AttemptPlan {
    bool is_other_order = false;
    SearchBudget budget;
};

// Attempts are numbered from 1. Odd ones keep the order asked for and may take back 8 choices, then
// 128, 512, 1000; even ones try another order, first without any. What one order never solves
// another often solves at once (blocks of the thesis's castle, 24 of 980 given up before), so the
// first attempt is not long about it; and what no order solves at once a little backtracking does
// (its Escheresque, 138 of 980).
[[nodiscard]] constexpr AttemptPlan attempt_plan(std::uint32_t attempt) {
    constexpr std::uint32_t kBacktracksMax = 1000;
    const std::uint32_t rung = std::min((attempt - 1) / 2, std::uint32_t{8});
    if (attempt % 2 == 0) {
        return {true, {rung == 0 ? 0 : std::min(kBacktracksMax, 2U << (2 * rung))}};
    }
    return {false, {rung == 0 ? 8 : std::min(kBacktracksMax, 32U << (2 * rung))}};
}

// The order of the even attempts.
[[nodiscard]] constexpr Order other_order(Order order) {
    const bool is_by_openness = order == Order::kMinEntropy || order == Order::kFewestLabels;
    return is_by_openness ? Order::kScan : Order::kMinEntropy;
}

// What RandomKey::purpose says of the streams drawn here.
inline constexpr std::uint32_t kPurposeSearch = 1;

// Runs searches over parts of a model while the rest stands still: the inner half of Algorithm
// 3.4. The knowledge that the surroundings force on a part is computed once; every attempt starts
// from it. Its memory is kept from part to part.
// Not thread-safe; make one per thread. Requires: all arguments outlive it.
template <TopologyPart Part>
class BlockSearch {
  public:
    using Bases = BlockBases<typename Part::Inner>;
    using ByKind = KindedRelationsOf<typename Part::Inner>;

    // `bases` saves work when many parts of one problem are searched; null: nothing is kept.
    // `by_kind`, made of the problem, makes it faster; null: there is none. It changes no result
    // but of boxes of a grid that do not reach through all layers: these know from the beginning
    // what can stand in theirs.
    BlockSearch(
        const Relations& relations,
        const SiteDomains& domains,
        const SiteWeights& weights,
        Bases* bases = nullptr,
        const ByKind* by_kind = nullptr
    )
        : whole_(make(WholeNumbering<Part>(relations, domains, weights), bases)) {
        if (by_kind != nullptr) {
            by_kind_ =
                make(KindNumbering<Part, ByKind>(*by_kind, relations, domains, weights), bases);
        }
    }

    // Makes the part anew, or leaves `model` as it was.
    // Shape:    model has a label for every site of the whole; kNoLabel outside the part means
    //           "open": it puts no constraint on the part.
    // Requires: `key.attempt` and `key.purpose` zero; they are set here.
    [[nodiscard]] BlockResult modify(
        const Part& part,
        std::span<Label> model,
        const BlockOptions& options,
        const RandomKey& key,
        const std::stop_token& stop
    ) {
        // Boards, choosers and CaDiCaL know labels by their numbers in the whole.
        if (by_kind_ == nullptr || options.board != nullptr || options.chooser != nullptr ||
            options.attempts == 0) {
            return whole_->modify(part, model, options, key, stop);
        }
        BlockResult result = by_kind_->modify(part, model, options, key, stop);
        if (result.outcome == BlockOutcome::kReverted && options.by_sat) {
            BlockOptions only_by_sat = options;
            only_by_sat.attempts = 0;
            const BlockResult by_sat = whole_->modify(part, model, only_by_sat, key, stop);
            result.outcome = by_sat.outcome;
            result.solved_by = by_sat.solved_by;
        }
        return result;
    }

    // Whether the surroundings leave no choice anywhere in the part (or nothing at all): to make it
    // anew could not change it. Shape and requirements as of modify().
    [[nodiscard]] bool is_determined(
        const Part& part, std::span<const Label> model, const std::stop_token& stop
    ) {
        return whole_->is_determined(part, model, stop);
    }

    // Sites of the largest part so far; what memory is kept goes with it.
    [[nodiscard]] std::size_t largest_part() const {
        const std::size_t of_whole = whole_->largest_part;
        return by_kind_ == nullptr ? of_whole : std::max(of_whole, by_kind_->largest_part);
    }

  private:
    struct AnyWidth {
        std::size_t largest_part = 0;

        virtual ~AnyWidth() = default;
        virtual BlockResult modify(
            const Part& part,
            std::span<Label> model,
            const BlockOptions& options,
            RandomKey key,
            const std::stop_token& stop
        ) = 0;
        virtual bool is_determined(
            const Part& part, std::span<const Label> model, const std::stop_token& stop
        ) = 0;
    };

    template <std::size_t kWords, class Numbering>
    class OfWidth;

    template <class Numbering>
    static std::unique_ptr<AnyWidth> make(Numbering numbering, Bases* bases) {
        const std::size_t words = numbering.relations().words();
        const auto of_width = [&]<std::size_t kWords>() -> std::unique_ptr<AnyWidth> {
            return std::make_unique<OfWidth<kWords, Numbering>>(std::move(numbering), bases);
        };
        switch (words) {
            case 1:
                return of_width.template operator()<1>();
            case 2:
                return of_width.template operator()<2>();
            case 3:
                return of_width.template operator()<3>();
            case 4:
                return of_width.template operator()<4>();
            default:
                return of_width.template operator()<Numbering::kMoreWords>();
        }
    }

    std::unique_ptr<AnyWidth> whole_;
    std::unique_ptr<AnyWidth> by_kind_;
};

// The search with label sets of kWords words; 0: of any number.
template <TopologyPart Part>
template <std::size_t kWords, class Numbering>
class BlockSearch<Part>::OfWidth final : public AnyWidth {
  public:
    OfWidth(Numbering numbering, Bases* bases) : numbering_(std::move(numbering)), bases_(bases) {}

    BlockResult modify(
        const Part& part,
        std::span<Label> model,
        const BlockOptions& options,
        RandomKey key,
        const std::stop_token& stop
    ) override {
        if (options.board == nullptr) {
            return attempt(part, model, options, key, stop);
        }
        options.board->enter(part);
        const BlockResult result = attempt(part, model, options, key, stop);
        options.board->leave(model);
        return result;
    }

    bool is_determined(const Part& part, std::span<const Label> model, const std::stop_token& stop)
        override {
        prepare(part);
        if (surroundings(part, model, {}, stop) != Propagation::kConsistent) {
            return true;
        }
        for (std::size_t site = 0; site < catalog_->site_count(); ++site) {
            if (has_several(catalog_->labels(static_cast<Site>(site)))) {
                return false;
            }
        }
        return true;
    }

  private:
    using Inner = typename Part::Inner;

    static constexpr std::uint32_t kAllGroups = (std::uint32_t{1} << Part::kOutwardGroups) - 1;

    BlockResult attempt(
        const Part& part,
        std::span<Label> model,
        const BlockOptions& options,
        RandomKey key,
        const std::stop_token& stop
    ) {
        // Rows of a large model are far from each other: together they come sooner than in turn.
        part.for_each_run([&](Site, Site whole, std::size_t) {
            __builtin_prefetch(&model[whole], 1);
        });
        prepare(part);
        BlockResult result;
        Propagation propagation = surroundings(part, model, options.usual, stop);
        if (options.pin && propagation == Propagation::kConsistent) {
            propagation = put(*options.pin, stop);
        }
        if (options.board != nullptr && propagation == Propagation::kConsistent) {
            propagation = options.board->begin(*catalog_, stop);
            if (propagation == Propagation::kContradiction) {
                result.impossible_constraint = options.board->blamed();
            }
        }
        switch (propagation) {
            case Propagation::kConsistent:
                break;
            case Propagation::kStopped:
                result.outcome = BlockOutcome::kStopped;
                return result;
            case Propagation::kContradiction:
                result.outcome = BlockOutcome::kImpossible;
                result.impossible_site = part.global(impossible_);
                return result;
        }
        start_.assign(catalog_->all_labels().begin(), catalog_->all_labels().end());
        weights_.emplace(numbering_.weights(part));
        std::optional<PartChooser> chooser;
        if (options.chooser != nullptr) {
            chooser.emplace(*options.chooser).enter(part, model);
        }
        for (result.attempts = 1; result.attempts <= options.attempts; ++result.attempts) {
            if (result.attempts > 1) {
                catalog_->restore(start_);
                if (options.board != nullptr) {
                    options.board->resume(*catalog_);
                }
            }
            const AttemptPlan plan = attempt_plan(result.attempts);
            key.attempt = result.attempts;
            key.purpose = kPurposeSearch;
            const std::uint32_t backtracks_before = result.backtracks;
            const SearchOutcome outcome =
                run(options, plan, chooser ? &*chooser : nullptr, key, stop, result.backtracks);
            if (outcome == SearchOutcome::kStopped) {
                result.outcome = BlockOutcome::kStopped;
                return result;
            }
            if (outcome == SearchOutcome::kSolved &&
                write_if_accepted(part, model, options.judge)) {
                result.outcome = BlockOutcome::kAccepted;
                result.solved_by = plan.is_other_order                     ? SolvedBy::kOtherOrder
                                   : result.backtracks > backtracks_before ? SolvedBy::kBacktracking
                                   : result.attempts > 1                   ? SolvedBy::kRestart
                                                                           : SolvedBy::kFirstTry;
                return result;
            }
        }
        result.attempts = options.attempts;
        result.outcome = BlockOutcome::kReverted;
        if constexpr (std::is_same_v<Numbering, WholeNumbering<Part>>) {
            if (options.by_sat && options.board == nullptr && options.judge == nullptr) {
                ask_sat(part, model, *options.by_sat, key, stop, result);
            }
        }
        return result;
    }

    void ask_sat(
        const Part& part,
        std::span<Label> model,
        const SatLimits& limits,
        RandomKey key,
        const std::stop_token& stop,
        BlockResult& result
    ) {
        key.attempt = 0;
        std::vector<Label> labels(topology_->site_count());
        const SatResult found = solve_by_sat(
            *topology_,
            numbering_.relations(),
            start_,
            *weights_,
            key,
            limits,
            stop,
            std::span<Label>(labels)
        );
        if (found.outcome == SatOutcome::kStopped) {
            result.outcome = BlockOutcome::kStopped;
        } else if (found.outcome == SatOutcome::kSolved) {
            for_each_site(part, [&](Site inside, Site whole) { model[whole] = labels[inside]; });
            result.outcome = BlockOutcome::kAccepted;
            result.solved_by = SolvedBy::kSat;
        }
    }

    // The catalog for such a part; parts of one shape come one after the other.
    void prepare(const Part& part) {
        const bool is_new_shape = topology_ == nullptr || !(*topology_ == part.inner());
        numbering_.enter(part, is_new_shape);
        if (is_new_shape) {
            catalog_.reset();
            topology_ = std::make_unique<const Inner>(part.inner());
            catalog_.emplace(*topology_, numbering_.relations());
            this->largest_part = std::max(this->largest_part, topology_->site_count());
        }
    }

    // Everything the sites may be by themselves, less what the labels outside forbid.
    Propagation surroundings(
        const Part& part,
        std::span<const Label> model,
        std::span<const Label> usual,
        const std::stop_token& stop
    ) {
        key_.domains.resize(catalog_->site_count());
        part.for_each_run([&](Site inside, Site whole, std::size_t count) {
            numbering_.domains().copy_numbers(
                whole, std::span(key_.domains).subspan(inside, count)
            );
        });
        numbering_.append_key(key_.domains);
        if (usual_groups(part, model, usual) != 0) {
            if (const auto kept = bases_->find(*topology_, key_)) {
                catalog_->restore(kept->sets);
                return narrow(part, model, kAllGroups & ~key_.groups, stop);
            }
            if (bases_->is_asked_again(key_)) {
                make_wide_base(part, model, stop);
            }
        }
        const Propagation propagation = base(part, stop);
        return propagation == Propagation::kConsistent ? narrow(part, model, kAllGroups, stop)
                                                       : propagation;
    }

    // Leaves what the labels outside allow along arcs of the groups.
    Propagation narrow(
        const Part& part,
        std::span<const Label> model,
        std::uint32_t groups,
        const std::stop_token& stop
    ) {
        bool consistent = true;
        const auto look = [&](Site inside, Site outside, RelationId relation) {
            const Label label = model[outside];
            if (consistent && label != kNoLabel) {
                consistent =
                    catalog_->narrow(inside, numbering_.allowed(inside, outside, relation, label));
            }
        };
        for (std::size_t group = 0; group < Part::kOutwardGroups; ++group) {
            if ((groups >> group & 1) != 0) {
                part.for_each_outward_arc(group, look);
            }
        }
        const Propagation propagation =
            consistent ? catalog_->propagate(stop) : Propagation::kContradiction;
        impossible_ = catalog_->emptied_site();
        return propagation;
    }

    // The groups of outward arcs at all of whose far ends stands what usually does.
    std::uint32_t usual_groups(
        const Part& part, std::span<const Label> model, std::span<const Label> usual
    ) {
        key_.groups = 0;
        key_.outside.clear();
        const std::size_t groups = bases_ == nullptr || usual.empty() ? 0 : Part::kOutwardGroups;
        for (std::size_t group = 0; group < groups; ++group) {
            const std::size_t before = key_.outside.size();
            bool is_usual = true;
            part.for_each_outward_arc(group, [&](Site, Site outside, RelationId) {
                const Label label = model[outside];
                is_usual = is_usual && label == usual[outside];
                key_.outside.push_back(label);
            });
            if (is_usual && key_.outside.size() > before) {
                key_.groups |= std::uint32_t{1} << group;
            } else {
                key_.outside.resize(before);
            }
        }
        return key_.groups;
    }

    // For parts to come, with what key_ says of the outside.
    void make_wide_base(
        const Part& part, std::span<const Label> model, const std::stop_token& stop
    ) {
        if (base(part, stop) == Propagation::kConsistent &&
            narrow(part, model, key_.groups, stop) == Propagation::kConsistent) {
            keep_base(key_);
        }
    }

    Propagation put(const Pin& pin, const std::stop_token& stop) {
        std::vector<Word> labels(catalog_->words());
        numbering_.put_numbered(pin.inside, pin.labels->words(), labels.data());
        const bool fits = catalog_->narrow(pin.inside, labels.data());
        impossible_ = pin.inside;
        return fits ? catalog_->propagate(stop) : Propagation::kContradiction;
    }

    // What the sites may be by themselves.
    Propagation base(const Part& part, const std::stop_token& stop) {
        const typename Bases::Key key = {0, {}, key_.domains};
        if (bases_ != nullptr) {
            if (const auto kept = bases_->find(*topology_, key)) {
                catalog_->restore(kept->sets);
                return Propagation::kConsistent;
            }
        }
        std::vector<Word> sets(catalog_->all_labels().size());
        bool any_empty = false;
        for_each_site(part, [&](Site inside, Site whole) {
            const std::span<Word> own =
                std::span(sets).subspan(inside * catalog_->words(), catalog_->words());
            numbering_.put_numbered(inside, numbering_.domains().words(whole), own.data());
            if (!any_empty && is_empty(own)) {
                any_empty = true;
                impossible_ = inside;
            }
        });
        if (any_empty) {
            return Propagation::kContradiction;
        }
        catalog_->restore(sets);
        catalog_->enqueue_all();
        const Propagation propagation = catalog_->propagate(stop);
        impossible_ = catalog_->emptied_site();
        if (bases_ != nullptr && propagation == Propagation::kConsistent) {
            keep_base(key);
        }
        return propagation;
    }

    // The catalog as it is.
    void keep_base(const typename Bases::Key& key) {
        const std::span<const Word> all = catalog_->all_labels();
        bases_->keep({*topology_, key, {all.begin(), all.end()}});
    }

    SearchOutcome run(
        const BlockOptions& options,
        const AttemptPlan& plan,
        PartChooser* chooser,
        const RandomKey& key,
        const std::stop_token& stop,
        std::uint32_t& backtracks
    ) {
        RandomStream random(key);
        const Order order = plan.is_other_order ? other_order(options.order) : options.order;
        const GrowingSets growing = numbering_.growing(options.growing);
        const SearchAids aids = {
            options.board,
            chooser,
            options.growing.empty() ? nullptr : &growing,
            options.dead_ends};
        const auto search_with = [&](auto picker) {
            Search search(*catalog_, picker, *weights_, aids, random, stop);
            const SearchOutcome outcome = search.run(plan.budget);
            backtracks += search.backtracks();
            return outcome;
        };
        if (!options.growing.empty()) {
            const std::vector<Site> shuffled = shuffled_sites(topology_->site_count(), random);
            return search_with(GrowthPicker(*catalog_, growing, shuffled, random));
        }
        return with_picker(
            order, *catalog_, *topology_, options.scan, *weights_, random, search_with
        );
    }

    bool write_if_accepted(const Part& part, std::span<Label> model, PartJudge* judge) {
        if (judge == nullptr) {
            write(part, model);
            return true;
        }
        before_.resize(catalog_->site_count());
        for_each_site(part, [&](Site inside, Site whole) { before_[inside] = model[whole]; });
        write(part, model);
        if (judge->accepts(model)) {
            return true;
        }
        for_each_site(part, [&](Site inside, Site whole) { model[whole] = before_[inside]; });
        return false;
    }

    // The only label of each site.
    void write(const Part& part, std::span<Label> model) const {
        for_each_site(part, [&](Site inside, Site whole) {
            model[whole] = numbering_.label(inside, first_label(catalog_->labels(inside)));
        });
    }

    Numbering numbering_;
    Bases* bases_;
    std::unique_ptr<const Inner> topology_;
    // Of topology_.
    std::optional<Catalog<Inner, kWords, typename Numbering::RelationsOfSites>> catalog_;
    typename Bases::Key key_;             // of the part's base
    std::optional<PartWeights> weights_;  // of the part
    std::vector<Word> start_;             // what the surroundings leave
    std::vector<Label> before_;           // the part's labels, while they are judged
    Site impossible_ = 0;                 // where they leave nothing
};

// Each is compiled for ten widths and numberings; that takes long, so it is done once.
extern template class BlockSearch<GridPart>;
extern template class BlockSearch<GraphPart>;

}  // namespace modelsynth
