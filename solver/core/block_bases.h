#pragma once

#include "solver/core/label_set.h"
#include "solver/core/relations.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace modelsynth {

// What propagation makes of parts of which little outside is known: by the domains alone, and with
// what usually stands around. Many blocks of a model have the same one - all that touch the same
// sides, and to the same sides of which nothing was made yet - and so have all models of one
// problem; it takes longer than the rest of their knowledge. Kept, it changes no result, only the
// time.
// Requires: one problem (relations and domains) for all calls. Thread-safe.
template <class T>
class BlockBases {
  public:
    // What it came of.
    struct Key {
        std::uint32_t groups = 0;    // a bit for each group of outward arcs that are known
        std::vector<Label> outside;  // the labels at their far ends
        std::vector<std::uint16_t> domains;

        friend bool operator==(const Key&, const Key&) = default;
    };

    struct Base {
        T topology;
        Key key;
        std::vector<Word> sets;
    };

    // The state for such a part; null when none is kept.
    [[nodiscard]] std::shared_ptr<const Base> find(const T& topology, const Key& key) {
        const std::uint64_t hash = hash_of(key);
        const std::lock_guard lock(mutex_);
        const auto found = bases_.find(hash);
        const bool is_there = found != bases_.end() && found->second->key == key &&
                              found->second->topology == topology;
        return is_there ? found->second : nullptr;
    }

    // Whether it was asked before, so that it may pay to make it ready: what is known of the
    // outside is often of no other part.
    [[nodiscard]] bool is_asked_again(const Key& key) {
        const std::uint64_t hash = hash_of(key);
        const std::lock_guard lock(mutex_);
        if (asked_.size() > kAskedMax) {
            asked_.clear();
        }
        return !asked_.insert(hash).second;
    }

    // Forgets the oldest ones when memory would grow beyond the limit.
    void keep(Base base) {
        const std::uint64_t hash = hash_of(base.key);
        const std::lock_guard lock(mutex_);
        if (base.sets.size() > kWordsMax || bases_.contains(hash)) {
            return;
        }
        words_ += base.sets.size();
        bases_.emplace(hash, std::make_shared<const Base>(std::move(base)));
        by_age_.push_back(hash);
        while (words_ > kWordsMax || by_age_.size() > kBasesMax) {
            const auto oldest = bases_.find(by_age_.front());
            words_ -= oldest->second->sets.size();
            bases_.erase(oldest);
            by_age_.pop_front();
        }
    }

  private:
    static constexpr std::size_t kWordsMax = std::size_t{1} << 20;
    static constexpr std::size_t kBasesMax = 256;  // topologies take memory, too
    static constexpr std::size_t kAskedMax = 4096;

    // Of each eight bytes by themselves, so that no step waits for the one before.
    template <class Value>
    static std::uint64_t hash_of(const std::vector<Value>& values, std::uint64_t factor) {
        const std::size_t size = values.size() * sizeof(Value);
        const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
        std::uint64_t sum = size;
        for (std::size_t at = 0; at < size; at += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + at, std::min(sizeof(word), size - at));
            factor += 0x9E37'79B9'7F4A'7C14;  // stays odd
            word = (word + 1) * factor;
            sum += (word ^ word >> 32) * 0xD6E8'FEB8'6659'FD93;
        }
        return sum;
    }

    static std::uint64_t hash_of(const Key& key) {
        return hash_of(key.domains, 1) + hash_of(key.outside, 3) +
               key.groups * std::uint64_t{0xD6E8'FEB8'6659'FD93};
    }

    std::mutex mutex_;
    std::unordered_map<std::uint64_t, std::shared_ptr<const Base>> bases_;  // by hash of the key
    std::deque<std::uint64_t> by_age_;
    std::size_t words_ = 0;  // of all sets together
    std::unordered_set<std::uint64_t> asked_;
};

}  // namespace modelsynth
