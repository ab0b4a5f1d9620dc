#include "solver/discrete/plain_layers.h"

#include <algorithm>
#include <cstdint>
#include <map>

namespace modelsynth::discrete {

std::vector<LabelSet> common_domains(const Problem& problem) {
    std::vector<LabelSet> floors;
    std::size_t site = 0;
    for (std::int32_t y = 0; y < problem.size.y; ++y) {
        std::map<const LabelSet*, std::size_t> counts;
        const auto floor_sites =
            static_cast<std::size_t>(problem.size.x) * static_cast<std::size_t>(problem.size.z);
        const LabelSet* most = nullptr;
        std::size_t most_count = 0;
        for (std::size_t i = 0; i < floor_sites; ++i, ++site) {
            if (problem.start && problem.start->is_kept[site] != 0) {
                continue;
            }
            const LabelSet* set = &problem.domains.at(static_cast<Site>(site));
            const std::size_t count = ++counts[set];
            if (count > most_count) {
                most = set;
                most_count = count;
            }
        }
        floors.push_back(most == nullptr ? problem.domains.at(static_cast<Site>(site - 1)) : *most);
    }
    return floors;
}

std::optional<std::vector<Label>> find_layers(const Example& example, const Problem& problem) {
    const std::size_t label_count = example.pieces.size();
    const auto along = [&problem](Direction direction, Label a, Label b) {
        return problem.relations.allows(static_cast<RelationId>(direction), a, b);
    };

    struct Best {
        std::uint64_t score = 0;  // 0: not possible
        Label below = kNoLabel;
    };

    const std::vector<LabelSet> floors = common_domains(problem);
    std::vector<std::vector<Best>> best(floors.size(), std::vector<Best>(label_count));
    constexpr std::uint64_t kEmptyScore = std::uint64_t{1} << 32;
    for (std::size_t y = 0; y < floors.size(); ++y) {
        for_each_label(floors[y].words(), [&](Label label) {
            if (!along(Direction::kEast, label, label) || !along(Direction::kSouth, label, label) ||
                (problem.symmetries != nullptr && !problem.symmetries->is_own_image(label))) {
                return;
            }
            const std::uint64_t own =
                example.empty == label ? kEmptyScore : 1 + problem.weights.table(0).of(label);
            if (y == 0) {
                best[y][label] = {own, kNoLabel};
                return;
            }
            for (std::size_t below = 0; below < label_count; ++below) {
                const Best& under = best[y - 1][below];
                if (under.score > 0 && along(Direction::kUp, static_cast<Label>(below), label) &&
                    under.score + own > best[y][label].score) {
                    best[y][label] = {under.score + own, static_cast<Label>(below)};
                }
            }
        });
    }
    const auto top =
        std::max_element(best.back().begin(), best.back().end(), [](const Best& a, const Best& b) {
            return a.score < b.score;
        });
    if (top->score == 0) {
        return std::nullopt;
    }
    std::vector<Label> layers(floors.size());
    auto label = static_cast<Label>(top - best.back().begin());
    for (std::size_t y = floors.size(); y-- > 0;) {
        layers[y] = label;
        label = best[y][label].below;
    }
    if (problem.periodic.y && !along(Direction::kUp, layers.back(), layers.front())) {
        return std::nullopt;
    }
    return layers;
}

std::vector<Label> spread_layers(const Problem& problem, const std::vector<Label>& layers) {
    std::vector<Label> model(problem.size.cell_count());
    const std::size_t floor_sites = model.size() / layers.size();
    for (std::size_t site = 0; site < model.size(); ++site) {
        model[site] = layers[site / floor_sites];
    }
    return model;
}

}  // namespace modelsynth::discrete
