#include "solver/discrete/mender.h"

#include "solver/discrete/search_keys.h"

#include <algorithm>
#include <span>

namespace modelsynth::discrete {

namespace {

constexpr std::uint32_t kMendAttempts = 8;

}  // namespace

bool Mender::mend(std::vector<Label>& model) {
    const bool any = open(model);
    for (std::size_t site = 0; any && site < model.size(); ++site) {
        if (model[site] == kNoLabel && !mend_around(model, problem_.size.cell(site))) {
            return false;
        }
    }
    return true;
}

bool Mender::open(std::vector<Label>& model) const {
    if (problem_.start) {
        open_seam(model);
    }
    bool any = false;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto site = static_cast<Site>(i);
        const bool fits =
            problem_.domains.at(site).contains(model[site]) &&
            (problem_.symmetries == nullptr || !problem_.symmetries->is_violated_at(model, site));
        if (!fits) {
            model[site] = kNoLabel;
            any = true;
        }
    }
    return any;
}

void Mender::open_seam(std::vector<Label>& model) const {
    const GridTopology grid(problem_.size, problem_.periodic);
    std::vector<Site> unfit;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto site = static_cast<Site>(i);
        bool fits = model[site] != kNoLabel;
        grid.for_each_arc(site, [&](Site to, RelationId relation) {
            fits = fits && (model[to] == kNoLabel ||
                            problem_.relations.allows(relation, model[site], model[to]));
        });
        if (!fits && problem_.start->is_kept[site] == 0) {
            unfit.push_back(site);
        }
    }
    for (const Site site : unfit) {
        model[site] = kNoLabel;
    }
}

bool Mender::mend_around(std::vector<Label>& model, const Cell& centre) {
    for (std::int32_t reach = 1;; reach *= 2) {
        const Box box = box_around(centre, reach);
        if (stop_.stop_requested()) {
            return false;
        }
        const BlockResult result = search_.modify(
            box,
            std::span<Label>(model),
            {kMendAttempts, Order::kMinEntropy},
            {seed_, kMendKey, 0, 0},
            stop_
        );
        if (result.outcome == BlockOutcome::kAccepted) {
            return true;
        }
        if (box == Box::whole(problem_.size)) {
            return false;
        }
    }
}

Box Mender::box_around(const Cell& centre, std::int32_t reach) const {
    const GridSize size = problem_.size;
    const auto low = [reach](std::int32_t at) { return std::max(0, at - reach); };
    const auto high = [reach](std::int32_t at, std::int32_t extent) {
        return std::min(extent, at + reach + 1);
    };
    return {
        {low(centre.x), low(centre.y), low(centre.z)},
        {high(centre.x, size.x), high(centre.y, size.y), high(centre.z, size.z)}};
}

}  // namespace modelsynth::discrete
