#pragma once

#include "solver/core/catalog.h"
#include "solver/core/constraints/constraint_board.h"
#include "solver/core/growing_sets.h"
#include "solver/core/label_chooser.h"
#include "solver/core/least_key.h"
#include "solver/core/order.h"
#include "solver/core/random.h"
#include "solver/core/site_weights.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace modelsynth {

enum class SearchOutcome : std::uint8_t { kSolved, kFailed, kStopped };

// Hands out sites in a fixed order.
class ScanPicker {
  public:
    // Whether next() takes note of the changes that the catalog tracks, and clears them.
    static constexpr bool kFollowsChanges = false;

    explicit ScanPicker(std::span<const Site> order) : order_(order) {}

    // The next site with more than one label left; false at the end.
    template <class CatalogType>
    bool next(CatalogType& catalog, Site& site) {
        while (position_ < order_.size()) {
            site = order_[position_];
            if (has_several(catalog.labels(site))) {
                return true;
            }
            ++position_;
        }
        return false;
    }

    // Where it stands, and back to there after the catalog was put back to that state.
    [[nodiscard]] std::size_t position() const { return position_; }

    void go_back(std::size_t position) { position_ = position; }

  private:
    std::span<const Site> order_;
    std::size_t position_ = 0;
};

// How open the choice at a site is.
enum class Openness : std::uint8_t { kEntropy, kLabelCount };

// Hands out the site whose choice is least open; noise decides between equal ones.
class LeastOpenPicker {
  public:
    static constexpr bool kFollowsChanges = true;

    template <class CatalogType>
    LeastOpenPicker(
        CatalogType& catalog, const PartWeights& weights, RandomStream& random, Openness openness
    )
        : openness_(openness),
          weights_(weights),
          noise_(catalog.site_count()),
          round_of_(catalog.site_count()),
          keys_(catalog.site_count()) {
        catalog.track_changes();
        catalog.clear_changed();
        for (std::size_t site = 0; site < noise_.size(); ++site) {
            noise_[site] = random.next();
            renew(catalog, static_cast<Site>(site));
        }
    }

    template <class CatalogType>
    bool next(CatalogType& catalog, Site& site) {
        ++round_;
        for (const Site changed : catalog.changed()) {
            if (round_of_[changed] != round_) {  // some are listed many times
                round_of_[changed] = round_;
                renew(catalog, changed);
            }
        }
        catalog.clear_changed();
        if (keys_.least() == LeastKey::kNoKey) {
            return false;
        }
        site = static_cast<Site>(keys_.first_least());
        return true;
    }

    // As of ScanPicker; it follows the catalog by itself.
    [[nodiscard]] std::size_t position() const { return 0; }

    void go_back(std::size_t /*position*/) {}

  private:
    template <class CatalogType>
    void renew(const CatalogType& catalog, Site site) {
        const auto labels = catalog.labels(site);
        keys_.set(
            site,
            has_several(labels) ? std::uint64_t{openness(site, labels)} << 32 | noise_[site]
                                : LeastKey::kNoKey
        );
    }

    template <class Labels>
    [[nodiscard]] std::uint32_t openness(Site site, const Labels& labels) const {
        return openness_ == Openness::kEntropy ? weights_.at(site).entropy(labels)
                                               : static_cast<std::uint32_t>(count_labels(labels));
    }

    Openness openness_;

    PartWeights weights_;
    std::vector<std::uint32_t> noise_;
    std::vector<std::uint64_t> round_of_;  // of calls in which the site's key was looked at last
    std::uint64_t round_ = 0;
    LeastKey keys_;
};

// How much a search takes back before it fails.
struct SearchBudget {
    std::uint32_t backtracks = 0;  // choices taken back; 0: the first dead end is the end
};

// What a search may have beside relations and weights; null: none.
struct SearchAids {
    ConstraintBoard* board = nullptr;  // the constraints beside the relations; follows the catalog
    PartChooser* chooser = nullptr;    // chooses labels in place of the weights alone
    const GrowingSets* growing = nullptr;  // avoided where there is no chooser
    // By site, counted up where a choice before was found wrong: at the site that had no label
    // left, with a board at the one whose labels were tried. Empty: not counted.
    std::span<std::uint32_t> dead_ends = {};
};

// The loop of Algorithm 3.1 over an arc-consistent catalog: pick a site, draw a label, propagate.
// A label that propagation refutes is taken back and removed, which keeps the catalog an outer
// bound of the ideal one. When its removal is refuted too, the choices before lead nowhere.
//
// Within its budget the search then takes back the last choice and removes that label. When that
// does not help for a while it jumps back over several choices, further and further (patience
// and jumps as of DeBroglie, github.com/BorisTheBrave/DeBroglie), to draw them anew.
// Ensures: kSolved leaves exactly one label at every site.
// Cost:    one propagation per pick, two per choice taken back. Same thread-safety as the catalog.
template <class CatalogType, class Picker>
class Search {
  public:
    Search(
        CatalogType& catalog,
        Picker& picker,
        const PartWeights& weights,
        const SearchAids& aids,
        RandomStream& random,
        std::stop_token stop
    )
        : catalog_(catalog),
          picker_(picker),
          weights_(weights),
          board_(aids.board),
          chooser_(aids.chooser),
          growing_(aids.growing),
          dead_ends_(aids.dead_ends),
          random_(random),
          stop_(std::move(stop)) {}

