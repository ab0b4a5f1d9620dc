#include "solver/continuous/constraints/growth.h"

#include <algorithm>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

// RandomKey::purpose of where a connected object begins, beside kPurposeSearch.
constexpr std::uint32_t kPurposeBeginning = 2;
// For all components of a connection together: a small one is a loss where there are few.
constexpr std::uint32_t kBeginningsTried = 8;

std::vector<Label> labels_of(const GraphPart& part, std::span<const Label> model) {
    std::vector<Label> labels;
    for (const Site site : part.sites()) {
        labels.push_back(model[site]);
    }
    return labels;
}

std::size_t members_in(
    const GraphPart& part, std::span<const Label> model, const LabelSet& figures
) {
    const auto is_member = [&](Site site) { return figures.contains(model[site]); };
    return static_cast<std::size_t>(
        std::count_if(part.sites().begin(), part.sites().end(), is_member)
    );
}

}  // namespace

Growth::Growth(const Problem& problem)
    : problem_(problem),
      skeleton_(problem.arrangement),
      connections_(problem.reading->figures(), skeleton_, problem.connections) {
    for (const Connection& connection : problem.connections) {
        growing_.push_back(connection.figures);
        order_.push_back(order_.size());
    }
    // What comes once finds room before what comes many times has taken it.
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        return problem.connections[a].components < problem.connections[b].components;
    });
}

void Growth::enter(const GraphPart& part, BlockOptions& options) {
    connections_.enter(part.sites());
    options.judge = &connections_;
    options.growing = growing_;
}

BlockResult Growth::begin_something(
    BlockSearch<GraphPart>& search,
    const GraphPart& part,
    std::vector<Label>& labels,
    BlockOptions options,
    const RandomKey& key,
    std::uint32_t blocks_left,
    const std::stop_token& stop
) {
    RandomStream random({key.seed, key.block, 0, kPurposeBeginning});
    options.attempts = 1;
    for (const std::size_t i : order_) {
        if (part.sites().empty() || !is_beginning_due(i, blocks_left, random)) {
            continue;
        }
        const std::vector<Label> before = labels_of(part, labels);
        std::vector<Label> largest;
        std::size_t largest_size = 0;
        BlockResult best;
        const std::uint32_t tries =
            std::max(std::uint32_t{1}, kBeginningsTried / problem_.connections[i].components);
        for (std::uint32_t tried = 0; tried < tries; ++tried) {
            const auto count = static_cast<std::uint32_t>(part.sites().size());
            options.pin = Pin{random.below(count), &growing_[i]};
            BlockResult result = search.modify(part, labels, options, key, stop);
            if (result.outcome == BlockOutcome::kStopped) {
                return result;
            }
            if (result.outcome != BlockOutcome::kAccepted) {
                continue;
            }
            const std::size_t size = members_in(part, labels, growing_[i]);
            if (size > largest_size) {
                largest_size = size;
                largest = labels_of(part, labels);
                best = result;
            }
            put(part, before, labels);
        }
        if (largest_size > 0) {
            put(part, largest, labels);
            return best;
        }
    }
    return {};
}

std::optional<Error> Growth::find_fault() const {
    for (std::size_t i = 0; i < growing_.size(); ++i) {
        const std::uint32_t components = connections_.components(i);
        if (components > problem_.connections[i].components) {
            return Error{
                ErrorCode::kGaveUp,
                "what is to be connected was fixed apart and stayed in " +
                    std::to_string(components) + " components",
                {}};
        }
    }
    return std::nullopt;
}

bool Growth::is_beginning_due(
    std::size_t connection, std::uint32_t blocks_left, RandomStream& random
) const {
    const std::uint32_t components = problem_.connections[connection].components;
    const std::uint32_t there = connections_.components(connection);
    if (components == 1) {
        return there == 0 || (there == 1 && connections_.is_all_inside(connection));
    }
    // Spread over the blocks to come.
    return there < components && random.below(blocks_left) < components - there;
}

// Labels that stood in the part before.
void Growth::put(const GraphPart& part, std::span<const Label> before, std::vector<Label>& labels) {
    connections_.enter(part.sites());
    for (std::size_t i = 0; i < before.size(); ++i) {
        labels[part.sites()[i]] = before[i];
    }
    connections_.take_back(labels);
    connections_.enter(part.sites());
}

}  // namespace modelsynth::continuous
