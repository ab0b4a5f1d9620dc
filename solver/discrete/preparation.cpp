#include "solver/discrete/preparation.h"

#include "solver/discrete/initial_model.h"

#include <algorithm>
#include <utility>

namespace modelsynth::discrete {

namespace {

// Searches of larger parts give their memory back.
constexpr std::size_t kKeptPartCellsMax = std::size_t{1} << 15;
constexpr std::size_t kKeptSearchesMax = 8;

}  // namespace

Preparation::Preparation(
    std::shared_ptr<const Example> example, const Parameters& parameters, Problem problem
)
    : example_(std::move(example)), parameters_(parameters), problem_(std::move(problem)) {
    if (const auto& blocks = *parameters_.blocks) {
        plain_model_ = find_plain_model(*example_, problem_);
        if (plain_model_ && !can_change_middle(blocks->layout.size)) {
            is_plain_model_rigid_ = true;
            plain_model_.reset();
        }
    }
}

Result<std::shared_ptr<Preparation>> Preparation::make(
    std::shared_ptr<const Example> example, const Parameters& parameters, const Origin* origin
) {
    auto problem = make_problem(*example, parameters, origin);
    if (!problem) {
        return tl::unexpected(std::move(problem.error()));
    }
    return std::shared_ptr<Preparation>(
        new Preparation(std::move(example), parameters, std::move(*problem))
    );
}

bool Preparation::can_change_middle(const GridSize& block) {
    const GridSize& size = problem_.size;
    const auto range = [](std::int32_t extent, std::int32_t length) {
        const std::int32_t cut = std::min(extent, length);
        return std::pair((extent - cut) / 2, (extent - cut) / 2 + cut);
    };
    const auto [west, east] = range(size.x, block.x);
    const auto [bottom, top] = range(size.y, block.y);
    const auto [north, south] = range(size.z, block.z);
    auto search = take_search();
    const bool can_change =
        !search->is_determined(Box{{west, bottom, north}, {east, top, south}}, *plain_model_, {});
    give_back(std::move(search));
    return can_change;
}

std::unique_ptr<BoxSearch> Preparation::take_search() {
    {
        const std::lock_guard lock(mutex_);
        if (!searches_.empty()) {
            auto search = std::move(searches_.back());
            searches_.pop_back();
            return search;
        }
    }
    return std::make_unique<BoxSearch>(problem_, &bases_);
}

void Preparation::give_back(std::unique_ptr<BoxSearch> search) {
    const std::lock_guard lock(mutex_);
    if (search->largest_part() <= kKeptPartCellsMax && searches_.size() < kKeptSearchesMax) {
        searches_.push_back(std::move(search));
    }
}

std::shared_ptr<Preparation> PreparationCache::find_locked(
    const Example& example, const Parameters& parameters
) {
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
        return &entry->example() == &example && entry->parameters() == parameters;
    });
    if (found == entries_.end()) {
        return nullptr;
    }
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front();
}

Result<std::shared_ptr<Preparation>> PreparationCache::find_or_make(
    const std::shared_ptr<const Example>& example, const Parameters& parameters
) {
    {
        const std::lock_guard lock(mutex_);
        if (auto known = find_locked(*example, parameters)) {
            return known;
        }
    }
    auto made = Preparation::make(example, parameters);
    if (!made || (*made)->problem().size.cell_count() > kCellsMax) {
        return made;
    }
    const std::lock_guard lock(mutex_);
    if (auto known = find_locked(*example, parameters)) {
        return known;
    }
    entries_.push_front(*made);
    if (entries_.size() > kEntriesMax) {
        entries_.pop_back();
    }
    return made;
}

}  // namespace modelsynth::discrete
