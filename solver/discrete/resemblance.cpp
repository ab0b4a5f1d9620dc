#include "solver/discrete/resemblance.h"

#include "solver/core/result.h"

#include <algorithm>
#include <optional>

namespace modelsynth::discrete {

namespace {

std::size_t window_cells(const Resemblance& resemblance) {
    const auto side = static_cast<std::size_t>(2 * resemblance.window + 1);
    return side * side * side;
}

// Nothing beyond the edge of an axis that does not close on itself.
std::optional<std::int32_t> place(std::int32_t at, std::int32_t extent, bool is_periodic) {
    if (is_periodic) {
        return (at % extent + extent) % extent;
    }
    return at >= 0 && at < extent ? std::optional(at) : std::nullopt;
}

}  // namespace

std::size_t resemblance_cost(const Example& example, const Resemblance& resemblance) {
    return example.size.cell_count() * window_cells(resemblance);
}

ResemblanceChooser::ResemblanceChooser(
    const Example& example,
    const Resemblance& resemblance,
    const GridSize& model,
    Periodic periodic,
    const LabelWeights& usual
)
    : model_(model),
      periodic_(periodic),
      threshold_(resemblance.threshold),
      usual_(usual),
      places_(example.pieces.size()) {
    check(example.size.cell_count() > 0, "an example without cells to resemble");
    const std::int32_t w = resemblance.window;
    const GridSize padded = {
        example.size.x + 2 * w, example.size.y + 2 * w, example.size.z + 2 * w};
    example_.assign(padded.cell_count(), kNoLabel);
    for_each_cell(Box::whole(example.size), [&](const Cell& cell) {
        const std::size_t at = padded.index({cell.x + w, cell.y + w, cell.z + w});
        const Label label = example.cells[example.size.index(cell)];
        example_[at] = label;
        places_[label].push_back(at);
    });
    const auto middle = static_cast<std::ptrdiff_t>(padded.index({w, w, w}));
    for_each_cell(Box{{-w, -w, -w}, {w + 1, w + 1, w + 1}}, [&](const Cell& offset) {
        if (offset == Cell{}) {
            return;
        }
        const Cell at = {offset.x + w, offset.y + w, offset.z + w};
        offsets_.push_back(offset);
        steps_.push_back(static_cast<std::ptrdiff_t>(padded.index(at)) - middle);
    });
}

void ResemblanceChooser::look_around(Site site, std::vector<Site>& around) const {
    around.clear();
    const Cell cell = model_.cell(site);
    for (const Cell& offset : offsets_) {
        const auto x = place(cell.x + offset.x, model_.x, periodic_.x);
        const auto y = place(cell.y + offset.y, model_.y, periodic_.y);
        const auto z = place(cell.z + offset.z, model_.z, periodic_.z);
        around.push_back(x && y && z ? static_cast<Site>(model_.index({*x, *y, *z})) : kNoSite);
    }
}

Label ResemblanceChooser::choose(
    std::span<const Word> possible,
    std::span<const Site> around,
    std::span<const Label> decided,
    const LabelWeights& weights,
    RandomStream& random
) const {
    std::vector<DecidedCell> cells;
    for (std::size_t i = 0; i < around.size(); ++i) {
        if (around[i] == kNoSite || decided[i] != kNoLabel) {
            cells.push_back({steps_[i], decided[i]});
        }
    }

    struct Candidate {
        Label label;
        std::vector<std::int32_t> shared;  // by place
    };

    std::vector<Candidate> candidates;
    std::int32_t most = 0;
    for_each_label(possible, [&](Label label) {
        Candidate candidate = {label, {}};
        for (const std::size_t at : places_[label]) {
            std::int32_t shared = 0;
            for (const DecidedCell& cell : cells) {
                const std::size_t there = at + static_cast<std::size_t>(cell.step);
                shared += static_cast<std::int32_t>(example_[there] == cell.label);
            }
            candidate.shared.push_back(shared);
            most = std::max(most, shared);
        }
        candidates.push_back(std::move(candidate));
    });
    std::vector<std::uint64_t> chances;
    std::uint64_t total = 0;
    for (const Candidate& candidate : candidates) {
        const auto likes = static_cast<std::uint64_t>(std::count_if(
            candidate.shared.begin(),
            candidate.shared.end(),
            [&](std::int32_t shared) { return shared >= most - threshold_; }
        ));
        const std::uint64_t usual = std::max(1U, usual_.of(candidate.label));
        // In thousandths, so that a label made rarer keeps a chance.
        const std::uint64_t factor = std::uint64_t{1000} * weights.of(candidate.label) / usual;
        total += chances.emplace_back(likes * factor);
    }
    if (total == 0) {
        return weights.draw(possible, random);  // known from rules alone, they stand nowhere
    }
    std::uint64_t left = random.below_wide(total);
    std::size_t drawn = 0;
    while (left >= chances[drawn]) {
        left -= chances[drawn++];
    }
    return candidates[drawn].label;
}

}  // namespace modelsynth::discrete
