#pragma once

#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/core/topology.h"
#include "solver/core/vector_level.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace modelsynth {

enum class Propagation : std::uint8_t { kConsistent, kContradiction, kStopped };

// The catalog's state, as the inner loop sees it: what Catalog holds in vectors, by address.
template <std::size_t kRelations>
struct StepState {
    Word* sets = nullptr;  // of site 0; those of a step before the first and after the last can be
                           // read, and say nothing
    std::array<std::int64_t, kRelations> steps = {};  // from a site to its neighbour, by relation
    const std::uint8_t* arcs = nullptr;               // bit r of a site: there is that neighbour
    const Word* unions = nullptr;                     // Relations::union_data() of the first group
    const std::uint8_t* kinds = nullptr;              // in its place, in layers: by site, and ...
    const Word* const* tables = nullptr;              // ... by kind

    // The sites to look at, a ring in which each is once at most, with room for one more.
    Site* queue = nullptr;
    std::size_t queue_size = 0;
    std::size_t queue_head = 0;
    std::size_t queue_length = 0;
    std::uint8_t* queued = nullptr;

    // What to put back; there is room for every site once, and for one more.
    bool is_saving = false;
    std::uint64_t stamp = 0;
    std::uint64_t* saved = nullptr;  // the stamp under which a site is on the trail
    Site* trail_sites = nullptr;
    Word* trail_words = nullptr;
    std::size_t trail_length = 0;

    std::vector<Site>* changed = nullptr;  // null: nobody wants to know
    Site emptied = 0;
};

// Catalog::propagate() where every neighbour is a fixed step away: the loop that most of all time
// is spent in. It looks at all neighbours of a site at once and keeps its state in registers.
//
// Sets of one or two words are looked at four at a time while the queue has as many. What a set
// allows is a chain of loads that ends in a branch nobody can predict - which neighbours change -,
// and four chains and one such branch take hardly longer than one of each. A site of the four may
// be changed by another one: then it is in the queue again, and what was taken by its older, larger
// set was right as far as it went. (Of larger sets it gains nothing.)
//
// One source serves every VectorLevel; the compiler makes of it what the level allows, so results
// are the same.
template <std::size_t kRelations, std::size_t kWords, bool kLayered>
class StepKernel {
  public:
    static Propagation run(
        StepState<kRelations>& state, const std::stop_token& stop, VectorLevel level
    ) {
        return level == VectorLevel::kAvx2 ? run_avx2(state, stop) : run_portable(state, stop);
    }

  private:
    static constexpr std::size_t kGroupBits = Relations::group_bits_for(kWords, kRelations);
    static constexpr std::size_t kGroups = kWordBits / kGroupBits;  // of one word
    static constexpr Word kMembers = (Word{1} << kGroupBits) - 1;
    static constexpr std::size_t kStride = Relations::stride_for(kRelations, kWords);
    static constexpr std::size_t kStopInterval = 256;
    static constexpr std::size_t kLanes = kWords <= 2 ? 4 : 1;  // sites looked at together
    static constexpr std::size_t kLaneBits = 8;                 // of the mask of changes, for each
    static_assert(kRelations <= kLaneBits);

    using Vector [[gnu::vector_size(32), gnu::may_alias]] = Word;

    static constexpr std::size_t kVectorWords = sizeof(Vector) / sizeof(Word);
    static constexpr std::size_t kVectors = kStride / kVectorWords;

    // The labels that some label of the site's set allows, relation by relation.
    struct alignas(Vector) Support {
        Word words[kStride];
    };

    MODELSYNTH_TARGET_AVX2 static Propagation run_avx2(
        StepState<kRelations>& state, const std::stop_token& stop
    ) {
        return loop(state, stop);
    }

    static Propagation run_portable(StepState<kRelations>& state, const std::stop_token& stop) {
        return loop(state, stop);
    }

    [[gnu::always_inline]] static inline void collect(
        const Word* own, const Word* unions, Support& support
    ) {
        Vector sum[kVectors] = {};
        if constexpr (kWords == 1) {
            // Looking up empty groups too is cheaper than to mispredict how many there are.
            for (std::size_t group = 0; group < kGroups; ++group) {
                add(unions, group, own[0] >> group * kGroupBits & kMembers, sum);
            }
        } else {
            for (std::size_t word = 0; word < kWords; ++word) {
                Word bits = own[word];
                const auto add_first = [&]() __attribute__((always_inline)) {
                    // Of no labels: those of group 0 that are in the set, none.
                    const std::size_t shift =
                        static_cast<std::size_t>(std::countr_zero(bits)) & (kWordBits - kGroupBits);
                    add(unions, word * kGroups + shift / kGroupBits, bits >> shift & kMembers, sum);
                    bits &= ~(kMembers << shift);
                };
                if constexpr (kLanes > 1) {
                    add_first();  // most words have labels of one group, and a branch costs more
                }
                while (bits != 0) {
                    add_first();
                }
            }
        }
        for (std::size_t i = 0; i < kVectors; ++i) {
            reinterpret_cast<Vector*>(support.words)[i] = sum[i];
        }
    }

    [[gnu::always_inline]] static inline void add(
        const Word* unions, std::size_t group, Word members, Vector* sum
    ) {
        const auto* row = reinterpret_cast<const Vector*>(
            unions + (group << kGroupBits | static_cast<std::size_t>(members)) * kStride
        );
        for (std::size_t i = 0; i < kVectors; ++i) {
            sum[i] |= row[i];
        }
    }

