#pragma once

#include "solver/core/growing_sets.h"
#include "solver/core/random.h"
#include "solver/core/search.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {

// All sites, every order of them as likely.
[[nodiscard]] inline std::vector<Site> shuffled_sites(std::size_t count, RandomStream& random) {
    std::vector<Site> sites(count);
    std::iota(sites.begin(), sites.end(), Site{0});
    for (std::size_t left = sites.size(); left > 1; --left) {
        std::swap(sites[left - 1], sites[random.below(static_cast<std::uint32_t>(left))]);
    }
    return sites;
}

// All sites, from those that are decided in the catalog, or from one drawn at random, outwards: the
// next site is any of those beside the ones before; anew where the topology does not hang together.
template <class CatalogType, Topology T>
[[nodiscard]] std::vector<Site> growing_sites(
    const CatalogType& catalog, const T& topology, RandomStream& random
) {
    std::vector<Site> order;
    std::vector<Site> edge;
    std::vector<std::uint8_t> is_met(topology.site_count());
    const auto meet = [&](Site site) {
        if (std::exchange(is_met[site], std::uint8_t{1}) == 0) {
            edge.push_back(site);
        }
    };
    const auto spread = [&] {
        while (!edge.empty()) {
            std::swap(edge[random.below(static_cast<std::uint32_t>(edge.size()))], edge.back());
            order.push_back(edge.back());
            edge.pop_back();
            topology.for_each_arc(order.back(), [&](Site to, RelationId) { meet(to); });
        }
    };
    const auto count = static_cast<Site>(is_met.size());
    for (Site site = 0; site < count; ++site) {
        if (!has_several(catalog.labels(site))) {
            meet(site);
        }
    }
    spread();
    const Site first = random.below(count);
    for (Site i = 0; i < count; ++i) {
        meet((first + i) % count);
        spread();
    }
    return order;
}

// Hands out sites that have to take a label of one of some sets first, at random, and others in a
// fixed order.
class GrowthPicker {
  public:
    static constexpr bool kFollowsChanges = true;

    // Requires: sets and order outlive it; `order` has every site once.
    template <class CatalogType>
    GrowthPicker(
        CatalogType& catalog,
        const GrowingSets& sets,
        std::span<const Site> order,
        RandomStream& random
    )
        : sets_(sets), rest_(order), random_(random), is_listed_(order.size()) {
        catalog.track_changes();
        catalog.clear_changed();
        for (std::size_t site = 0; site < order.size(); ++site) {
            list_if_bound(catalog, static_cast<Site>(site));
        }
    }

    template <class CatalogType>
    bool next(CatalogType& catalog, Site& site) {
        for (const Site changed : catalog.changed()) {
            list_if_bound(catalog, changed);
        }
        catalog.clear_changed();
        while (!bound_.empty()) {
            const std::uint32_t at = random_.below(static_cast<std::uint32_t>(bound_.size()));
            site = bound_[at];
            if (sets_.is_bound(site, catalog.labels(site))) {
                return true;
            }
            // Decided, or freed again when a choice was taken back.
            is_listed_[site] = 0;
            bound_[at] = bound_.back();
            bound_.pop_back();
        }
        return rest_.next(catalog, site);
    }

    [[nodiscard]] std::size_t position() const { return rest_.position(); }

    void go_back(std::size_t position) { rest_.go_back(position); }

  private:
    template <class CatalogType>
    void list_if_bound(const CatalogType& catalog, Site site) {
        if (is_listed_[site] == 0 && sets_.is_bound(site, catalog.labels(site))) {
            is_listed_[site] = 1;
            bound_.push_back(site);
        }
    }

    const GrowingSets& sets_;
    ScanPicker rest_;
    RandomStream& random_;
    std::vector<std::uint8_t> is_listed_;  // in bound_
    std::vector<Site> bound_;
};

// Calls task(picker) with the picker of an order, and gives what it returns.
// Shape: `scan` has every site once; it outlives the call.
template <class CatalogType, Topology T, class Task>
auto with_picker(
    Order order,
    CatalogType& catalog,
    const T& topology,
    std::span<const Site> scan,
    const PartWeights& weights,
    RandomStream& random,
    Task task
) {
    switch (order) {
        case Order::kMinEntropy:
            return task(LeastOpenPicker(catalog, weights, random, Openness::kEntropy));
        case Order::kFewestLabels:
            return task(LeastOpenPicker(catalog, weights, random, Openness::kLabelCount));
        case Order::kRandom: {
            const std::vector<Site> shuffled = shuffled_sites(topology.site_count(), random);
            return task(ScanPicker(shuffled));
        }
        case Order::kGrowth: {
            const std::vector<Site> growing = growing_sites(catalog, topology, random);
            return task(ScanPicker(growing));
        }
        case Order::kScan:
            break;
    }
    return task(ScanPicker(scan));
}

}  // namespace modelsynth
