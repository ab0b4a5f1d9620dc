#pragma once

#include "solver/core/label_set.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// The labels each site may take by itself, before any neighbour is asked: boundaries, fixed
// cells, forbidden labels. Few different sets occur, so a site holds the number of its set; and
// most sites hold the same one as those beside them, so a chunk of sites holds one number for all
// of them as long as it can.
// Cost: 4 bytes for 64 sites, 128 more where these are not all the same. Thread-safe once filled.
class SiteDomains {
  public:
    // Every site may take any label of `everywhere`.
    SiteDomains(std::size_t site_count, LabelSet everywhere);

    // Keeps at the site only labels of `allowed`.
    void narrow(Site site, const LabelSet& allowed);

    // Gives the site the set of another one; cheaper than to narrow it to the same.
    void repeat(Site site, Site other) { put(site, number(other)); }

    [[nodiscard]] const LabelSet& at(Site site) const { return sets_[number(site)]; }

    [[nodiscard]] std::span<const Word> words(Site site) const { return at(site).words(); }

    // Equal for two sites exactly when their sets are.
    [[nodiscard]] std::uint16_t number(Site site) const {
        const std::uint32_t chunk = chunks_[site / kChunkSites];
        return chunk < kMixed ? static_cast<std::uint16_t>(chunk)
                              : mixed_[chunk - kMixed][site % kChunkSites];
    }

    // Those of sites that follow each other.
    void copy_numbers(Site first, std::span<std::uint16_t> numbers) const {
        auto out = numbers.begin();
        for_each_chunk(
            first,
            numbers.size(),
            [&](Site site, std::size_t count, std::uint32_t chunk) {
                if (chunk < kMixed) {
                    out = std::fill_n(out, count, static_cast<std::uint16_t>(chunk));
                } else {
                    out = std::copy_n(&mixed_[chunk - kMixed][site % kChunkSites], count, out);
                }
            }
        );
    }

    // Calls visit(Site first, std::size_t count, std::uint16_t number) for so many sites from the
    // first on, in rising order, for some that have the same set at a time.
    template <class Visit>
    void for_each_run(Site first, std::size_t sites, Visit visit) const {
        for_each_chunk(first, sites, [&](Site site, std::size_t count, std::uint32_t chunk) {
            if (chunk < kMixed) {
                visit(site, count, static_cast<std::uint16_t>(chunk));
                return;
            }
            for (const std::size_t end = site + count; site < end; ++site) {
                visit(site, std::size_t{1}, number(site));
            }
        });
    }

    // Numbers are below this; some may be of no site.
    [[nodiscard]] std::size_t set_count() const { return sets_.size(); }

    // The set of such a number.
    [[nodiscard]] const LabelSet& set(std::uint16_t number) const { return sets_[number]; }

    [[nodiscard]] std::size_t site_count() const { return site_count_; }

  private:
    static constexpr std::size_t kChunkSites = 64;
    static constexpr std::uint32_t kMixed = std::uint32_t{1} << 16;

    void put(Site site, std::uint16_t number);

    // Calls visit(Site first, std::size_t count, std::uint32_t chunk) for the chunks that these
    // sites are in, and for those of each that are.
    template <class Visit>
    void for_each_chunk(Site first, std::size_t count, Visit visit) const {
        const std::size_t end = first + count;
        for (std::size_t site = first, next = 0; site < end; site = next) {
            next = std::min(end, (site / kChunkSites + 1) * kChunkSites);
            visit(static_cast<Site>(site), next - site, chunks_[site / kChunkSites]);
        }
    }

    std::size_t site_count_;
    std::vector<LabelSet> sets_;
    // By chunk, the number of all its sites; or kMixed and on, the index of their numbers in
    // mixed_.
    std::vector<std::uint32_t> chunks_;
    std::vector<std::array<std::uint16_t, kChunkSites>> mixed_;
};

}  // namespace modelsynth
