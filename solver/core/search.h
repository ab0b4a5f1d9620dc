#pragma once

#include "solver/core/catalog.h"
#include "solver/core/label_weights.h"
#include "solver/core/random.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace modelsynth {

// Which site is labelled next.
enum class Order : std::uint8_t {
    kScan,        // in a given order, column by column for a grid
    kMinEntropy,  // where the choice is least open, ties at random
    kRandom,      // anywhere
};

enum class SearchOutcome : std::uint8_t { kSolved, kFailed, kStopped };

// Hands out sites in a fixed order.
class ScanPicker {
  public:
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

  private:
    std::span<const Site> order_;
    std::size_t position_ = 0;
};

// Hands out the site of least entropy from a heap of (entropy, noise) keys. Entries are renewed
// when a site changes; an entry whose key is no longer the site's is passed over.
class EntropyPicker {
  public:
    template <class CatalogType>
    EntropyPicker(CatalogType& catalog, const LabelWeights& weights, RandomStream& random)
        : weights_(weights), keys_(catalog.site_count()), noise_(catalog.site_count()) {
        catalog.track_changes();
        catalog.clear_changed();
        for (std::size_t site = 0; site < keys_.size(); ++site) {
            noise_[site] = random.next();
            push(catalog, static_cast<Site>(site));
        }
    }

    template <class CatalogType>
    bool next(CatalogType& catalog, Site& site) {
        for (const Site changed : catalog.changed()) {
            push(catalog, changed);
        }
        catalog.clear_changed();
        while (!heap_.empty()) {
            const Entry least = heap_.front();
            site = least.second;
            if (least.first == keys_[site] && has_several(catalog.labels(site))) {
                return true;
            }
            std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
            heap_.pop_back();
        }
        return false;
    }

  private:
    using Entry = std::pair<std::uint64_t, Site>;

    template <class CatalogType>
    void push(const CatalogType& catalog, Site site) {
        if (!has_several(catalog.labels(site))) {
            return;
        }
        const std::uint64_t key =
            std::uint64_t{weights_.entropy(catalog.labels(site))} << 32 | noise_[site];
        if (key == keys_[site]) {
            return;
        }
        keys_[site] = key;
        heap_.emplace_back(key, site);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }

    const LabelWeights& weights_;
    std::vector<std::uint64_t> keys_;
    std::vector<std::uint32_t> noise_;
    std::vector<Entry> heap_;
};

// The loop of Algorithm 3.1 over an arc-consistent catalog: pick a site, draw a label, propagate.
// A label that propagation refutes is taken back and removed for good, which keeps the catalog an
// outer bound of the ideal one; only when its removal is refuted too has the search failed.
// Ensures: kSolved leaves exactly one label at every site.
// Cost:    one propagation per pick. Same thread-safety as the catalog.
template <class CatalogType, class Picker>
[[nodiscard]] SearchOutcome search(
    CatalogType& catalog,
    Picker& picker,
    const LabelWeights& weights,
    RandomStream& random,
    const std::stop_token& stop
) {
    Site site = 0;
    while (picker.next(catalog, site)) {
        const Label label = weights.draw(catalog.labels(site), random);
        const auto mark = catalog.mark();
        catalog.assign(site, label);
        Propagation propagation = catalog.propagate(stop);
        if (propagation == Propagation::kContradiction) {
            catalog.undo(mark);
            propagation =
                catalog.remove(site, label) ? catalog.propagate(stop) : Propagation::kContradiction;
        } else {
            catalog.keep();
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

}  // namespace modelsynth
