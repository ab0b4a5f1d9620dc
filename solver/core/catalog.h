#pragma once

#include "solver/core/label_set.h"
#include "solver/core/relations.h"
#include "solver/core/result.h"
#include "solver/core/topology.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth {

enum class Propagation : std::uint8_t { kConsistent, kContradiction, kStopped };

// The catalog C of the thesis (3.3.2): for every site the labels still possible there.
//
// Invariant after propagate() returned kConsistent: a label is in the catalog only if every
// neighbour still has a label that allows it (Statement 3.6), and no site is empty. The result
// does not depend on the order in which sites were narrowed. It is an outer bound of the ideal
// catalog C*: what was removed cannot be, what is left may not be (Theorem 3.3.2).
//
// kWords is the number of words of a set when it is known at compile time, 0 when it is not.
// Cost: narrow O(words); propagate O(removed labels * arcs) rows at most, no allocation once warm.
// Thread-safety: one thread at a time; topology and relations are only read.
template <Topology T, std::size_t kWords>
class Catalog {
  public:
    using Mark = std::size_t;
    using Labels = std::span<const Word, kWords == 0 ? std::dynamic_extent : kWords>;

    // Requires: topology and relations outlive the catalog.
    Catalog(const T& topology, const Relations& relations)
        : topology_(topology),
          relations_(relations),
          words_(kWords == 0 ? relations.words() : kWords),
          sets_(topology.site_count() * words_),
          queue_(topology.site_count()),
          queued_(topology.site_count()),
          saved_(topology.site_count()),
          support_(relations.count() * words_),
          supported_(words_) {
        check(words_ == relations.words(), "a catalog of another width than its relations");
        check(
            T::kRelationCount == 0 || T::kRelationCount == relations.count(),
            "a topology of other relations than given"
        );
    }

    [[nodiscard]] std::size_t site_count() const { return queued_.size(); }

    [[nodiscard]] std::size_t words() const { return kWords == 0 ? words_ : kWords; }

    [[nodiscard]] Labels labels(Site site) const {
        return Labels(sets_.data() + site * words(), words());
    }

    [[nodiscard]] std::span<const Word> all_labels() const { return sets_; }

    [[nodiscard]] bool contains(Site site, Label label) const {
        return (labels(site)[label / kWordBits] >> (label % kWordBits) & 1) != 0;
    }

    // Puts back a state taken from all_labels() of a catalog of the same shape, or any sets.
    // Nothing is queued: the state is taken to be what propagation left.
    void restore(std::span<const Word> sets) {
        std::copy(sets.begin(), sets.end(), sets_.begin());
        forget_queue();
        forget_trail();
    }

    // The catalog without knowledge: the same set at every site.
    void fill(std::span<const Word> set) {
        for (std::size_t site = 0; site < site_count(); ++site) {
            std::copy(
                set.begin(), set.end(), sets_.begin() + static_cast<std::ptrdiff_t>(site * words())
            );
        }
        forget_queue();
        forget_trail();
    }

