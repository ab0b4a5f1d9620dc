#include "solver/discrete/planting.h"

#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/search_keys.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

constexpr std::uint32_t kPurposePlace = 2;

// Places tried in turn for one piece before that is given up.
constexpr std::uint32_t kPlacesMax = 64;
constexpr std::uint32_t kPlantAttempts = 4;

bool is_member(const MemberRule& rule, Site site, Label label) {
    return (rule.applies.empty() || rule.applies[site] != 0) && rule.labels.contains(label);
}

class Planter {
  public:
    Planter(
        const Problem& problem,
        BoxSearch& search,
        const GridSize& block,
        std::uint64_t seed,
        std::span<Label> model,
        const std::stop_token& stop
    )
        : problem_(problem),
          search_(search),
          block_(block),
          seed_(seed),
          model_(model),
          stop_(stop),
          aims_(problem.member_rules) {
        // What is not reached yet is no constraint yet.
        for (MemberRule& aim : aims_) {
            if (auto* count = std::get_if<Count>(&aim.rule)) {
                count->min = std::min(count->min, standing(aim));
            }
        }
    }

    bool plant(std::size_t rule) {
        auto& aim = std::get<Count>(aims_[rule].rule);
        const std::uint32_t wanted = std::get<Count>(problem_.member_rules[rule].rule).min;
        const std::vector<Site> places = places_for(aims_[rule]);
        while (aim.min < wanted) {
            ++aim.min;
            if (places.empty() || !plant_one(aims_[rule], places)) {
                return false;
            }
            aim.min = std::min(wanted, standing(aims_[rule]));
        }
        return true;
    }

  private:
    [[nodiscard]] std::uint32_t standing(const MemberRule& rule) const {
        std::uint32_t count = 0;
        for (std::size_t site = 0; site < model_.size(); ++site) {
            count += is_member(rule, static_cast<Site>(site), model_[site]) ? 1U : 0U;
        }
        return count;
    }

    // Where the domains alone allow a member.
    [[nodiscard]] std::vector<Site> places_for(const MemberRule& rule) const {
        std::vector<Site> places;
        for (std::size_t i = 0; i < model_.size(); ++i) {
            const auto site = static_cast<Site>(i);
            LabelSet both = problem_.domains.at(site);
            both &= rule.labels;
            if ((rule.applies.empty() || rule.applies[site] != 0) && !both.empty()) {
                places.push_back(site);
            }
        }
        return places;
    }

    bool plant_one(const MemberRule& rule, std::span<const Site> places) {
        const auto board = make_board(problem_, aims_);
        board->start(model_);
        for (std::uint32_t tried = 0; tried < kPlacesMax && !stop_.stop_requested(); ++tried) {
            const std::uint32_t key = kPlantKeys + tried_++;
            RandomStream random({seed_, key, 0, kPurposePlace});
            const Site site = places[random.below(static_cast<std::uint32_t>(places.size()))];
            if (is_member(rule, site, model_[site])) {
                continue;
            }
            const Cell cell = problem_.size.cell(site);
            const auto result = search_.modify(
                block_around(cell),
                model_,
                {kPlantAttempts, Order::kScan, board.get(), BoxOptions::Pin{cell, &rule.labels}},
                {seed_, key, 0, 0},
                stop_
            );
            if (result.outcome == BlockOutcome::kAccepted) {
                return true;
            }
        }
        return false;
    }

    [[nodiscard]] Box block_around(const Cell& cell) const {
        const auto range = [](std::int32_t at, std::int32_t length, std::int32_t extent) {
            const std::int32_t cut = std::min(length, extent);
            const std::int32_t begin = std::clamp(at - cut / 2, 0, extent - cut);
            return std::pair(begin, begin + cut);
        };
        const auto [west, east] = range(cell.x, block_.x, problem_.size.x);
        const auto [bottom, top] = range(cell.y, block_.y, problem_.size.y);
        const auto [north, south] = range(cell.z, block_.z, problem_.size.z);
        return {{west, bottom, north}, {east, top, south}};
    }

    const Problem& problem_;
    BoxSearch& search_;
    GridSize block_;
    std::uint64_t seed_;
    std::span<Label> model_;
    const std::stop_token& stop_;
    std::vector<MemberRule> aims_;  // the rules, with counts no higher than what stands
    std::uint32_t tried_ = 0;
};

}  // namespace

bool plant_counts(
    const Problem& problem,
    BoxSearch& search,
    const GridSize& block,
    std::uint64_t seed,
    std::span<Label> model,
    const std::stop_token& stop
) {
    Planter planter(problem, search, block, seed, model, stop);
    for (std::size_t i = 0; i < problem.member_rules.size(); ++i) {
        if (std::holds_alternative<Count>(problem.member_rules[i].rule) && !planter.plant(i)) {
            return false;
        }
    }
    return true;
}

}  // namespace modelsynth::discrete
