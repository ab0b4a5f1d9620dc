#include "solver/core/site_domains.h"

#include "solver/core/result.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace modelsynth {

SiteDomains::SiteDomains(std::size_t site_count, LabelSet everywhere)
    : site_count_(site_count), chunks_((site_count + kChunkSites - 1) / kChunkSites) {
    sets_.push_back(std::move(everywhere));
}

void SiteDomains::narrow(Site site, const LabelSet& allowed) {
    LabelSet narrowed = at(site);
    narrowed &= allowed;
    // From the newest: neighbouring sites mostly get the same set one after the other.
    const auto found = std::find(sets_.rbegin(), sets_.rend(), narrowed);
    if (found != sets_.rend()) {
        put(site, static_cast<std::uint16_t>(sets_.rend() - found - 1));
        return;
    }
    check(
        sets_.size() <= std::numeric_limits<std::uint16_t>::max(),
        "more different site domains than numbers for them"
    );
    sets_.push_back(std::move(narrowed));
    put(site, static_cast<std::uint16_t>(sets_.size() - 1));
}

void SiteDomains::put(Site site, std::uint16_t number) {
    std::uint32_t& chunk = chunks_[site / kChunkSites];
    if (chunk < kMixed) {
        if (chunk == number) {
            return;
        }
        const auto before = static_cast<std::uint16_t>(chunk);
        chunk = kMixed + static_cast<std::uint32_t>(mixed_.size());
        mixed_.emplace_back().fill(before);
    }
    mixed_[chunk - kMixed][site % kChunkSites] = number;
}

}  // namespace modelsynth