    // Sets in some word of `found` bit `first` + r when the neighbour along relation r, or what
    // lies there in memory, has a label without support. Sets that fit are compared by vectors.
    [[gnu::always_inline]] static inline void find_unsupported(
        const Word* own,
        const std::array<std::int64_t, kRelations>& steps,
        const Support& support,
        std::size_t first,
        Vector& found
    ) {
        const auto set = [&](std::size_t relation) __attribute__((always_inline)) {
            return own + steps[relation] * static_cast<std::int64_t>(kWords);
        };
        if constexpr (kWords <= 2) {
            for (std::size_t i = 0; i < kVectors; ++i) {
                Vector sets = {};
                Vector bits = {};
                for (std::size_t word = 0; word < kVectorWords; ++word) {
                    const std::size_t at = i * kVectorWords + word;
                    if (at < kRelations * kWords) {
                        sets[word] = set(at / kWords)[at % kWords];
                        bits[word] = Word{1} << (first + at / kWords);
                    }
                }
                const Vector allowed = reinterpret_cast<const Vector*>(support.words)[i];
                found |= reinterpret_cast<Vector>((sets & ~allowed) != 0) & bits;
            }
        } else {
            for (std::size_t relation = 0; relation < kRelations; ++relation) {
                Word removed = 0;
                for (std::size_t word = 0; word < kWords; ++word) {
                    removed |= set(relation)[word] & ~support.words[relation * kWords + word];
                }
                found[0] |= static_cast<Word>(removed != 0) << (first + relation);
            }
        }
    }

    [[gnu::always_inline]] static inline unsigned merge(const Vector& found) {
        return static_cast<unsigned>(found[0] | found[1] | found[2] | found[3]);
    }

    [[gnu::always_inline]] static inline Propagation loop(
        StepState<kRelations>& state, const std::stop_token& stop
    ) {
        // Copies, so that the compiler sees that no store changes them.
        const auto steps = state.steps;
        const std::uint8_t* const arcs = state.arcs;
        const Word* const unions = state.unions;
        const std::uint8_t* const kinds = state.kinds;
        const Word* const* const tables = state.tables;
        Word* const sets = state.sets;
        Site* const queue = state.queue;
        const std::size_t queue_size = state.queue_size;
        std::size_t head = state.queue_head;
        std::size_t length = state.queue_length;
        std::uint8_t* const queued = state.queued;
        const bool is_saving = state.is_saving;
        const std::uint64_t stamp = state.stamp;
        std::uint64_t* const saved = state.saved;
        Site* const trail_sites = state.trail_sites;
        Word* const trail_words = state.trail_words;
        std::size_t trail = state.trail_length;
        std::vector<Site>* const changed = state.changed;

        Site sites[kLanes] = {};
        Support supports[kLanes];
        Vector found = {};  // by these looks, as of find_unsupported()
        const auto take = [&](std::size_t lane) __attribute__((always_inline)) {
            sites[lane] = queue[head];
            head = head + 1 < queue_size ? head + 1 : 0;
            --length;
            queued[sites[lane]] = 0;
        };
        const auto look = [&](std::size_t lane) __attribute__((always_inline)) {
            const Word* const own = sets + sites[lane] * kWords;
            collect(own, kLayered ? tables[kinds[sites[lane]]] : unions, supports[lane]);
            find_unsupported(own, steps, supports[lane], lane * kLaneBits, found);
            return static_cast<unsigned>(arcs[sites[lane]]) << (lane * kLaneBits);
        };

        Propagation result = Propagation::kConsistent;
        std::size_t rounds = 0;
        while (length > 0 && result == Propagation::kConsistent) {
            if (++rounds % kStopInterval == 0 && stop.stop_requested()) {
                result = Propagation::kStopped;
                break;
            }
            unsigned left = 0;  // of the neighbours that there are
            found = Vector{};
            if (length >= kLanes) {
#pragma GCC unroll 4
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    take(lane);
                }
#pragma GCC unroll 4
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    left |= look(lane);
                }
            } else {
                take(0);
                left = look(0);
            }
            left &= merge(found);
            for (; left != 0; left &= left - 1) {
                const auto bit = static_cast<std::size_t>(std::countr_zero(left));
                const std::size_t lane = bit / kLaneBits;
                const std::size_t relation = bit % kLaneBits;
                const auto neighbour =
                    static_cast<Site>(static_cast<std::int64_t>(sites[lane]) + steps[relation]);
                Word* const set = sets + neighbour * kWords;
                const Word* const allowed = supports[lane].words + relation * kWords;
                if (changed != nullptr) {
                    changed->push_back(neighbour);
                }
                // Written in any case and kept when needed: a branch would be mispredicted often.
                trail_sites[trail] = neighbour;
                for (std::size_t word = 0; word < kWords; ++word) {
                    trail_words[trail * kWords + word] = set[word];
                }
                trail += static_cast<std::size_t>(is_saving & (saved[neighbour] != stamp));
                saved[neighbour] = stamp;
                Word any = 0;
                Word removed = 0;
                for (std::size_t word = 0; word < kWords; ++word) {
                    removed |= set[word] & ~allowed[word];
                    set[word] &= allowed[word];
                    any |= set[word];
                }
                // Another of the four may have been first.
                const auto is_new = static_cast<std::uint8_t>(removed != 0);
                const std::size_t end = head + length;
                queue[end < queue_size ? end : end - queue_size] = neighbour;
                length += static_cast<std::size_t>(queued[neighbour] == 0) & is_new;
                queued[neighbour] |= is_new;
                if (any == 0) [[unlikely]] {
                    state.emptied = neighbour;
                    result = Propagation::kContradiction;
                }
            }
        }
        state.queue_head = head;
        state.queue_length = length;
        state.trail_length = trail;
        return result;
    }
};

}  // namespace modelsynth
