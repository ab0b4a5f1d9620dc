#pragma once

#include "solver/core/label_set.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// The labels each site may take by itself, before any neighbour is asked: boundaries, fixed
// cells, forbidden labels. Few different sets occur, so a site holds the number of its set.
// Cost: two bytes a site. Thread-safe once filled.
class SiteDomains {
  public:
    // Every site may take any label of `everywhere`.
    SiteDomains(std::size_t site_count, LabelSet everywhere);

    // Keeps at the site only labels of `allowed`.
    void narrow(Site site, const LabelSet& allowed);

    // Gives the site the set of another one; cheaper than to narrow it to the same.
    void repeat(Site site, Site other) { set_of_site_[site] = set_of_site_[other]; }

    [[nodiscard]] const LabelSet& at(Site site) const { return sets_[set_of_site_[site]]; }

    [[nodiscard]] std::span<const Word> words(Site site) const { return at(site).words(); }

    // Equal for two sites exactly when their sets are.
    [[nodiscard]] std::uint16_t number(Site site) const { return set_of_site_[site]; }

    [[nodiscard]] std::size_t site_count() const { return set_of_site_.size(); }

  private:
    std::vector<LabelSet> sets_;
    std::vector<std::uint16_t> set_of_site_;
};

}  // namespace modelsynth
