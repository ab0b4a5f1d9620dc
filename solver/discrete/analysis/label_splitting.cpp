#include "solver/discrete/analysis/label_splitting.h"

#include "solver/discrete/analysis/split_by_cells.h"
#include "solver/discrete/analysis/split_by_rules.h"
#include "solver/discrete/analysis/split_labels.h"
#include "solver/discrete/analysis/work.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace modelsynth::discrete {

namespace {

constexpr std::array<SplitOrder, 2> kOrders = {
    SplitOrder::kLowerAxisFirst, SplitOrder::kHigherAxisFirst};

class SplittingSearch {
  public:
    SplittingSearch(
        const Example& example,
        const Transitions& transitions,
        const SplittingOptions& options,
        Work& work
    )
        : example_(example),
          transitions_(transitions),
          options_(options),
          work_(work),
          capacity_(std::min(
              kLabelCountMax, example.pieces.size() * options.labels_per_label + options.labels_more
          )) {}

    std::optional<Splitting> run() {
        if (transitions_.open_count() < 2) {
            return std::nullopt;
        }
        for (const SplitOrder order : kOrders) {
            work_.with_share(options_.steps_max / 4, [&](Work& share) {
                return try_rules(order, share);
            });
        }
        if (!best_ && !example_.cells.empty()) {
            for (const SplitOrder order : kOrders) {
                work_.with_share(work_.left() / 2, [&](Work& share) {
                    return try_cells(order, share);
                });
            }
        }
        return std::move(best_);
    }

  private:
    bool try_rules(SplitOrder order, Work& work) {
        SplitLabels labels(transitions_, capacity_);
        return split_by_rules(labels, order, work) == ProofOutcome::kProved &&
               keep(std::move(labels), SplitMethod::kRules, work);
    }

    bool try_cells(SplitOrder order, Work& work) {
        auto labels = split_by_cells(example_, transitions_, capacity_, order, work);
        return labels && keep(std::move(*labels), SplitMethod::kCells, work);
    }

    // Merges back, and keeps what comes of it if it is the best so far.
    bool keep(SplitLabels labels, SplitMethod method, Work& work) {
        const auto merged =
            merge_labels(std::move(labels), example_.pieces.size(), options_.region_steps, work);
        if (!merged || merged->labels.present().empty()) {
            return false;
        }
        Splitting splitting = {
            merged->labels.transitions(), merged->labels.originals(), merged->proof, method, {}};
        splitting.lost = transitions_.labels;
        for (const Label original : splitting.originals) {
            splitting.lost.erase(original);
        }
        const auto key = [](const Splitting& each) {
            return std::tuple(each.lost.count(), each.originals.size());
        };
        if (!best_ || key(splitting) < key(*best_)) {
            best_ = std::move(splitting);
        }
        return true;
    }

    const Example& example_;
    const Transitions& transitions_;
    const SplittingOptions& options_;
    Work& work_;
    std::size_t capacity_;
    std::optional<Splitting> best_;
};

}  // namespace

Result<std::optional<Splitting>> find_splitting(
    const Example& example,
    const Transitions& transitions,
    const SplittingOptions& options,
    const std::stop_token& stop
) {
    Work work(options.steps_max, stop);
    auto found = SplittingSearch(example, transitions, options, work).run();
    if (stop.stop_requested()) {
        return tl::unexpected(Error{ErrorCode::kCancelled, "the analysis was stopped", {}});
    }
    return found;
}

}  // namespace modelsynth::discrete
