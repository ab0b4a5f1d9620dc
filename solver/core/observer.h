#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/core/search_tally.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace modelsynth {

// What became of one block.
struct BlockReport {
    std::uint32_t index = 0;  // of the schedule, from 0
    std::uint32_t blocks_total = 0;
    Box region;
    bool accepted = false;
    std::uint32_t attempts = 0;
    SearchTally tally;  // so far, this one included
    // The labels of the whole model after the block, valid during the call.
    std::span<const Label> model;
};

// A synthesis in blocks as it stood after some of them: what another run with equal arguments
// goes on from, to the same end.
struct Checkpoint {
    std::uint32_t blocks_done = 0;
    SearchTally tally;
    std::vector<Label> labels;  // of the whole model
};

// Listens to a synthesis. Called on the thread that solves, in the order of the schedule; what it
// does delays the solver, so it hands on and returns. It may throw nothing.
class Observer {
  public:
    virtual ~Observer() = default;

    // What of the request cannot be had, one sentence each, as far as that is known before anything
    // is made. Once, before on_start(); not at all where there is nothing to say.
    virtual void on_warnings(std::span<const std::string> /*warnings*/) {}

    // Once, before the first block: the initial model stands, or that of the checkpoint.
    virtual void on_start(std::uint32_t blocks_total, std::span<const Label> model) = 0;

    virtual void on_block(const BlockReport& report) = 0;
};

}  // namespace modelsynth
