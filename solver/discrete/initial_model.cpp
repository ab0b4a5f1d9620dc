#include "solver/discrete/initial_model.h"

#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/explanation/contradiction.h"
#include "solver/discrete/mender.h"
#include "solver/discrete/names.h"
#include "solver/discrete/plain_layers.h"
#include "solver/discrete/planting.h"
#include "solver/discrete/repeated_tile.h"
#include "solver/discrete/search_keys.h"
#include "solver/discrete/whole_by_sat.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace modelsynth::discrete {

namespace {

// Beyond, the search needs more memory than a model in blocks should, ...
constexpr std::size_t kWholeFirstCellsMax = std::size_t{1} << 17;
// ... some 150 bytes a cell; but where blocks could not change the plain model nor, most likely, a
// tile, the only other thing to have is nothing.
constexpr std::size_t kWholeOrNothingCellsMax = std::size_t{1} << 22;
constexpr std::uint32_t kWholeFirstAttempts = 4;

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

// One that may still be changed.
struct Draft {
    std::vector<Label> labels;
    bool is_searched = false;
};

class Finder {
  public:
    Finder(
        const Preparation& preparation,
        BoxSearch& search,
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
    Result<Draft> find() {
        if (const auto& plain = preparation_.plain_model()) {
            return Draft{*plain, false};
        }
        Mender mender(problem_, search_, seed_, stop_);
        const auto layers =
            preparation_.is_plain_model_rigid() ? std::nullopt : find_layers(example_, problem_);
        if (layers || has_no_gap()) {
            Draft model = {
                layers ? spread_layers(problem_, *layers) : problem_.start->labels, false};
            put_start(model.labels);
            if (mender.mend(model.labels)) {
                return model;
            }
        } else {
            const bool is_rigid = preparation_.is_plain_model_rigid();
            if (problem_.size.cell_count() <=
                (is_rigid ? kWholeOrNothingCellsMax : kWholeFirstCellsMax)) {
                // What column after column settles into, such as streets that all run one way,
                // blocks cannot get out of where they need pieces around them that fit.
                auto model = solve_whole(
                    kWholeFirstAttempts, nullptr, is_rigid ? Order::kRandom : Order::kScan
                );
                if (!model) {
                    return tl::unexpected(std::move(model.error()));
                }
                if (*model) {
                    return std::move(**model);
                }
            }
            // A tile that repeats is seldom its own image, nor does it fit to what is kept.
            if (problem_.symmetries == nullptr && !problem_.start) {
                auto tiled = find_any_tile(problem_, seed_, stop_);
                if (tiled && mender.mend(*tiled)) {
                    return Draft{std::move(*tiled), false};
                }
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
        return Draft{std::move(**settled), true};
    }

    // The model, changed so that the member rules hold, or another one.
    Result<Draft> satisfy(Draft model) {
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
    // Whether the model to start from covers all.
    [[nodiscard]] bool has_no_gap() const {
        return problem_.start &&
               std::count(problem_.start->labels.begin(), problem_.start->labels.end(), kNoLabel) ==
                   0;
    }

    // Puts the model to start from over this one.
    void put_start(std::vector<Label>& model) const {
        for (std::size_t site = 0; problem_.start && site < model.size(); ++site) {
            const Label label = problem_.start->labels[site];
            model[site] = label == kNoLabel ? model[site] : label;
        }
    }

    static Error stopped() { return {ErrorCode::kCancelled, "stopped", {}}; }

    [[nodiscard]] Error with_dead_ends(Error error) const {
        error.explanation = hottest_of(problem_.size, dead_ends_);
        return error;
    }

    // Nothing when no attempt succeeded.
    Result<std::optional<Draft>> solve_whole(
        std::uint32_t attempts, ConstraintBoard* board, Order order = Order::kScan
    ) {
        Draft model = {std::vector<Label>(problem_.size.cell_count(), kNoLabel), true};
        if (board != nullptr) {
            board->start(model.labels);
        }
        dead_ends_.assign(model.labels.size(), 0);
        const BlockResult result = search_.modify(
            Box::whole(problem_.size),
            std::span<Label>(model.labels),
            {attempts, order, board, std::nullopt, nullptr, dead_ends_},
            {seed_, kWholeKey, 0, 0},
            stop_
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
        return std::optional<Draft>();
    }

    const Preparation& preparation_;
    const Example& example_;
    const Problem& problem_;
    BoxSearch& search_;
    std::uint64_t seed_;
    const std::stop_token& stop_;
    std::vector<std::uint32_t> dead_ends_;  // by cell, of the last search of the whole
};

}  // namespace

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
    if (!layers || problem.start) {
        return std::nullopt;
    }
    std::vector<Label> model = spread_layers(problem, *layers);
    bool fits = true;
    const SiteDomains& domains = problem.domains;
    domains.for_each_run(0, model.size(), [&](Site site, std::size_t count, std::uint16_t number) {
        const LabelSet& own = domains.set(number);
        for (std::size_t i = site; i < site + count; ++i) {
            fits = fits && own.contains(model[i]);
        }
    });
    for (std::size_t i = 0; problem.symmetries != nullptr && i < model.size(); ++i) {
        fits = fits && !problem.symmetries->is_violated_at(model, static_cast<Site>(i));
    }
    return fits ? std::optional(std::move(model)) : std::nullopt;
}

Result<InitialModel> find_initial_model(
    const Preparation& preparation,
    BoxSearch& search,
    std::uint64_t seed,
    const std::stop_token& stop
) {
    const bool is_ruled = !preparation.problem().member_rules.empty();
    if (preparation.plain_model() != nullptr && !is_ruled) {
        return InitialModel{preparation.plain_model(), false};
    }
    Finder finder(preparation, search, seed, stop);
    auto draft = finder.find();
    if (draft && is_ruled) {
        draft = finder.satisfy(std::move(*draft));
    }
    if (!draft) {
        return tl::unexpected(std::move(draft.error()));
    }
    return InitialModel{
        std::make_shared<const std::vector<Label>>(std::move(draft->labels)), draft->is_searched};
}

}  // namespace modelsynth::discrete