    // Keeps only the labels of `allowed` at the site; false when none is left.
    [[nodiscard]] bool narrow(Site site, const Word* allowed) {
        Word* set = sets_.data() + site * words();
        Word removed = 0;
        for (std::size_t word = 0; word < words(); ++word) {
            removed |= set[word] & ~allowed[word];
        }
        if (removed == 0) {
            return true;
        }
        save(site);
        Word left = 0;
        for (std::size_t word = 0; word < words(); ++word) {
            set[word] &= allowed[word];
            left |= set[word];
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
        Word* set = sets_.data() + site * words();
        std::fill(set, set + words(), Word{0});
        set[label / kWordBits] = Word{1} << (label % kWordBits);
        enqueue(site);
    }

    // Takes one label away; false when none is left.
    [[nodiscard]] bool remove(Site site, Label label) {
        save(site);
        Word* set = sets_.data() + site * words();
        set[label / kWordBits] &= ~(Word{1} << (label % kWordBits));
        enqueue(site);
        if (is_empty(labels(site))) {
            emptied_ = site;
            return false;
        }
        return true;
    }

    // Every site is looked at by the next propagate(). For a state that no propagation has seen.
    void enqueue_all() {
        for (std::size_t site = 0; site < site_count(); ++site) {
            enqueue(static_cast<Site>(site));
        }
    }

    // Removes what no neighbour supports until nothing changes (Algorithms 3.2 and 3.3).
    // kContradiction: some site lost its last label; emptied_site() tells which, and the catalog
    // is good only for undo() or restore(). kStopped: `stop` was requested; likewise.
    [[nodiscard]] Propagation propagate(const std::stop_token& stop) {
        constexpr std::size_t kStopInterval = 1024;
        std::size_t looked_at = 0;
        while (queue_length_ > 0) {
            if (++looked_at % kStopInterval == 0 && stop.stop_requested()) {
                forget_queue();
                return Propagation::kStopped;
            }
            const Site site = dequeue();
            collect_support(site);
            bool consistent = true;
            topology_.for_each_arc(site, [&](Site neighbour, RelationId relation) {
                consistent = consistent && narrow(neighbour, support_.data() + relation * words());
            });
            if (!consistent) {
                forget_queue();
                return Propagation::kContradiction;
            }
        }
        return Propagation::kConsistent;
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
            const Word* set = trail_words_.data() + trail_length_ * words();
            std::copy(set, set + words(), sets_.data() + site * words());
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
    // The width of support_ when the compiler may know it: then the sums below stay in registers.
    static constexpr std::size_t kSupportWords = T::kRelationCount * kWords;
    static constexpr std::size_t kTrailStart = 64;

    // support_[r] = the labels that some label left at the site allows along relation r. Sites
    // often come one after the other with the same set; then it is there already.
    void collect_support(Site site) {
        const Word* set = sets_.data() + site * words();
        Word* known = supported_.data();
        Word difference = 0;
        for (std::size_t word = 0; word < words(); ++word) {
            difference |= set[word] ^ known[word];
            known[word] = set[word];
        }
        if (difference == 0) {
            return;
        }
        if constexpr (kSupportWords > 0) {
            std::array<Word, kSupportWords> sum = {};
            for_each_nibble(labels(site), [&](std::size_t group, std::size_t members) {
                const Word* rows = relations_.union_data(group, members, kSupportWords);
                for (std::size_t word = 0; word < kSupportWords; ++word) {
                    sum[word] |= rows[word];
                }
            });
            std::copy(sum.begin(), sum.end(), support_.begin());
        } else {
            std::fill(support_.begin(), support_.end(), Word{0});
            Word* sum = support_.data();
            const std::size_t width = support_.size();
            for_each_nibble(labels(site), [&](std::size_t group, std::size_t members) {
                const Word* rows = relations_.union_data(group, members, width);
                for (std::size_t word = 0; word < width; ++word) {
                    sum[word] |= rows[word];
                }
            });
        }
    }

    void save(Site site) {
        note_change(site);
        if (marks_ == 0 || saved_.data()[site] == stamp_) {
            return;
        }
        saved_.data()[site] = stamp_;
        if (trail_length_ == trail_sites_.size()) {
            trail_sites_.resize(2 * trail_length_ + kTrailStart);
            trail_words_.resize(trail_sites_.size() * words());
        }
        trail_sites_.data()[trail_length_] = site;
        const Word* set = sets_.data() + site * words();
        std::copy(set, set + words(), trail_words_.data() + trail_length_ * words());
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
    }

    const T& topology_;
    const Relations& relations_;
    std::size_t words_;
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
    std::vector<Word> support_;
    std::vector<Word> supported_;  // the set that support_ belongs to; empty at first, as it is
    std::vector<Site> changed_;
    bool tracking_ = false;
    Site emptied_ = 0;
};

}  // namespace modelsynth
