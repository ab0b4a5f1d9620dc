#pragma once

#include "solver/core/label_set.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth {

// What propagation makes of parts when nothing outside them is known: the domains alone. Many
// blocks of a model have the same one - all that touch the same sides - and so have all models of
// one problem; it takes longer than the rest of their knowledge. Kept, it changes no result, only
// the time.
// Requires: one problem (relations and domains) for all calls. Thread-safe.
template <class T>
class BlockBases {
  public:
    struct Base {
        T topology;
        std::vector<std::uint16_t> domains;
        std::vector<Word> sets;
    };

    // The state for such a part; null when none is kept.
    [[nodiscard]] std::shared_ptr<const Base> find(
        const T& topology, std::span<const std::uint16_t> domains
    ) const {
        const std::lock_guard lock(mutex_);
        const auto found = find_locked(topology, domains);
        return found == bases_.end() ? nullptr : *found;
    }

    // Forgets the oldest ones when memory would grow beyond the limit.
    void keep(Base base) {
        const std::lock_guard lock(mutex_);
        if (base.sets.size() > kWordsMax ||
            find_locked(base.topology, base.domains) != bases_.end()) {
            return;
        }
        words_ += base.sets.size();
        bases_.push_back(std::make_shared<const Base>(std::move(base)));
        while (words_ > kWordsMax || bases_.size() > kBasesMax) {
            words_ -= bases_.front()->sets.size();
            bases_.pop_front();
        }
    }

  private:
    // A block may touch each side of a model or not: 27 kinds in space. A few more for fixed cells.
    static constexpr std::size_t kBasesMax = 32;
    static constexpr std::size_t kWordsMax = std::size_t{1} << 20;

    using Bases = std::deque<std::shared_ptr<const Base>>;

    [[nodiscard]] typename Bases::const_iterator find_locked(
        const T& topology, std::span<const std::uint16_t> domains
    ) const {
        return std::find_if(bases_.begin(), bases_.end(), [&](const auto& base) {
            return std::equal(
                       domains.begin(), domains.end(), base->domains.begin(), base->domains.end()
                   ) &&
                   base->topology == topology;
        });
    }

    mutable std::mutex mutex_;
    Bases bases_;
    std::size_t words_ = 0;  // of all sets together
};

}  // namespace modelsynth
