#include "solver/core/label_weights.h"

#include "solver/core/result.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace modelsynth {

namespace {

constexpr std::size_t kLogTableBits = 10;

// log2(1 + i / 2^10) in units of 2^-16: bit by bit, by squaring. The library's log2 may round
// differently from machine to machine; this cannot.
constexpr std::array<std::uint32_t, (1U << kLogTableBits) + 1> make_log_table() {
    std::array<std::uint32_t, (1U << kLogTableBits) + 1> table = {};
    for (std::uint64_t i = 0; i < table.size() - 1; ++i) {
        std::uint64_t mantissa = (std::uint64_t{1} << 31) + (i << (31 - kLogTableBits));
        std::uint32_t log = 0;
        for (int bit = 0; bit < 16; ++bit) {
            mantissa = (mantissa * mantissa) >> 31;
            log <<= 1;
            if (mantissa >> 32 != 0) {
                mantissa >>= 1;
                log |= 1;
            }
        }
        table[i] = log;
    }
    table.back() = 1U << 16;
    return table;
}

constexpr auto kLogTable = make_log_table();

// Of labels that are drawn alike.
std::uint32_t entropy_of_equals(std::uint64_t count) {
    return fixed_log2(std::max<std::uint64_t>(1, count));
}

// Of labels whose weights, and these times their logarithms, come to the sums given.
std::uint32_t entropy_of(std::uint64_t weights, std::uint64_t logs) {
    const std::uint64_t mean = logs / weights;
    const std::uint64_t whole = fixed_log2(weights);
    return static_cast<std::uint32_t>(whole > mean ? whole - mean : 0);
}

}  // namespace

std::uint32_t fixed_log2(std::uint64_t value) {
    const auto exponent = static_cast<std::uint32_t>(std::bit_width(value) - 1);
    const std::uint64_t mantissa = value << (63 - exponent) << 1;  // the bits after the first one
    const std::uint64_t index = mantissa >> (64 - kLogTableBits);
    const std::uint64_t rest = (mantissa >> (64 - kLogTableBits - 16)) & 0xFFFF;
    const std::uint64_t low = kLogTable[index];
    const std::uint64_t high = kLogTable[index + 1];
    return (exponent << 16) + static_cast<std::uint32_t>(low + ((high - low) * rest >> 16));
}

LabelWeights::LabelWeights(std::span<const double> weights)
    : weights_(weights.size()), weighted_logs_(weights.size()) {
    double largest = 0;
    for (const double weight : weights) {
        check(std::isfinite(weight) && weight >= 0, "a weight that is negative or not a number");
        largest = std::max(largest, weight);
    }
    for (std::size_t label = 0; label < weights.size(); ++label) {
        if (weights[label] > 0) {
            const double scaled = weights[label] / largest * kLargest;
            weights_[label] = std::max(1U, static_cast<std::uint32_t>(scaled));
            weighted_logs_[label] = std::uint64_t{weights_[label]} * fixed_log2(weights_[label]);
        }
    }
    find_equal();
}

LabelWeights LabelWeights::of_labels(std::span<const Label> labels) const {
    LabelWeights result;
    for (const Label label : labels) {
        result.weights_.push_back(weights_[label]);
        result.weighted_logs_.push_back(weighted_logs_[label]);
    }
    result.find_equal();
    return result;
}

void LabelWeights::find_equal() {
    if (!weights_.empty() && std::count(weights_.begin(), weights_.end(), weights_.front()) ==
                                 static_cast<std::ptrdiff_t>(weights_.size())) {
        for (std::uint64_t count = 0; count <= weights_.size(); ++count) {
            const std::uint64_t total = count * weights_.front();
            entropy_of_count_.push_back(
                total == 0 ? entropy_of_equals(count)
                           : entropy_of(total, count * weighted_logs_.front())
            );
        }
    }
}

Label LabelWeights::draw(std::span<const Word> set, RandomStream& random) const {
    std::uint64_t total = 0;
    Label last = kNoLabel;
    for_each_label(set, [&](Label label) {
        total += weights_[label];
        last = label;
    });
    check(last != kNoLabel, "a label was drawn from the empty set");
    Label drawn = last;
    if (total == 0) {
        std::uint32_t skip = random.below(static_cast<std::uint32_t>(count_labels(set)));
        for_each_label(set, [&](Label label) { drawn = skip-- == 0 ? label : drawn; });
        return drawn;
    }
    std::uint64_t left = random.below_wide(total);
    bool found = false;
    for_each_label(set, [&](Label label) {
        if (!found && left < weights_[label]) {
            drawn = label;
            found = true;
        }
        left -= found ? 0 : weights_[label];
    });
    return drawn;
}

std::uint32_t LabelWeights::entropy(std::span<const Word> set) const {
    if (!entropy_of_count_.empty()) {
        return entropy_of_count_[count_labels(set)];
    }
    const Sums sums = add_up(set);
    return sums.weights == 0 ? entropy_of_equals(count_labels(set))
                             : entropy_of(sums.weights, sums.logs);
}

void LabelWeights::add_up_groups() {
    if (!entropy_of_count_.empty()) {
        return;
    }
    constexpr std::size_t kSubsets = std::size_t{1} << kGroupBits;
    group_sums_.resize(words_for(weights_.size()) * (kWordBits / kGroupBits) * kSubsets);
    for (std::size_t i = 0; i < group_sums_.size(); ++i) {
        const std::size_t members = i % kSubsets;
        const std::size_t last = i / kSubsets * kGroupBits + std::bit_width(members) - 1;
        if (members == 0 || last >= weights_.size()) {
            continue;  // no set has labels past the last one
        }
        const Sums& others = group_sums_[i ^ std::bit_floor(members)];
        group_sums_[i] = {others.weights + weights_[last], others.logs + weighted_logs_[last]};
    }
}

LabelWeights::Sums LabelWeights::add_up(std::span<const Word> set) const {
    Sums sums;
    if (!group_sums_.empty()) {
        constexpr std::size_t kGroups = kWordBits / kGroupBits;  // of a word
        constexpr Word kMembers = (Word{1} << kGroupBits) - 1;
        const Sums* subsets = group_sums_.data();
        // A set of more words than there are labels for has none in them.
        for (const Word word : set.first(std::min(set.size(), words_for(weights_.size())))) {
            // Looking up empty groups too is cheaper than to mispredict how many there are.
            for (std::size_t group = 0; group < kGroups; ++group) {
                const Sums& part = subsets[word >> group * kGroupBits & kMembers];
                sums.weights += part.weights;
                sums.logs += part.logs;
                subsets += std::size_t{1} << kGroupBits;
            }
        }
        return sums;
    }
    for_each_label(set, [&](Label label) {
        sums.weights += weights_[label];
        sums.logs += weighted_logs_[label];
    });
    return sums;
}

}  // namespace modelsynth
