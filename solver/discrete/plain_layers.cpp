#include "solver/discrete/plain_layers.h"

#include <algorithm>
#include <cstdint>
#include <map>

namespace modelsynth::discrete {

std::vector<LabelSet> common_domains(const Problem& problem) {
    const auto floor_sites =
        static_cast<std::size_t>(problem.size.x) * static_cast<std::size_t>(problem.size.z);
    const auto count_free = [&](Site first, std::size_t count) {
        if (!problem.start) {
            return count;
        }
        const auto kept = problem.start->is_kept.begin() + static_cast<std::ptrdiff_t>(first);
        return static_cast<std::size_t>(
            std::count(kept, kept + static_cast<std::ptrdiff_t>(count), 0)
        );
    };
    std::vector<LabelSet> floors;
    for (std::size_t first = 0; first < problem.domains.site_count(); first += floor_sites) {
        std::map<std::uint16_t, std::size_t> counts;
        std::uint16_t most = problem.domains.number(static_cast<Site>(first + floor_sites - 1));
        std::size_t most_count = 0;
        problem.domains.for_each_run(
            static_cast<Site>(first),
            floor_sites,
            [&](Site site, std::size_t sites, std::uint16_t number) {
                const std::size_t count = counts[number] += count_free(site, sites);
                if (count > most_count) {
                    most = number;
                    most_count = count;
                }
            }
        );
        floors.push_back(problem.domains.set(most));
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
    const std::size_t floor_sites = problem.size.cell_count() / layers.size();
    std::vector<Label> model;
    model.reserve(problem.size.cell_count());
    for (const Label label : layers) {
        model.insert(model.end(), floor_sites, label);
    }
    return model;
}

}  // namespace modelsynth::discrete
