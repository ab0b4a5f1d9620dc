#pragma once

#include "solver/core/allowed_lists.h"
#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"
#include "solver/core/step_kernel.h"
#include "solver/core/topology.h"
#include "solver/core/vector_level.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <type_traits>
#include <vector>

namespace modelsynth {

// The catalog C of the thesis (3.3.2): for every site the labels still possible there.
//
// Invariant after propagate() returned kConsistent: a label is in the catalog only if every
// neighbour still has a label that allows it (Statement 3.6), and no site is empty. The result
// does not depend on the order in which sites were narrowed. It is an outer bound of the ideal
// catalog C*: what was removed cannot be, what is left may not be (Theorem 3.3.2).
//
// kWords is the number of words of a set when it is known at compile time, 0 when it is not. Such
// sets may be large: where few labels went from a site, it follows these instead of adding up what
// all that are left allow. Where R is RelationsOfKinds, the set of a site is of the labels of its
// kind, in the numbers that they have there.
// Cost: narrow O(words); propagate O(removed labels * arcs) rows at most, no allocation once warm.
// Thread-safety: one thread at a time; topology and relations are only read.
template <Topology T, std::size_t kWords, class R = Relations>
class Catalog {
  public:
    using Mark = std::size_t;
    using Labels = std::span<const Word, kWords == 0 ? std::dynamic_extent : kWords>;

    // Requires: topology and relations outlive the catalog.
    Catalog(const T& topology, const R& relations)
        : topology_(topology),
          relations_(relations),
          words_(kWords == 0 ? relations.words() : kWords),
          padding_(reach_of(topology) * words_),
          sets_(topology.site_count() * words_ + 2 * padding_),
          queue_(topology.site_count() + 1),
          queued_(topology.site_count()),
          saved_(topology.site_count()),
          support_(words_) {
        if constexpr (kWords == 0) {
            allowed_lists_.emplace(relations);
            seen_.resize(topology.site_count() * words_);
            unseen_.resize(topology.site_count(), 1);
        }
        if constexpr (kIsStepped && kIsKinded) {
            check(topology.has_steps_only(), "a grid in layers that closes on itself");
        }
        check(words_ == relations.words(), "a catalog of another width than its relations");
        check(
            T::kRelationCount == 0 || T::kRelationCount == relations.count(),
            "a topology of other relations than given"
        );
    }

    [[nodiscard]] std::size_t site_count() const { return queued_.size(); }

    [[nodiscard]] std::size_t words() const { return kWords == 0 ? words_ : kWords; }

    [[nodiscard]] Labels labels(Site site) const { return Labels(set(site), words()); }

    [[nodiscard]] std::span<const Word> all_labels() const {
        return {set(0), site_count() * words()};
    }

    [[nodiscard]] bool contains(Site site, Label label) const { return is_in(set(site), label); }

    // Puts back a state taken from all_labels() of a catalog of the same shape, or any sets.
    // Nothing is queued: the state is taken to be what propagation left. No marks are left, and
    // changes are no longer tracked.
    void restore(std::span<const Word> sets) {
        std::copy(sets.begin(), sets.end(), set(0));
        see_all();
        forget_queue();
        forget_trail();
    }

    // The catalog without knowledge: the same set at every site.
    void fill(std::span<const Word> same) {
        for (std::size_t site = 0; site < site_count(); ++site) {
            std::copy(same.begin(), same.end(), set(static_cast<Site>(site)));
        }
        see_all();
        forget_queue();
        forget_trail();
    }

    // Keeps only the labels of `allowed` at the site; false when none is left.
    [[nodiscard]] bool narrow(Site site, const Word* allowed) {
        Word* const own = set(site);
        Word removed = 0;
        for (std::size_t word = 0; word < words(); ++word) {
            removed |= own[word] & ~allowed[word];
        }
        if (removed == 0) {
            return true;
        }
        save(site);
        Word left = 0;
        for (std::size_t word = 0; word < words(); ++word) {
            own[word] &= allowed[word];
            left |= own[word];
        }
        enqueue(site);
        if (left == 0) {
            emptied_ = site;
        }
        return left != 0;
    }

