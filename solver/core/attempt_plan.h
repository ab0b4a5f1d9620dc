#pragma once

#include "solver/core/order.h"
#include "solver/core/search.h"

#include <algorithm>
#include <cstdint>

namespace modelsynth {

// How an attempt at a block goes about it.
struct AttemptPlan {
    bool is_other_order = false;
    SearchBudget budget;
};

// Attempts are numbered from 1. Odd ones keep the order asked for and may take back 8 choices, then
// 128, 512, 1000; even ones try another order, first without any. What one order never solves
// another often solves at once (blocks of the thesis's castle, 24 of 980 given up before), so the
// first attempt is not long about it; and what no order solves at once a little backtracking does
// (its Escheresque, 138 of 980).
[[nodiscard]] constexpr AttemptPlan attempt_plan(std::uint32_t attempt) {
    constexpr std::uint32_t kBacktracksMax = 1000;
    const std::uint32_t rung = std::min((attempt - 1) / 2, std::uint32_t{8});
    if (attempt % 2 == 0) {
        return {true, {rung == 0 ? 0 : std::min(kBacktracksMax, 2U << (2 * rung))}};
    }
    return {false, {rung == 0 ? 8 : std::min(kBacktracksMax, 32U << (2 * rung))}};
}

// The order of the even attempts.
[[nodiscard]] constexpr Order other_order(Order order) {
    const bool is_by_openness = order == Order::kMinEntropy || order == Order::kFewestLabels;
    return is_by_openness ? Order::kScan : Order::kMinEntropy;
}

// What RandomKey::purpose says of the streams drawn here.
inline constexpr std::uint32_t kPurposeSearch = 1;

}  // namespace modelsynth
