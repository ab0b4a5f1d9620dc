#pragma once

#include "solver/core/topology.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/problem.h"

#include <cstdint>
#include <optional>
#include <stop_token>

namespace modelsynth::discrete {

enum class Verdict : std::uint8_t {
    kImpossible,  // proved
    kPossible,    // a model was found
    kUnknown,
};

struct Judgement {
    Verdict verdict = Verdict::kUnknown;
    // Where propagation found nothing left, if it did and no constraint came into it.
    std::optional<Site> emptied = std::nullopt;
    std::uint64_t effort = 0;  // that it took, in cells looked at
};

// Whether the whole of a request has a model: by propagation, by a plain model, by a few attempts
// of the search, by CaDiCaL.
// Deterministic. kUnknown when `stop` is requested. Thread-safe.
[[nodiscard]] Judgement judge_whole(
    const Example& example, const Problem& problem, const std::stop_token& stop
);

}  // namespace modelsynth::discrete
