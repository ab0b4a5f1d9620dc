#pragma once

#include "solver/core/result.h"
#include "solver/discrete/box_search.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "solver/discrete/problem.h"

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth::discrete {

// All of a synthesis that does not depend on its seed: transitions, domains, a plain initial model,
// what propagation makes of the boundary (the fixpoint before the first choice), and the memory of
// searches that ended. Kept from request to request it changes no result, only the time.
// Thread-safe.
class Preparation {
  public:
    // Requires: defaults filled in and find_faults() empty (checked).
    // Fails:    as make_problem(); kCancelled when `stop` is requested.
    [[nodiscard]] static Result<std::shared_ptr<Preparation>> make(
        std::shared_ptr<const Example> example,
        const Parameters& parameters,
        const Origin* origin = nullptr,
        const std::stop_token& stop = {}
    );

    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    [[nodiscard]] const Example& example() const { return *example_; }

    [[nodiscard]] const Parameters& parameters() const { return parameters_; }

    [[nodiscard]] const Problem& problem() const { return problem_; }

    // See find_plain_model(); null when there is none, when the whole is made at once, when another
    // model is started from, or when it is rigid.
    [[nodiscard]] const std::shared_ptr<const std::vector<Label>>& plain_model() const {
        return plain_model_;
    }

    // A plain model that no block can change: its pieces stand beside nothing but themselves, such
    // as air in an example whose ground is not its own neighbour. It would be the result.
    [[nodiscard]] bool is_plain_model_rigid() const { return is_plain_model_rigid_; }

    // That asked for, or the one that suits the example.
    [[nodiscard]] Order order() const { return order_; }

    // A search for one thread, given back at the end.
    [[nodiscard]] std::unique_ptr<BoxSearch> take_search();
    void give_back(std::unique_ptr<BoxSearch> search);

  private:
    // Good for nothing when `stop` was requested meanwhile.
    Preparation(
        std::shared_ptr<const Example> example,
        const Parameters& parameters,
        Problem problem,
        const std::stop_token& stop
    );

    // Whether a block of that size, outside of which the plain model stands, has any choice.
    [[nodiscard]] bool can_change_middle(const GridSize& block, const std::stop_token& stop);

    // Of scan and entropy the one by which more boxes in the middle of the model succeed at once;
    // of equal ones scan, which is the faster.
    [[nodiscard]] Order choose_order(const std::stop_token& stop);

    std::shared_ptr<const Example> example_;
    Parameters parameters_;
    Problem problem_;
    std::unique_ptr<const LayeredRelations> by_kind_;  // of the problem; null: none
    std::shared_ptr<const std::vector<Label>> plain_model_;
    bool is_plain_model_rigid_ = false;
    Order order_;
    BoxSearch::Bases bases_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<BoxSearch>> searches_;
};

// The preparations of the requests that came last. Thread-safe.
class PreparationCache {
  public:
    // That of an equal request before that started from nothing, or a new one. An example is known
    // by its address.
    // Fails: as Preparation::make().
    [[nodiscard]] Result<std::shared_ptr<Preparation>> find_or_make(
        const std::shared_ptr<const Example>& example,
        const Parameters& parameters,
        const std::stop_token& stop = {}
    );

  private:
    // Four bytes a cell and what searches keep; a larger model takes long enough anyway.
    static constexpr std::size_t kCellsMax = std::size_t{1} << 20;
    static constexpr std::size_t kEntriesMax = 8;

    [[nodiscard]] std::shared_ptr<Preparation> find_locked(
        const Example& example, const Parameters& parameters
    );

    std::mutex mutex_;
    std::list<std::shared_ptr<Preparation>> entries_;  // most recently used first
};

}  // namespace modelsynth::discrete
