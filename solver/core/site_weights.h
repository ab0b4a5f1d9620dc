#pragma once

#include "solver/core/label_weights.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {

// How often each label should be chosen at each site: tables of weights, and the number of the
// table for every site.
// Cost: two bytes a site, nothing where one table serves all. Thread-safe.
class SiteWeights {
  public:
    explicit SiteWeights(LabelWeights everywhere) {
        tables_.push_back(std::move(everywhere));
        tables_.front().add_up_groups();
    }

    // Requires: every number is that of a table (checked).
    SiteWeights(std::vector<LabelWeights> tables, std::vector<std::uint16_t> table_of_site);

    [[nodiscard]] bool is_same_everywhere() const { return table_of_site_.empty(); }

    [[nodiscard]] std::size_t table_count() const { return tables_.size(); }

    [[nodiscard]] const LabelWeights& table(std::size_t number) const { return tables_[number]; }

    [[nodiscard]] std::uint16_t number(Site site) const {
        return table_of_site_.empty() ? std::uint16_t{0} : table_of_site_[site];
    }

    [[nodiscard]] const LabelWeights& at(Site site) const { return tables_[number(site)]; }

  private:
    std::vector<LabelWeights> tables_;
    std::vector<std::uint16_t> table_of_site_;
};

// The weights of a part: sites are numbered as inside it. Requires: what it refers to outlives it.
struct PartWeights {
    const SiteWeights& weights;
    std::span<const std::uint16_t> numbers;  // of the tables, by site; empty: the same everywhere

    [[nodiscard]] const LabelWeights& at(Site inside) const {
        return weights.table(numbers.empty() ? 0 : numbers[inside]);
    }
};

}  // namespace modelsynth