    // Leaves one label at the site (Statement 3.7).
    // Requires: the label is in the catalog there (checked).
    void assign(Site site, Label label) {
        check(contains(site, label), "a label that is not in the catalog was assigned");
        save(site);
        Word* const own = set(site);
        std::fill(own, own + words(), Word{0});
        own[label / kWordBits] = Word{1} << (label % kWordBits);
        enqueue(site);
    }

    // Takes one label away; false when none is left.
    [[nodiscard]] bool remove(Site site, Label label) {
        save(site);
        set(site)[label / kWordBits] &= ~(Word{1} << (label % kWordBits));
        enqueue(site);
        if (is_empty(labels(site))) {
            emptied_ = site;
            return false;
        }
        return true;
    }

    // Every site is looked at by the next propagate(). For a state that no propagation has seen.
    void enqueue_all() {
        std::fill(unseen_.begin(), unseen_.end(), std::uint8_t{1});
        for (std::size_t site = 0; site < site_count(); ++site) {
            enqueue(static_cast<Site>(site));
        }
    }

    // Removes what no neighbour supports until nothing changes (Algorithms 3.2 and 3.3).
    // kContradiction: some site lost its last label; emptied_site() tells which, and the catalog
    // is good only for undo() or restore(). kStopped: `stop` was requested; likewise.
    [[nodiscard]] Propagation propagate(const std::stop_token& stop) {
        Propagation result = Propagation::kConsistent;
        if constexpr (kIsStepped && kIsKinded) {
            result = propagate_by_steps(stop);
        } else if constexpr (kIsKinded) {
            result = propagate_by_kinds(stop);
        } else if constexpr (kIsStepped) {
            result =
                topology_.has_steps_only() ? propagate_by_steps(stop) : propagate_by_arcs(stop);
        } else {
            result = propagate_by_arcs(stop);
        }
        if (result != Propagation::kConsistent) {
            forget_queue();
        }
        return result;
    }

    // The site that lost its last label in the last contradiction.
    [[nodiscard]] Site emptied_site() const { return emptied_; }

    // From mark() on, changes are kept on a trail so that undo(mark) can take them back. Marks
    // nest; undo of an outer mark undoes the inner ones.
    [[nodiscard]] Mark mark() {
        ++marks_;
        ++stamp_;
        return trail_length_;
    }

    void undo(Mark mark) {
        while (trail_length_ > mark) {
            --trail_length_;
            const Site site = trail_sites_[trail_length_];
            const Word* old = trail_words_.data() + trail_length_ * words();
            std::copy(old, old + words(), set(site));
            if constexpr (kWords == 0) {
                see(site);
            }
            note_change(site);
        }
        forget_queue();
        release();
    }

    // Keeps the changes since the innermost mark, for good when it was the outermost.
    void keep() { release(); }

    // From now on the sites that change are listed in changed(), some more than once, undone
    // changes too, until clear_changed().
    void track_changes() { tracking_ = true; }

    [[nodiscard]] std::span<const Site> changed() const { return changed_; }

    void clear_changed() { changed_.clear(); }

  private:
    static constexpr bool kIsStepped = kWords > 0 && SteppedTopology<T>;
    static constexpr bool kIsKinded = !std::is_same_v<R, Relations>;
    static constexpr std::size_t kTrailStart = 64;
    // About as many words of rows are added up in the time that it takes to follow a pair.
    static constexpr std::size_t kWordsPerPair = 24;

    static std::size_t reach_of(const T& topology) {
        if constexpr (kIsStepped) {
            return topology.reach();
        } else {
            return 0;
        }
    }

    static bool is_in(const Word* set, Label label) {
        return (set[label / kWordBits] >> (label % kWordBits) & 1) != 0;
    }

    [[nodiscard]] Word* set(Site site) { return sets_.data() + padding_ + site * words(); }

