#include "solver/discrete/analysis/analysis.h"

#include "solver/discrete/analysis/transitions.h"
#include "solver/discrete/parameters.h"

#include <utility>

namespace modelsynth::discrete {

namespace {

// Work for examples of up to 128 labels; propagation takes longer with more, so there is less of
// it.
constexpr std::uint64_t kVerdictSteps = 300'000;
constexpr std::uint64_t kSplittingSteps = 15'000;
constexpr std::size_t kSplitLabelsMax = 512;  // beyond, memory would count too
constexpr std::uint64_t kPlacements = 5'000;
constexpr std::uint64_t kSuccessCells = 2'000'000;
constexpr std::uint64_t kCountSteps = 500'000;
constexpr std::size_t kFullWorkWords = 2;

std::vector<GridSize> counted_sizes(const Transitions& transitions) {
    std::vector<GridSize> sizes;
    for (const std::int32_t extent : {2, 3}) {
        const auto along = [&](std::size_t axis) { return transitions.open[axis] ? extent : 1; };
        sizes.push_back({along(0), along(1), along(2)});
    }
    return sizes;
}

// Small examples are split, if they can be; large ones would take seconds.
SplittingOptions splitting_options(std::uint64_t steps_max) {
    SplittingOptions options;
    options.steps_max = steps_max;
    options.labels_per_label = 2;
    return options;
}

}  // namespace

Result<Analysis> analyse(const Example& example, const std::stop_token& stop) {
    const Transitions transitions = read_transitions(example);
    const Parameters parameters = fill_defaults({}, example);
    const std::size_t words = transitions.relations.words();
    const auto share = [words](std::uint64_t work) {
        return words <= kFullWorkWords ? work : work * kFullWorkWords / words;
    };
    InfallibilityOptions options;
    options.steps_max = share(kVerdictSteps);
    auto verdict = judge_infallibility(transitions, options, stop);
    if (!verdict) {
        return tl::unexpected(std::move(verdict.error()));
    }
    std::optional<Splitting> splitting;
    if (verdict->kind != Infallibility::kInfallible && example.pieces.size() <= kSplitLabelsMax) {
        auto found =
            find_splitting(example, transitions, splitting_options(share(kSplittingSteps)), stop);
        if (!found) {
            return tl::unexpected(std::move(found.error()));
        }
        splitting = std::move(*found);
    }
    auto facts = find_label_facts(example, parameters, stop, share(kPlacements));
    if (!facts) {
        return tl::unexpected(std::move(facts.error()));
    }
    SuccessOptions success_options;
    success_options.cells_max = share(kSuccessCells);
    auto success = measure_success(example, parameters, success_options, stop);
    if (!success) {
        return tl::unexpected(std::move(success.error()));
    }
    Analysis analysis = {
        std::move(*verdict), std::move(splitting), std::move(*facts), {}, std::move(*success), {}};
    analysis.warnings = list_warnings(example, analysis.facts);
    ModelCountLimit limit;
    limit.steps_max = share(kCountSteps);
    for (const GridSize& size : counted_sizes(transitions)) {
        auto models = count_models(transitions, size, limit, stop);
        if (!models) {
            return tl::unexpected(std::move(models.error()));
        }
        analysis.counts.push_back({size, *models});
    }
    return analysis;
}

}  // namespace modelsynth::discrete
