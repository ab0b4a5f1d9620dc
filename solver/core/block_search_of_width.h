#pragma once

#include "solver/core/attempt_plan.h"
#include "solver/core/block_search.h"
#include "solver/core/catalog.h"
#include "solver/core/constraints/constraint_board.h"
#include "solver/core/growing_sets.h"
#include "solver/core/label_chooser.h"
#include "solver/core/part_numbering.h"
#include "solver/core/sat/sat_search.h"
#include "solver/core/search.h"
#include "solver/core/site_order.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

// How BlockSearch does it: for the two files that compile it, and nobody else.
namespace modelsynth {

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

template <TopologyPart Part>
BlockSearch<Part>::BlockSearch(
    const Relations& relations,
    const SiteDomains& domains,
    const SiteWeights& weights,
    Bases* bases,
    const ByKind* by_kind
)
    : whole_(make(WholeNumbering<Part>(relations, domains, weights), bases)) {
    if (by_kind != nullptr) {
        by_kind_ = make(KindNumbering<Part, ByKind>(*by_kind, relations, domains, weights), bases);
    }
}

template <TopologyPart Part>
template <class Numbering>
auto BlockSearch<Part>::make(Numbering numbering, Bases* bases) -> std::unique_ptr<AnyWidth> {
    const auto of_width = [&]<std::size_t kWords>() -> std::unique_ptr<AnyWidth> {
        return std::make_unique<OfWidth<kWords, Numbering>>(std::move(numbering), bases);
    };
    switch (numbering.relations().words()) {
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

template <TopologyPart Part>
BlockResult BlockSearch<Part>::modify(
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

template <TopologyPart Part>
bool BlockSearch<Part>::is_determined(
    const Part& part, std::span<const Label> model, const std::stop_token& stop
) {
    return whole_->is_determined(part, model, stop);
}

}  // namespace modelsynth
