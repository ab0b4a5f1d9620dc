#include "solver/core/site_weights.h"

#include "solver/core/result.h"

#include <algorithm>

namespace modelsynth {

SiteWeights::SiteWeights(std::vector<LabelWeights> tables, std::vector<std::uint16_t> table_of_site)
    : tables_(std::move(tables)), table_of_site_(std::move(table_of_site)) {
    check(
        std::all_of(
            table_of_site_.begin(),
            table_of_site_.end(),
            [this](std::uint16_t number) { return number < tables_.size(); }
        ),
        "a site with a table of weights that there is not"
    );
}

}  // namespace modelsynth
