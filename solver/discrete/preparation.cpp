#include "solver/discrete/preparation.h"

#include "solver/discrete/explanation/explain.h"
#include "solver/discrete/initial_model.h"
#include "solver/discrete/search_keys.h"

#include <algorithm>
#include <utility>

namespace modelsynth::discrete {

namespace {

// Searches of larger parts give their memory back.
constexpr std::size_t kKeptPartCellsMax = std::size_t{1} << 15;
constexpr std::size_t kKeptSearchesMax = 8;

// How an order is chosen: by so many searches, of boxes of this size where there are no blocks.
constexpr std::uint32_t kProbes = 8;
constexpr GridSize kProbeSize = {16, 16, 16};

// Where boxes are searched by relations and weights alone, and not from a model whose labels may
// stand where no new one could.
std::unique_ptr<const LayeredRelations> layers_of(const Problem& problem) {
    const bool is_open = !problem.periodic.x && !problem.periodic.y && !problem.periodic.z;
    if (!is_open || problem.symmetries != nullptr || problem.start) {
        return nullptr;
    }
    return LayeredRelations::make(
        problem.relations, problem.domains, problem.weights, problem.size
    );
}

}  // namespace

Preparation::Preparation(
    std::shared_ptr<const Example> example,
    const Parameters& parameters,
    Problem problem,
    const std::stop_token& stop
)
    : example_(std::move(example)),
      parameters_(parameters),
      problem_(std::move(problem)),
      by_kind_(layers_of(problem_)),
      order_(parameters.order.order) {
    if (const auto& blocks = *parameters_.blocks) {
        if (auto plain = find_plain_model(*example_, problem_)) {
            plain_model_ = std::make_shared<const std::vector<Label>>(std::move(*plain));
            if (!can_change_middle(blocks->layout.size, stop)) {
                is_plain_model_rigid_ = true;
                plain_model_.reset();
            }
        }
    }
    if (parameters_.order.is_chosen_for_it) {
        order_ = choose_order(stop);
    }
}

Result<std::shared_ptr<Preparation>> Preparation::make(
    std::shared_ptr<const Example> example,
    const Parameters& parameters,
    const Origin* origin,
    const std::stop_token& stop
) {
    auto problem = make_problem(*example, parameters, origin);
    if (!problem && problem.error().code == ErrorCode::kContradiction) {
        const auto impossible = read_problem(*example, parameters, origin);
        return tl::unexpected(
            explain(std::move(problem.error()), *example, parameters, *impossible, stop)
        );
    }
    if (!problem) {
        return tl::unexpected(std::move(problem.error()));
    }
    std::shared_ptr<Preparation> made(
        new Preparation(std::move(example), parameters, std::move(*problem), stop)
    );
    if (stop.stop_requested()) {
        return tl::unexpected(cancelled());
    }
    return made;
}

bool Preparation::can_change_middle(const GridSize& block, const std::stop_token& stop) {
    auto search = take_search();
    const bool can_change =
        !search->is_determined(Box::middle(problem_.size, block), *plain_model_, stop);
    give_back(std::move(search));
    return can_change;
}

Order Preparation::choose_order(const std::stop_token& stop) {
    const auto& blocks = *parameters_.blocks;
    const Box box = Box::middle(problem_.size, blocks ? blocks->layout.size : kProbeSize);
    auto search = take_search();
    // What stands around the box is not known yet, so nothing is asked of it; what a trial leaves
    // in the box says nothing to the next one.
    std::vector<Label> model(problem_.size.cell_count(), kNoLabel);
    const auto successes = [&](Order order) {
        std::uint32_t count = 0;
        for (std::uint32_t probe = 0; probe < kProbes; ++probe) {
            const auto result =
                search->modify(box, model, {1, order}, {0, kProbeKeys + probe, 0, 0}, stop);
            count += result.outcome == BlockOutcome::kAccepted && result.backtracks == 0 ? 1U : 0U;
        }
        return count;
    };
    const std::uint32_t by_scan = successes(Order::kScan);
    const bool is_scan_best = by_scan == kProbes || by_scan >= successes(Order::kMinEntropy);
    give_back(std::move(search));
    return is_scan_best ? Order::kScan : Order::kMinEntropy;
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
    return std::make_unique<BoxSearch>(problem_, &bases_, by_kind_.get());
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
    const std::shared_ptr<const Example>& example,
    const Parameters& parameters,
    const std::stop_token& stop
) {
    {
        const std::lock_guard lock(mutex_);
        if (auto known = find_locked(*example, parameters)) {
            return known;
        }
    }
    auto made = Preparation::make(example, parameters, nullptr, stop);
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
