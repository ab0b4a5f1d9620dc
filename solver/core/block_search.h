#pragma once

#include "solver/core/block_bases.h"
#include "solver/core/graph_topology.h"
#include "solver/core/grid_topology.h"
#include "solver/core/label_set.h"
#include "solver/core/order.h"
#include "solver/core/random.h"
#include "solver/core/relations.h"
#include "solver/core/sat/sat_limits.h"
#include "solver/core/search_tally.h"
#include "solver/core/site_domains.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <type_traits>

namespace modelsynth {

class ConstraintBoard;
class KindRelations;
class LabelChooser;
class LayeredRelations;

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

// By which a topology's labels can be numbered beside Relations.
template <class Inner>
using KindedRelationsOf =
    std::conditional_t<SteppedTopology<Inner>, LayeredRelations, KindRelations>;

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
    );

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
    );

    // Whether the surroundings leave no choice anywhere in the part (or nothing at all): to make it
    // anew could not change it. Shape and requirements as of modify().
    [[nodiscard]] bool is_determined(
        const Part& part, std::span<const Label> model, const std::stop_token& stop
    );

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
    static std::unique_ptr<AnyWidth> make(Numbering numbering, Bases* bases);

    std::unique_ptr<AnyWidth> whole_;
    std::unique_ptr<AnyWidth> by_kind_;
};

// Each is compiled for ten widths and numberings; that takes long, so it is done once.
extern template class BlockSearch<GridPart>;
extern template class BlockSearch<GraphPart>;

}  // namespace modelsynth
