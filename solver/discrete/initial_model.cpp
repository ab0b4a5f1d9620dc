#include "solver/discrete/initial_model.h"

#include "solver/core/block_search.h"
#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/explanation/conflict.h"
#include "solver/discrete/names.h"
#include "solver/discrete/planting.h"
#include "solver/discrete/whole_by_sat.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace modelsynth::discrete {

namespace {

// RandomKey::block of searches that are no block of the schedule.
constexpr std::uint32_t kWholeKey = 0xFFFFFFFF;
constexpr std::uint32_t kTileKey = 0xFFFFFFFE;
constexpr std::uint32_t kMendKey = 0xFFFFFFFD;

constexpr std::int32_t kTileMax = 8;
constexpr std::uint32_t kTileAttempts = 4;
constexpr std::uint32_t kMendAttempts = 8;
// Beyond, the search needs more memory than a model in blocks should.
constexpr std::size_t kWholeFirstCellsMax = std::size_t{1} << 17;
constexpr std::uint32_t kWholeFirstAttempts = 4;

// What most cells of each floor may be.
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
            const LabelSet* set = &problem.domains.at(static_cast<Site>(site));
            const std::size_t count = ++counts[set];
            if (count > most_count) {
                most = set;
                most_count = count;
            }
        }
        floors.push_back(*most);
    }
    return floors;
}

