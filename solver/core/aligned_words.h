#pragma once

#include "solver/core/label_set.h"

#include <cstddef>
#include <vector>

namespace modelsynth {

// Words in a row, zero at first, the first one at a multiple of 64 bytes: for rows that are read by
// vectors. Distinct words may be used from distinct threads.
class AlignedWords {
  public:
    AlignedWords() = default;

    explicit AlignedWords(std::size_t count) : lines_((count + kLineWords - 1) / kLineWords) {}

    [[nodiscard]] Word* data() { return lines_.data()->words; }

    [[nodiscard]] const Word* data() const { return lines_.data()->words; }

  private:
    static constexpr std::size_t kLineWords = 8;

    struct alignas(kLineWords * sizeof(Word)) CacheLine {
        Word words[kLineWords] = {};
    };

    std::vector<CacheLine> lines_;
};

}  // namespace modelsynth
