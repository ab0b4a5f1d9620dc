#pragma once

#include "solver/core/label_set.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace modelsynth {

// More different tables of weights than this are refused: a table for each value that
// probabilities have in some cell together.
inline constexpr std::size_t kWeightTablesMax = 4096;

// Gathers the weights of every site from probabilities that hold in some of them.
class WeightTables {
  public:
    WeightTables(std::size_t site_count, std::vector<double> everywhere);

    // Multiplies the weights of the labels at the site by a factor above 0, the same for every site
    // to which `rule` gives that factor. False when there are too many tables.
    [[nodiscard]] bool multiply(Site site, std::size_t rule, const LabelSet& labels, double factor);

    // Table 0 is what was given for everywhere.
    [[nodiscard]] SiteWeights finish() &&;

  private:
    std::size_t site_count_;
    std::vector<std::uint16_t> table_of_site_;  // empty: table 0 everywhere
    std::vector<std::vector<double>> tables_;
    // By table, rule and factor, the table of the product.
    std::map<std::tuple<std::uint16_t, std::size_t, double>, std::uint16_t> products_;
};

}  // namespace modelsynth