    [[nodiscard]] SearchOutcome run(const SearchBudget& budget) {
        Site site = 0;
        while (picker_.next(catalog_, site)) {
            if (stop_.stop_requested()) {
                return SearchOutcome::kStopped;
            }
            const Label label = choose(site);
            const auto mark = catalog_.mark();
            const std::size_t position = picker_.position();
            catalog_.assign(site, label);
            Propagation propagation = propagate();
            if (propagation == Propagation::kConsistent) {
                if (budget.backtracks > 0) {
                    choices_.push_back({mark, position, site, label});
                } else {
                    catalog_.keep();
                }
                continue;
            }
            if (propagation == Propagation::kContradiction) {
                undo(mark);
                propagation = refute(site, label);
            }
            while (propagation == Propagation::kContradiction && !choices_.empty() &&
                   backtracks_ < budget.backtracks) {
                propagation = take_back();
            }
            if (propagation == Propagation::kStopped) {
                return SearchOutcome::kStopped;
            }
            if (propagation == Propagation::kContradiction) {
                return SearchOutcome::kFailed;
            }
        }
        return SearchOutcome::kSolved;
    }

    // Choices that were taken back, those jumped over counted as one.
    [[nodiscard]] std::uint32_t backtracks() const { return backtracks_; }

  private:
    using Mark = typename CatalogType::Mark;

    struct Choice {
        Mark mark;
        std::size_t position;  // of the picker before it
        Site site;
        Label label;
    };

    static constexpr std::uint32_t kPatience = 10;
    static constexpr std::size_t kFirstJump = 4;
    static constexpr std::uint32_t kJumpDoublingsMax = 10;

    Label choose(Site site) {
        const LabelWeights& weights = weights_.at(site);
        if (chooser_ != nullptr) {
            return chooser_->choose(catalog_, site, weights, random_);
        }
        const auto labels = catalog_.labels(site);
        return growing_ == nullptr ? weights.draw(labels, random_)
                                   : growing_->draw(site, labels, weights, random_);
    }

    Propagation refute(Site site, Label label) {
        const Propagation propagation =
            catalog_.remove(site, label) ? propagate() : Propagation::kContradiction;
        if (propagation == Propagation::kContradiction && !dead_ends_.empty()) {
            ++dead_ends_[board_ == nullptr ? catalog_.emptied_site() : site];
        }
        return propagation;
    }

    Propagation propagate() {
        Propagation propagation = catalog_.propagate(stop_);
        if (board_ != nullptr && propagation == Propagation::kConsistent) {
            propagation = board_->settle(catalog_, stop_);
            if constexpr (!Picker::kFollowsChanges) {
                if (propagation == Propagation::kConsistent) {
                    catalog_.clear_changed();
                }
            }
        }
        return propagation;
    }

    void undo(Mark mark) {
        catalog_.undo(mark);
        if (board_ != nullptr) {
            board_->rewind(catalog_);
        }
    }

    Propagation take_back() {
        ++backtracks_;
        if (choices_.size() > deepest_) {
            deepest_ = choices_.size();
            failures_ = 0;
            doublings_ = 0;
        }
        std::size_t jump = 1;
        if (++failures_ > kPatience << doublings_) {
            jump = std::min(choices_.size(), kFirstJump << doublings_);
            doublings_ = std::min(doublings_ + 1, kJumpDoublingsMax);
            failures_ = 0;
        }
        Choice choice = choices_.back();
        for (std::size_t i = 0; i < jump; ++i) {
            choice = choices_.back();
            choices_.pop_back();
            undo(choice.mark);
        }
        picker_.go_back(choice.position);
        // What was jumped over is not refuted.
        return jump == 1 ? refute(choice.site, choice.label) : Propagation::kConsistent;
    }

    CatalogType& catalog_;
    Picker& picker_;
    PartWeights weights_;
    ConstraintBoard* board_;
    PartChooser* chooser_;
    const GrowingSets* growing_;
    std::span<std::uint32_t> dead_ends_;
    RandomStream& random_;
    std::stop_token stop_;
    std::vector<Choice> choices_;
    std::uint32_t backtracks_ = 0;
    std::size_t deepest_ = 0;
    std::uint32_t failures_ = 0;   // since there were never more choices
    std::uint32_t doublings_ = 0;  // of patience and jump
};

}  // namespace modelsynth
