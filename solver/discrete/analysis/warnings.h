#pragma once

#include "solver/core/label_set.h"
#include "solver/discrete/analysis/label_facts.h"
#include "solver/discrete/example.h"

#include <cstdint>
#include <string>
#include <vector>

namespace modelsynth::discrete {

enum class WarningCode : std::uint8_t {
    kNothingFits,  // the boundary leaves no model of the size
    kNeverStands,  // labels that are never used
    kUnreachable,  // labels that the boundary leaves no place
    kStandsOnce,   // labels with one cell in the example
    kForcesCopy,   // a label that copies a part of the example; labels: it first, then the part's
    kNothingRepeats,  // no label is next to itself along every axis
    kNoPlainModel,    // the first model has to be searched for
};

struct Warning {
    WarningCode code = WarningCode::kNothingFits;
    std::string message;  // one sentence for a person, that names pieces
    std::vector<Label> labels;
};

// "stands_once", ...: the code for a program to branch on.
[[nodiscard]] const char* name_of(WarningCode code);

// What a person who made the example should know, in the order of the codes; those who copy most
// first. Nothing that is as it should be is told.
// Requires: facts of this example (checked by their size). Cost: O(labels^2). Thread-safe.
[[nodiscard]] std::vector<Warning> list_warnings(const Example& example, const LabelFacts& facts);

}  // namespace modelsynth::discrete
