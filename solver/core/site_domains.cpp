#include "solver/core/site_domains.h"

#include "solver/core/result.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace modelsynth {

SiteDomains::SiteDomains(std::size_t site_count, LabelSet everywhere) : set_of_site_(site_count) {
    sets_.push_back(std::move(everywhere));
}

void SiteDomains::narrow(Site site, const LabelSet& allowed) {
    LabelSet narrowed = at(site);
    narrowed &= allowed;
    // From the newest: neighbouring sites mostly get the same set one after the other.
    const auto found = std::find(sets_.rbegin(), sets_.rend(), narrowed);
    if (found != sets_.rend()) {
        set_of_site_[site] = static_cast<std::uint16_t>(sets_.rend() - found - 1);
        return;
    }
    check(
        sets_.size() <= std::numeric_limits<std::uint16_t>::max(),
        "more different site domains than numbers for them"
    );
    set_of_site_[site] = static_cast<std::uint16_t>(sets_.size());
    sets_.push_back(std::move(narrowed));
}

}  // namespace modelsynth
