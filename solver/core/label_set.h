#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// A label names what may stand at a site: a model piece of a grid, a vertex figure, ... Labels of
// one problem are numbered 0 ... label_count-1.
using Label = std::uint16_t;

// The most labels one problem may have; the last value is kept free to mean "none".
inline constexpr std::size_t kLabelCountMax = 65535;
inline constexpr Label kNoLabel = 65535;

// Sets of labels are rows of 64-bit words, label l at bit l % 64 of word l / 64. Bits past the
// last label are zero. The catalog keeps its sets in one flat array and works on such rows. The
// functions on them take any range of words, spans of a width known at compile time above all.
using Word = std::uint64_t;
inline constexpr std::size_t kWordBits = 64;

constexpr std::size_t words_for(std::size_t label_count) {
    return (label_count + kWordBits - 1) / kWordBits;
}

// Calls visit(Label) for every label of the set, in rising order.
template <class Set, class Visit>
constexpr void for_each_label(const Set& set, Visit visit) {
    for (std::size_t word = 0; word < set.size(); ++word) {
        for (Word bits = set[word]; bits != 0; bits &= bits - 1) {
            visit(static_cast<Label>(
                word * kWordBits + static_cast<std::size_t>(std::countr_zero(bits))
            ));
        }
    }
}

// Calls visit(group, members) for every aligned group of kBits labels that has any in the set:
// label kBits * group + i at bit i of members. In rising order.
template <std::size_t kBits, class Set, class Visit>
constexpr void for_each_group(const Set& set, Visit visit) {
    static_assert(kWordBits % kBits == 0 && kBits < kWordBits);
    constexpr Word kMembers = (Word{1} << kBits) - 1;
    for (std::size_t word = 0; word < set.size(); ++word) {
        for (Word bits = set[word]; bits != 0;) {
            const auto group = static_cast<std::size_t>(std::countr_zero(bits)) / kBits;
            visit(
                word * (kWordBits / kBits) + group,
                static_cast<std::size_t>(bits >> group * kBits & kMembers)
            );
            bits &= ~(kMembers << group * kBits);
        }
    }
}

template <class Set>
constexpr std::size_t count_labels(const Set& set) {
    std::size_t count = 0;
    for (const Word word : set) {
        count += static_cast<std::size_t>(std::popcount(word));
    }
    return count;
}

// Whether the set has at least two labels; cheaper than counting.
template <class Set>
constexpr bool has_several(const Set& set) {
    bool any = false;
    for (const Word word : set) {
        if (word == 0) {
            continue;
        }
        if (any || (word & (word - 1)) != 0) {
            return true;
        }
        any = true;
    }
    return false;
}

template <class Set>
constexpr bool is_empty(const Set& set) {
    for (const Word word : set) {
        if (word != 0) {
            return false;
        }
    }
    return true;
}

// Of a set that is not empty.
template <class Set>
constexpr Label first_label(const Set& set) {
    std::size_t word = 0;
    while (set[word] == 0) {
        ++word;
    }
    return static_cast<Label>(
        word * kWordBits + static_cast<std::size_t>(std::countr_zero(set[word]))
    );
}

// A set that owns its words: for boundaries, constraints and whatever is not in a hot loop.
// A value; distinct objects may be used from distinct threads.
class LabelSet {
  public:
    LabelSet() = default;

    explicit LabelSet(std::size_t label_count)
        : label_count_(label_count), words_(words_for(label_count)) {}

    static LabelSet all(std::size_t label_count) {
        LabelSet set(label_count);
        for (std::size_t label = 0; label < label_count; ++label) {
            set.insert(static_cast<Label>(label));
        }
        return set;
    }

    void insert(Label label) { words_[label / kWordBits] |= Word{1} << (label % kWordBits); }

    // Those of a row of words(). Requires: as many words as there are here.
    void insert(std::span<const Word> labels) {
        for (std::size_t word = 0; word < words_.size(); ++word) {
            words_[word] |= labels[word];
        }
    }

    void erase(Label label) { words_[label / kWordBits] &= ~(Word{1} << (label % kWordBits)); }

    [[nodiscard]] bool contains(Label label) const {
        return label < label_count_ &&
               ((words_[label / kWordBits] >> (label % kWordBits)) & 1) != 0;
    }

    [[nodiscard]] bool empty() const { return is_empty(words_); }

    [[nodiscard]] std::size_t count() const { return count_labels(words_); }

    [[nodiscard]] std::size_t label_count() const { return label_count_; }

    [[nodiscard]] std::span<const Word> words() const { return words_; }

    LabelSet& operator&=(const LabelSet& other) {
        for (std::size_t word = 0; word < words_.size(); ++word) {
            words_[word] &= other.words_[word];
        }
        return *this;
    }

    LabelSet& operator|=(const LabelSet& other) {
        for (std::size_t word = 0; word < words_.size(); ++word) {
            words_[word] |= other.words_[word];
        }
        return *this;
    }

    friend bool operator==(const LabelSet&, const LabelSet&) = default;

  private:
    std::size_t label_count_ = 0;
    std::vector<Word> words_;
};

}  // namespace modelsynth