    [[nodiscard]] const Word* set(Site site) const {
        return sets_.data() + padding_ + site * words();
    }

    Propagation propagate_by_steps(const std::stop_token& stop) requires kIsStepped {
        reserve_trail(trail_length_ + site_count() + 1);
        StepState<T::kRelationCount> state;
        state.sets = set(0);
        state.steps = topology_.steps();
        state.arcs = topology_.arc_masks();
        if constexpr (kIsKinded) {
            state.kinds = relations_.kinds();
            state.tables = relations_.by_kind().tables();
        } else {
            state.unions = relations_.union_data(0, 0);
        }
        state.queue = queue_.data();
        state.queue_size = queue_.size();
        state.queue_head = queue_head_;
        state.queue_length = queue_length_;
        state.queued = queued_.data();
        state.is_saving = marks_ > 0;
        state.stamp = stamp_;
        state.saved = saved_.data();
        state.trail_sites = trail_sites_.data();
        state.trail_words = trail_words_.data();
        state.trail_length = trail_length_;
        state.changed = tracking_ ? &changed_ : nullptr;
        state.emptied = emptied_;
        const Propagation result =
            StepKernel<T::kRelationCount, kWords, kIsKinded>::run(state, stop, vector_level_);
        queue_head_ = state.queue_head;
        queue_length_ = state.queue_length;
        trail_length_ = state.trail_length;
        emptied_ = state.emptied;
        return result;
    }

    Propagation propagate_by_arcs(const std::stop_token& stop) {
        constexpr std::size_t kStopInterval = 1024;
        std::size_t looked_at = 0;
        while (queue_length_ > 0) {
            if (++looked_at % kStopInterval == 0 && stop.stop_requested()) {
                return Propagation::kStopped;
            }
            const Site site = dequeue();
            bool consistent = true;
            if (find_few_removed(site)) {
                consistent = follow_removed(site);
            } else {
                find_rows(site);
                topology_.for_each_arc(site, [&](Site neighbour, RelationId relation) {
                    consistent = consistent && narrow(neighbour, support_along(relation));
                });
            }
            if (!consistent) {
                return Propagation::kContradiction;
            }
        }
        return Propagation::kConsistent;
    }

    Propagation propagate_by_kinds(const std::stop_token& stop) requires(kIsKinded&& kWords > 0) {
        constexpr std::size_t kStopInterval = 1024;
        constexpr std::size_t kBits = 4;  // of the groups in KindRelations
        const auto& by_kind = relations_.by_kind();
        const std::uint8_t* const kinds = relations_.kinds();
        std::array<const Word*, kWords * kWordBits / kBits> rows;
        std::array<Word, kWords> support = {};
        std::size_t looked_at = 0;
        while (queue_length_ > 0) {
            if (++looked_at % kStopInterval == 0 && stop.stop_requested()) {
                return Propagation::kStopped;
            }
            const Site site = dequeue();
            const auto& table = by_kind.table(kinds[site]);
            std::size_t count = 0;
            for_each_group<kBits>(labels(site), [&](std::size_t group, std::size_t members) {
                rows[count++] = table.unions + (group << kBits | members) * table.stride;
            });
            bool consistent = true;
            topology_.for_each_arc(site, [&](Site neighbour, RelationId relation) {
                if (!consistent) {
                    return;
                }
                const std::uint8_t far = kinds[neighbour];
                const std::size_t first = table.firsts[by_kind.place(relation, far)];
                const auto look = [&]<std::size_t kWidth>() {
                    std::array<Word, kWidth> sum = {};
                    for (std::size_t row = 0; row < count; ++row) {
                        for (std::size_t word = 0; word < kWidth; ++word) {
                            sum[word] |= rows[row][first + word];
                        }
                    }
                    // Words behind those of the far kind are of other rows, and sets there have no
                    // labels in them.
                    const Word* const own = set(neighbour);
                    Word removed = 0;
                    for (std::size_t word = 0; word < kWidth; ++word) {
                        removed |= own[word] & ~sum[word];
                    }
                    if (removed != 0) {
                        support.fill(0);
                        std::copy(sum.begin(), sum.end(), support.begin());
                        consistent = narrow(neighbour, support.data());
                    }
                };
                if constexpr (kWords > 1) {
                    if (by_kind.words_of(far) == 1) {
                        look.template operator()<1>();
                        return;
                    }
                }
                look.template operator()<kWords>();
            });
            if (!consistent) {
                return Propagation::kContradiction;
            }
        }
        return Propagation::kConsistent;
    }

