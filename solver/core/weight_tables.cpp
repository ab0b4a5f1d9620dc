#include "solver/core/weight_tables.h"

#include <algorithm>
#include <utility>

namespace modelsynth {

namespace {

// However many probabilities come together, a weight stays a positive number.
constexpr double kWeightLeast = 1e-30;
constexpr double kWeightMost = 1e30;

}  // namespace

WeightTables::WeightTables(std::size_t site_count, std::vector<double> everywhere)
    : site_count_(site_count), tables_{std::move(everywhere)} {}

bool WeightTables::multiply(Site site, std::size_t rule, const LabelSet& labels, double factor) {
    table_of_site_.resize(site_count_);
    const std::tuple key(table_of_site_[site], rule, factor);
    auto known = products_.find(key);
    if (known == products_.end()) {
        if (tables_.size() == kWeightTablesMax) {
            return false;
        }
        std::vector<double> table = tables_[table_of_site_[site]];
        for_each_label(labels.words(), [&](Label label) {
            if (table[label] > 0) {
                table[label] = std::clamp(table[label] * factor, kWeightLeast, kWeightMost);
            }
        });
        known = products_.emplace(key, static_cast<std::uint16_t>(tables_.size())).first;
        tables_.push_back(std::move(table));
    }
    table_of_site_[site] = known->second;
    return true;
}

SiteWeights WeightTables::finish() && {
    std::vector<LabelWeights> tables;
    tables.reserve(tables_.size());
    for (const std::vector<double>& table : tables_) {
        tables.emplace_back(table);
    }
    if (tables.size() == 1) {
        return SiteWeights(std::move(tables.front()));
    }
    return {std::move(tables), std::move(table_of_site_)};
}

}  // namespace modelsynth
