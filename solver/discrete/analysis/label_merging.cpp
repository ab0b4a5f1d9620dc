// First all labels that stand for one label of the example are merged into one, which is most often
// possible: a split that was made on the way to another is seldom needed itself. Then pairs.

#include "solver/discrete/analysis/label_merging.h"

#include "solver/discrete/analysis/region_induction.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

class Merger {
  public:
    Merger(SplitLabels labels, std::size_t original_count, std::uint64_t region_steps, Work& work)
        : original_count_(original_count),
          region_steps_(region_steps),
          work_(work),
          all_(std::move(labels)),
          best_{all_, SplitProof::kEquation311} {
        best_.labels.remove_ends();
    }

    std::optional<ProvedLabels> run() {
        const auto proof = prove(best_.labels);
        if (!proof) {
            return std::nullopt;
        }
        best_.proof = *proof;
        for (const auto& [original, group] : groups()) {
            static_cast<void>(accept(group));
        }
        while (merge_pair()) {
        }
        return std::move(best_);
    }

  private:
    // The labels that stand for the same one, two or more of them.
    [[nodiscard]] std::map<Label, std::vector<Label>> groups() const {
        std::map<Label, std::vector<Label>> groups;
        for_each_label(all_.present().words(), [&](Label label) {
            groups[all_.original(label)].push_back(label);
        });
        std::erase_if(groups, [](const auto& group) { return group.second.size() < 2; });
        return groups;
    }

    bool merge_pair() {
        bool has_merged = false;
        for (const auto& [original, group] : groups()) {
            std::vector<Label> left = group;
            for (std::size_t i = 0; i < left.size(); ++i) {
                for (std::size_t j = left.size(); j-- > i + 1;) {
                    if (accept({left[i], left[j]})) {
                        left.erase(left.begin() + static_cast<std::ptrdiff_t>(j));
                        has_merged = true;
                    }
                }
            }
        }
        return has_merged && work_.left() > 0;
    }

    // Merges the labels if that leaves a proof.
    bool accept(const std::vector<Label>& group) {
        if (work_.left() == 0) {
            return false;
        }
        SplitLabels merged = all_;
        for (std::size_t i = 1; i < group.size(); ++i) {
            merged.merge(group[i], group[0]);
        }
        SplitLabels going_on = merged;
        going_on.remove_ends();
        LabelSet covered = going_on.covered(original_count_);
        covered &= best_.labels.covered(original_count_);
        if (covered != best_.labels.covered(original_count_)) {
            return false;
        }
        const auto proof = prove(going_on);
        if (!proof) {
            return false;
        }
        all_ = std::move(merged);
        best_ = {std::move(going_on), *proof};
        return true;
    }

    std::optional<SplitProof> prove(const SplitLabels& labels) {
        CubePairs cube;
        ProofOutcome outcome = labels.visit_conflicts(
            SplitOrder::kLowerAxisFirst, work_, [](const SplitConflict&) { return true; }
        );
        if (outcome == ProofOutcome::kProved) {
            outcome = labels.find_open_cube(work_, cube);
        }
        if (outcome == ProofOutcome::kProved) {
            return SplitProof::kEquation311;
        }
        if (outcome == ProofOutcome::kNotProved && region_steps_ > 0) {
            outcome = work_.with_share(region_steps_, [&](Work& share) {
                return prove_by_region(labels.transitions(), smallest_region(labels.open()), share);
            });
        }
        return outcome == ProofOutcome::kProved ? std::optional(SplitProof::kSmallestRegion)
                                                : std::nullopt;
    }

    std::size_t original_count_;
    std::uint64_t region_steps_;
    Work& work_;
    SplitLabels all_;
    ProvedLabels best_;
};

}  // namespace

std::optional<ProvedLabels> merge_labels(
    SplitLabels labels, std::size_t original_count, std::uint64_t region_steps, Work& work
) {
    return Merger(std::move(labels), original_count, region_steps, work).run();
}

}  // namespace modelsynth::discrete