    // Of a site as it was when its neighbours last heard of it.
    void see(Site site) requires(kWords == 0) {
        const Word* const own = set(site);
        std::copy(own, own + words(), seen_.data() + site * words());
    }

    void see_all() {
        if constexpr (kWords == 0) {
            std::copy(set(0), set(0) + site_count() * words(), seen_.data());
            std::fill(unseen_.begin(), unseen_.end(), std::uint8_t{0});
        }
    }

    // Puts what went from the site since then into removed_; false when that is so much that it is
    // not worth following, or not known.
    bool find_few_removed(Site site) {
        if constexpr (kWords > 0) {
            return false;
        } else {
            const bool is_known = unseen_[site] == 0 && !allowed_lists_->is_dense();
            unseen_[site] = 0;
            const Word* const own = set(site);
            Word* const seen = seen_.data() + site * words();
            removed_.resize(words());
            for (std::size_t word = 0; word < words(); ++word) {
                removed_[word] = seen[word] & ~own[word];
                seen[word] = own[word];
            }
            return is_known &&
                   count_labels(removed_) * allowed_lists_->pairs_per_label() * kWordsPerPair <
                       count_nibbles(labels(site)) * relations_.stride();
        }
    }

    // How many aligned groups of four labels have any in the set.
    static std::size_t count_nibbles(Labels labels) {
        constexpr Word kFirstOfEach = 0x1111'1111'1111'1111;
        std::size_t count = 0;
        for (const Word word : labels) {
            const Word pairs = word | word >> 1;
            count += static_cast<std::size_t>(std::popcount((pairs | pairs >> 2) & kFirstOfEach));
        }
        return count;
    }

    // Takes from the neighbours what only labels of removed_ allowed.
    bool follow_removed(Site site) {
        bool consistent = true;
        topology_.for_each_arc(site, [&](Site neighbour, RelationId relation) {
            if (!consistent) {
                return;
            }
            bool changes = false;
            for_each_label(removed_, [&](Label gone) {
                for (const Label label : allowed_lists_->allowed(relation, gone)) {
                    if (is_in(set(neighbour), label) && !is_supported(label, relation, site)) {
                        if (!changes) {
                            save(neighbour);
                            enqueue(neighbour);
                            changes = true;
                        }
                        set(neighbour)[label / kWordBits] &= ~(Word{1} << (label % kWordBits));
                    }
                }
            });
            if (changes && is_empty(labels(neighbour))) {
                emptied_ = neighbour;
                consistent = false;
            }
        });
        return consistent;
    }

    // Whether a label left at `site` allows this one at its neighbour along the relation.
    bool is_supported(Label label, RelationId relation, Site site) const {
        for (const Label other : allowed_lists_->allowed(relations_.reverse(relation), label)) {
            if (is_in(set(site), other)) {
                return true;
            }
        }
        return false;
    }

    // The rows of what is left at the site. A site of many kinds of arcs has only a few of them, so
    // rows are added up arc by arc.
    void find_rows(Site site) {
        rows_.clear();
        const auto add = [&](std::size_t group, std::size_t members) {
            rows_.push_back(relations_.union_data(group, members));
        };
        if (relations_.group_bits() == 8) {
            for_each_group<8>(labels(site), add);
        } else {
            for_each_group<4>(labels(site), add);
        }
    }