// One label a floor, each next to itself along x and z, chosen so that as much as possible is
// empty and the rest is common.
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
            if (!along(Direction::kEast, label, label) || !along(Direction::kSouth, label, label)) {
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

// A model of tile_x by tile_z columns that closes on itself, repeated over the whole.
std::optional<std::vector<Label>> find_tile(
    const Problem& problem,
    const std::vector<LabelSet>& floors,
    std::int32_t tile_x,
    std::int32_t tile_z,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    const GridSize size = {tile_x, problem.size.y, tile_z};
    const GridPart part(size, {true, problem.periodic.y, true}, Box::whole(size));
    SiteDomains domains(size.cell_count(), LabelSet::all(problem.relations.label_count()));
    for_each_cell(Box::whole(size), [&](const Cell& cell) {
        domains.narrow(
            static_cast<Site>(size.index(cell)), floors[static_cast<std::size_t>(cell.y)]
        );
    });
    std::vector<Label> tile(size.cell_count(), kNoLabel);
    const std::vector<Site> scan = column_order(size);
    BlockSearch<GridPart> search(problem.relations, domains, problem.weights);
    const BlockResult result = search.modify(
        part,
        std::span<Label>(tile),
        {kTileAttempts, Order::kScan, scan},
        {seed, kTileKey, 0, 0},
        stop
    );
    if (result.outcome != BlockOutcome::kAccepted) {
        return std::nullopt;
    }
    std::vector<Label> model(problem.size.cell_count());
    for_each_cell(Box::whole(problem.size), [&](const Cell& cell) {
        model[problem.size.index(cell)] =
            tile[size.index({cell.x % tile_x, cell.y, cell.z % tile_z})];
    });
    return model;
}

std::optional<std::vector<Label>> find_any_tile(
    const Problem& problem, std::uint64_t seed, const std::stop_token& stop
) {
    const std::vector<LabelSet> floors = common_domains(problem);
    const auto divides = [](bool periodic, std::int32_t extent, std::int32_t tile) {
        return tile <= extent && (!periodic || extent % tile == 0);
    };
    for (std::int32_t sum = 2; sum <= 2 * kTileMax; ++sum) {
        for (std::int32_t x = std::max(1, sum - kTileMax); x <= std::min(kTileMax, sum - 1); ++x) {
            const std::int32_t z = sum - x;
            if (stop.stop_requested()) {
                return std::nullopt;
            }
            if (!divides(problem.periodic.x, problem.size.x, x) ||
                !divides(problem.periodic.z, problem.size.z, z)) {
                continue;
            }
            if (auto model = find_tile(problem, floors, x, z, seed, stop)) {
                return model;
            }
        }
    }
    return std::nullopt;
}

// Mends the cells whose label their own domain forbids. False when a box as large as the whole
// could not be made.
class Mender {
  public:
    Mender(
        const Problem& problem,
        BlockSearch<GridPart>& search,
        std::uint64_t seed,
        const std::stop_token& stop
    )
        : problem_(problem), search_(search), seed_(seed), stop_(stop) {}

    bool mend(std::vector<Label>& model) {
        bool any = false;
        for (std::size_t site = 0; site < model.size(); ++site) {
            if (!problem_.domains.at(static_cast<Site>(site)).contains(model[site])) {
                model[site] = kNoLabel;
                any = true;
            }
        }
        for (std::size_t site = 0; any && site < model.size(); ++site) {
            if (model[site] == kNoLabel && !mend_around(model, problem_.size.cell(site))) {
                return false;
            }
        }
        return true;
    }

  private:
    bool mend_around(std::vector<Label>& model, const Cell& centre) {
        for (std::int32_t reach = 1;; reach *= 2) {
            const Box box = box_around(centre, reach);
            if (stop_.stop_requested()) {
                return false;
            }
            const GridPart part(problem_.size, problem_.periodic, box);
            const std::vector<Site> scan = column_order(box.size());
            const BlockResult result = search_.modify(
                part,
                std::span<Label>(model),
                {kMendAttempts, Order::kMinEntropy, scan},
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

    [[nodiscard]] Box box_around(const Cell& centre, std::int32_t reach) const {
        const GridSize size = problem_.size;
        const auto low = [reach](std::int32_t at) { return std::max(0, at - reach); };
        const auto high = [reach](std::int32_t at, std::int32_t extent) {
            return std::min(extent, at + reach + 1);
        };
        return {
            {low(centre.x), low(centre.y), low(centre.z)},
            {high(centre.x, size.x), high(centre.y, size.y), high(centre.z, size.z)}};
    }

    const Problem& problem_;
    BlockSearch<GridPart>& search_;
    std::uint64_t seed_;
    const std::stop_token& stop_;
};

Error gave_up(const Example& example, const Problem& problem) {
    LabelSet repeats(example.pieces.size());
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        const auto self = static_cast<Label>(label);
        if (problem.relations.allows(0, self, self) && problem.relations.allows(4, self, self)) {
            repeats.insert(self);
        }
    }
    const std::vector<LabelSet> floors = common_domains(problem);
    LabelSet ground = floors.front();
    ground &= repeats;
    std::string message = "no consistent initial model was found: ";
    if (repeats.empty()) {
        message += "no piece of the example stands next to itself along both x and z";
    } else if (ground.empty()) {
        message += "no piece that may stand on the bottom (" + list_names(example, floors.front()) +
                   ") stands next to itself along both x and z in the example";
    } else {
        message += "the pieces that stand next to themselves along x and z (" +
                   list_names(example, repeats) + ") do not fit between the sides";
    }
    message += "; no tile of up to " + std::to_string(kTileMax) + " by " +
               std::to_string(kTileMax) + " columns repeats, and " +
               std::to_string(kWholeAttempts) + " attempts at the whole at once failed";
    return {ErrorCode::kGaveUp, std::move(message), {}};
}

Error violated(const Example& example, const MemberRule& rule) {
    return {
        ErrorCode::kGaveUp,
        "no initial model was found in which " + name_rule(example, rule) +
            " holds: " + std::to_string(kWholeAttempts) + " attempts at the whole at once failed",
        {}};
}

class Finder {
  public:
    Finder(
        const Preparation& preparation,
        BlockSearch<GridPart>& search,
        std::uint64_t seed,
        const std::stop_token& stop
    )
        : preparation_(preparation),
          example_(preparation.example()),
          problem_(preparation.problem()),
          search_(search),
          seed_(seed),
          stop_(stop) {}

    // One for which the member rules are not asked.
    Result<InitialModel> find() {
        if (const auto& plain = preparation_.plain_model()) {
            return InitialModel{*plain, false};
        }
        Mender mender(problem_, search_, seed_, stop_);
        const auto layers =
            preparation_.is_plain_model_rigid() ? std::nullopt : find_layers(example_, problem_);
        if (layers) {
            InitialModel model = {spread_layers(problem_, *layers), false};
            if (mender.mend(model.labels)) {
                return model;
            }
        } else {
            if (problem_.size.cell_count() <= kWholeFirstCellsMax) {
                auto model = solve_whole(kWholeFirstAttempts, nullptr);
                if (!model) {
                    return tl::unexpected(std::move(model.error()));
                }
                if (*model) {
                    return std::move(**model);
                }
            }
            auto tiled = find_any_tile(problem_, seed_, stop_);
            if (tiled && mender.mend(*tiled)) {
                return InitialModel{std::move(*tiled), false};
            }
        }
        auto model = solve_whole(kWholeAttempts, nullptr);
        if (!model) {
            return tl::unexpected(std::move(model.error()));
        }
        if (*model) {
            return std::move(**model);
        }
        auto settled = settle_by_sat(problem_, seed_, stop_);
        if (!settled) {
            return tl::unexpected(std::move(settled.error()));
        }
        if (!*settled) {
            return tl::unexpected(with_dead_ends(gave_up(example_, problem_)));
        }
        return InitialModel{std::move(**settled), true};
    }

    // The model, changed so that the member rules hold, or another one.
    Result<InitialModel> satisfy(InitialModel model) {
        const auto board = make_board(problem_, problem_.member_rules);
        if (!board->find_violated(model.labels)) {
            return model;
        }
        const auto& blocks = *preparation_.parameters().blocks;
        const GridSize block = blocks ? blocks->layout.size : problem_.size;
        const bool planted = plant_counts(problem_, search_, block, seed_, model.labels, stop_);
        const auto rule = board->find_violated(model.labels);
        if (planted && !rule) {
            return model;
        }
        if (stop_.stop_requested()) {
            return tl::unexpected(stopped());
        }
        auto whole = solve_whole(kWholeAttempts, board.get());
        if (!whole) {
            return tl::unexpected(std::move(whole.error()));
        }
        if (!*whole) {
            return tl::unexpected(
                with_dead_ends(violated(example_, problem_.member_rules[rule.value_or(0)]))
            );
        }
        return std::move(**whole);
    }

  private:
    static Error stopped() { return {ErrorCode::kCancelled, "stopped", {}}; }

    [[nodiscard]] Error with_dead_ends(Error error) const {
        error.explanation = hottest_of(problem_.size, dead_ends_);
        return error;
    }

    // Nothing when no attempt succeeded.
    Result<std::optional<InitialModel>> solve_whole(
        std::uint32_t attempts, ConstraintBoard* board
    ) {
        InitialModel model = {std::vector<Label>(problem_.size.cell_count(), kNoLabel), true};
        const GridPart part(problem_.size, problem_.periodic, Box::whole(problem_.size));
        const std::vector<Site> scan = column_order(problem_.size);
        BlockOptions options = {attempts, Order::kScan, scan};
        options.board = board;
        dead_ends_.assign(model.labels.size(), 0);
        options.dead_ends = dead_ends_;
        if (board != nullptr) {
            board->start(model.labels);
        }
        const BlockResult result = search_.modify(
            part, std::span<Label>(model.labels), options, {seed_, kWholeKey, 0, 0}, stop_
        );
        switch (result.outcome) {
            case BlockOutcome::kAccepted:
                return std::optional(std::move(model));
            case BlockOutcome::kStopped:
                return tl::unexpected(stopped());
            case BlockOutcome::kImpossible:
                return tl::unexpected(contradiction_of(example_, problem_, result));
            case BlockOutcome::kReverted:
                break;
        }
        return std::optional<InitialModel>();
    }

    const Preparation& preparation_;
    const Example& example_;
    const Problem& problem_;
    BlockSearch<GridPart>& search_;
    std::uint64_t seed_;
    const std::stop_token& stop_;
    std::vector<std::uint32_t> dead_ends_;  // by cell, of the last search of the whole
};

}  // namespace

std::vector<Site> column_order(const GridSize& size) {
    std::vector<Site> order;
    order.reserve(size.cell_count());
    for (std::int32_t x = 0; x < size.x; ++x) {
        for (std::int32_t z = 0; z < size.z; ++z) {
            for (std::int32_t y = 0; y < size.y; ++y) {
                order.push_back(static_cast<Site>(size.index({x, y, z})));
            }
        }
    }
    return order;
}

Error contradiction_of(const Example& example, const Problem& problem, const BlockResult& result) {
    if (result.impossible_constraint) {
        const MemberRule& rule = problem.member_rules[*result.impossible_constraint];
        return {
            ErrorCode::kContradiction,
            "no model of this size exists: " + name_rule(example, rule) +
                " cannot hold with what the boundary and the other constraints leave",
            {}};
    }
    const Cell cell = problem.size.cell(result.impossible_site);
    const LabelSet& own = problem.domains.at(result.impossible_site);
    const std::string sides = name_sides(problem.size, cell);
    return {
        ErrorCode::kContradiction,
        "no model of this size exists: at cell " + name_cell(cell) +
            (sides.empty() ? "" : ", on " + sides) + ", none of " + list_names(example, own) +
            " can stand beside what the boundary and the constraints leave to its neighbours",
        {}};
}

std::optional<std::vector<Label>> find_plain_model(const Example& example, const Problem& problem) {
    const auto layers = find_layers(example, problem);
    if (!layers) {
        return std::nullopt;
    }
    std::vector<Label> model = spread_layers(problem, *layers);
    for (std::size_t site = 0; site < model.size(); ++site) {
        if (!problem.domains.at(static_cast<Site>(site)).contains(model[site])) {
            return std::nullopt;
        }
    }
    return model;
}

Result<InitialModel> find_initial_model(
    const Preparation& preparation,
    BlockSearch<GridPart>& search,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    Finder finder(preparation, search, seed, stop);
    auto model = finder.find();
    if (!model || preparation.problem().member_rules.empty()) {
        return model;
    }
    return finder.satisfy(std::move(*model));
}

}  // namespace modelsynth::discrete
