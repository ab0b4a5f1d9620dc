#include "solver/continuous/problem_cache.h"

#include <algorithm>
#include <utility>

namespace modelsynth::continuous {

std::shared_ptr<const Problem> ProblemCache::find_locked(
    const ExampleReading& reading, const Parameters& parameters
) {
    std::erase_if(entries_, [](const Entry& entry) { return entry.problem.expired(); });
    for (auto at = entries_.begin(); at != entries_.end(); ++at) {
        auto problem = at->problem.lock();
        if (problem && problem->reading.get() == &reading && at->parameters == parameters) {
            entries_.splice(entries_.begin(), entries_, at);
            return problem;
        }
    }
    return nullptr;
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
    const bool is_kept = problem->arrangement.vertex_count() <= kVerticesKeptMax;
    const std::lock_guard lock(mutex_);
    if (auto known = find_locked(*reading, parameters)) {
        return known;
    }
    entries_.push_front({parameters, problem, is_kept ? problem : nullptr});
    if (entries_.size() > kEntriesMax) {
        entries_.pop_back();
    }
    return problem;
}

}  // namespace modelsynth::continuous