    // The labels that some label left at that site allows along the relation.
    const Word* support_along(RelationId relation) {
        constexpr std::size_t kChunk = 4;
        const std::size_t first = relation * words();
        std::size_t word = 0;
        for (; word + kChunk <= words(); word += kChunk) {
            add_up_rows<kChunk>(first + word, support_.data() + word);
        }
        for (; word < words(); ++word) {
            add_up_rows<1>(first + word, support_.data() + word);
        }
        return support_.data();
    }

    // So many words of all rows, from one of them on: in registers, which memory is no match for.
    template <std::size_t kCount>
    void add_up_rows(std::size_t first, Word* sums) const {
        std::array<Word, kCount> sum = {};
        for (const Word* row : rows_) {
            for (std::size_t word = 0; word < kCount; ++word) {
                sum[word] |= row[first + word];
            }
        }
        std::copy(sum.begin(), sum.end(), sums);
    }

    void reserve_trail(std::size_t length) {
        if (length > trail_sites_.size()) {
            trail_sites_.resize(length);
            trail_words_.resize(length * words());
        }
    }

    void save(Site site) {
        note_change(site);
        if (marks_ == 0 || saved_.data()[site] == stamp_) {
            return;
        }
        saved_.data()[site] = stamp_;
        if (trail_length_ == trail_sites_.size()) {
            reserve_trail(2 * trail_length_ + kTrailStart);
        }
        trail_sites_.data()[trail_length_] = site;
        const Word* const own = set(site);
        std::copy(own, own + words(), trail_words_.data() + trail_length_ * words());
        ++trail_length_;
    }

    // The queue is a ring: a site is in it once at most, so it never overflows.
    void enqueue(Site site) {
        if (queued_.data()[site] == 0) {
            queued_.data()[site] = 1;
            const std::size_t end = queue_head_ + queue_length_++;
            queue_.data()[end < queue_.size() ? end : end - queue_.size()] = site;
        }
    }

    Site dequeue() {
        const Site site = queue_.data()[queue_head_];
        queue_head_ = queue_head_ + 1 < queue_.size() ? queue_head_ + 1 : 0;
        --queue_length_;
        queued_.data()[site] = 0;
        return site;
    }

    void note_change(Site site) {
        if (tracking_) {
            changed_.push_back(site);
        }
    }

    void forget_queue() {
        while (queue_length_ > 0) {
            dequeue();
        }
    }

    void release() {
        check(marks_ > 0, "a mark was released twice");
        ++stamp_;  // what an outer mark has not saved yet is saved anew
        if (--marks_ == 0) {
            trail_length_ = 0;
        }
    }

    void forget_trail() {
        marks_ = 0;
        trail_length_ = 0;
        tracking_ = false;
    }

    const T& topology_;
    const R& relations_;
    std::size_t words_;
    std::size_t padding_;  // words before the first set and after the last; see StepState
    std::vector<Word> sets_;
    std::vector<Site> queue_;
    std::size_t queue_head_ = 0;
    std::size_t queue_length_ = 0;
    std::vector<std::uint8_t> queued_;
    std::vector<Site> trail_sites_;  // the first trail_length_ are in use; so of their words
    std::vector<Word> trail_words_;
    std::size_t trail_length_ = 0;
    std::vector<std::uint64_t> saved_;  // the stamp under which the site is on the trail
    std::uint64_t stamp_ = 0;
    std::size_t marks_ = 0;
    std::vector<Word> support_;      // along one relation
    std::vector<const Word*> rows_;  // of one site's labels
    // For sets of any width, which may be large; see find_few_removed().
    std::optional<AllowedLists> allowed_lists_;
    std::vector<Word> seen_;
    std::vector<std::uint8_t> unseen_;  // sites whose neighbours have not heard of them at all
    std::vector<Word> removed_;
    std::vector<Site> changed_;
    bool tracking_ = false;
    Site emptied_ = 0;
    VectorLevel vector_level_ = vector_level();
};

}  // namespace modelsynth
