#include "solver/continuous/problem_cache.h"

#include <algorithm>
#include <utility>

namespace modelsynth::continuous {

std::shared_ptr<const Problem> ProblemCache::find_locked(
    const ExampleReading& reading, const Parameters& parameters
) {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
        return entry.problem->reading.get() == &reading && entry.parameters == parameters;
    });
    if (found == entries_.end()) {
        return nullptr;
    }
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front().problem;
}

Result<std::shared_ptr<const Problem>> ProblemCache::find_or_make(
    const std::shared_ptr<const ExampleReading>& reading,
    const Parameters& parameters,
    const std::stop_token& stop
) {
    {
        const std::lock_guard lock(mutex_);
        if (auto known = find_locked(*reading, parameters)) {
            return known;
        }
    }
    auto made = make_problem(reading, parameters, nullptr, stop);
    if (!made) {
        return tl::unexpected(std::move(made.error()));
    }
    auto problem = std::make_shared<const Problem>(std::move(*made));
    if (problem->arrangement.vertex_count() > kVerticesKeptMax) {
        return problem;
    }
    const std::lock_guard lock(mutex_);
    if (auto known = find_locked(*reading, parameters)) {
        return known;
    }
    entries_.push_front({parameters, problem});
    if (entries_.size() > kEntriesMax) {
        entries_.pop_back();
    }
    return problem;
}

}  // namespace modelsynth::continuous
