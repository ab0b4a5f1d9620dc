#include "solver/discrete/analysis/success_curve.h"

#include "solver/core/catalog.h"
#include "solver/core/grid_topology.h"
#include "solver/core/random.h"
#include "solver/core/search.h"
#include "solver/core/site_order.h"
#include "solver/discrete/problem.h"
#include "solver/discrete/scan_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace modelsynth::discrete {

namespace {

// What RandomKey::purpose says of the streams drawn here.
constexpr std::uint32_t kPurposeSuccess = 3;

// Runs for one size, with label sets of kWords words; 0: of any number.
template <std::size_t kWords>
class Runs {
  public:
    Runs(const Problem& problem, Order order, const std::stop_token& stop)
        : problem_(problem),
          order_(order),
          stop_(stop),
          topology_(problem.size, problem.periodic),
          catalog_(topology_, problem.relations),
          scan_(column_order(problem.size)) {}

    // False when nothing fits the boundary, or the stop token was requested.
    bool start() {
        std::vector<Word> sets;
        for (std::size_t site = 0; site < topology_.site_count(); ++site) {
            const auto own = problem_.domains.words(static_cast<Site>(site));
            sets.insert(sets.end(), own.begin(), own.end());
        }
        catalog_.restore(sets);
        catalog_.enqueue_all();
        const bool fits = catalog_.propagate(stop_) == Propagation::kConsistent;
        start_.assign(catalog_.all_labels().begin(), catalog_.all_labels().end());
        return fits;
    }

    SearchOutcome run(const RandomKey& key) {
        catalog_.restore(start_);
        RandomStream random(key);
        const PartWeights weights = {problem_.weights, {}};  // there are no constraints
        return with_picker(order_, catalog_, topology_, scan_, weights, random, [&](auto picker) {
            return Search(catalog_, picker, weights, {}, random, stop_).run({0});
        });
    }

  private:
    const Problem& problem_;
    Order order_;
    const std::stop_token& stop_;
    GridTopology topology_;
    Catalog<GridTopology, kWords> catalog_;
    std::vector<Site> scan_;
    std::vector<Word> start_;
};

template <std::size_t kWords>
std::uint32_t count_successes(
    const Problem& problem,
    Order order,
    std::uint32_t runs,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    Runs<kWords> of_size(problem, order, stop);
    std::uint32_t successes = 0;
    if (!of_size.start()) {
        return successes;
    }
    for (std::uint32_t run = 0; run < runs && !stop.stop_requested(); ++run) {
        const SearchOutcome outcome = of_size.run({seed, run, 0, kPurposeSuccess});
        successes += std::uint32_t{outcome == SearchOutcome::kSolved};
    }
    return successes;
}

std::uint32_t count_successes(
    const Example& example,
    const Parameters& parameters,
    std::uint32_t runs,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    const auto problem = make_problem(example, parameters);
    if (!problem) {
        return 0;
    }
    const auto count = [&]<std::size_t kWords>() {
        return count_successes<kWords>(*problem, parameters.order.order, runs, seed, stop);
    };
    switch (problem->relations.words()) {
        case 1:
            return count.template operator()<1>();
        case 2:
            return count.template operator()<2>();
        case 3:
            return count.template operator()<3>();
        case 4:
            return count.template operator()<4>();
        default:
            return count.template operator()<0>();
    }
}

}  // namespace

Result<std::vector<SuccessPoint>> measure_success(
    const Example& example,
    const Parameters& parameters,
    const SuccessOptions& options,
    const std::stop_token& stop
) {
    std::vector<SuccessPoint> points;
    Parameters sized = parameters;
    sized.constraints.clear();
    std::uint64_t cells_left = options.cells_max;
    for (const std::int32_t width : options.widths) {
        check(width > 0, "success of models without cells was asked for");
        sized.size = GridSize{width, parameters.size->y, width};
        const std::uint64_t cells = sized.size->cell_count();
        const auto runs =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(options.runs, cells_left / cells));
        if (runs == 0) {
            continue;
        }
        cells_left -= runs * cells;
        points.push_back(
            {*sized.size, runs, count_successes(example, sized, runs, options.seed, stop)}
        );
        if (stop.stop_requested()) {
            return tl::unexpected(Error{ErrorCode::kCancelled, "the analysis was stopped", {}});
        }
    }
    return points;
}

}  // namespace modelsynth::discrete
