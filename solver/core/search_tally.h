#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace modelsynth {

// What it took to solve a block.
enum class SolvedBy : std::uint8_t {
    kFirstTry,      // the order asked for, no choice taken back
    kBacktracking,  // choices were taken back
    kOtherOrder,    // another order of sites
    kRestart,       // the same order once more, with other random numbers
    // Where every attempt at the block failed:
    kSmallerBlock,  // one or more parts of it
    kErodedBorder,  // what stands around its border changed as well
    kSat,           // the back end over CaDiCaL
};
inline constexpr std::size_t kSolvedByCount = 7;
inline constexpr std::array<const char*, kSolvedByCount> kSolvedByNames = {
    "first_try", "backtracking", "other_order", "restart", "smaller_block", "eroded_border", "sat"};

// What became of the blocks of a model so far.
struct SearchTally {
    std::array<std::uint32_t, kSolvedByCount> solved_by = {};  // blocks, by SolvedBy
    std::uint32_t reverted = 0;                                // blocks, declined ones included
    std::uint32_t declined = 0;    // blocks that were solved, but worse than what they were
    std::uint64_t backtracks = 0;  // choices taken back, in reverted blocks too

    [[nodiscard]] std::uint32_t accepted() const {
        return std::accumulate(solved_by.begin(), solved_by.end(), std::uint32_t{0});
    }

    friend bool operator==(const SearchTally&, const SearchTally&) = default;
};

}  // namespace modelsynth
