// The causes of a contradiction are found by taking out of the request what is not needed for it:
// what is left of the request is asked again whether it has a model. So whatever a cause means is
// said in one place, where requests are read.

#include "solver/discrete/explanation/explain.h"

#include "solver/discrete/explanation/cause.h"
#include "solver/discrete/explanation/conflict_cells.h"
#include "solver/discrete/explanation/contradiction.h"
#include "solver/discrete/explanation/effort.h"
#include "solver/discrete/explanation/irreducible.h"
#include "solver/discrete/explanation/judge.h"
#include "solver/discrete/names.h"
#include "solver/discrete/problem.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

constexpr std::uint64_t kEffort = std::uint64_t{1} << 24;
// Even the largest whole is looked at so many times.
constexpr std::uint64_t kWholesMin = 8;
// Cells that a person can look at.
constexpr std::size_t kCellsMax = 32;
constexpr std::size_t kCellsInWordsMax = 3;
constexpr std::size_t kCausesInWordsMax = 8;
constexpr std::size_t kDemandsMax = 8;

class Explainer {
  public:
    Explainer(
        const Example& example,
        const Parameters& parameters,
        const Problem& problem,
        const std::stop_token& stop
    )
        : example_(example),
          parameters_(parameters),
          problem_(problem),
          all_(find_causes(example, parameters, problem)),
          stop_(stop),
          effort_(kEffort + kWholesMin * parameters.size->cell_count()) {}

    // Nothing when no proof is found.
    [[nodiscard]] std::optional<Error> explain() {
        if (verdict_of(all_) != Verdict::kImpossible) {
            return std::nullopt;
        }
        // What leaves nothing to a cell is the plainest of all conflicts, though others may have
        // fewer causes.
        const std::optional<Site> empty = first_empty(problem_);
        std::vector<Cause> causes =
            find_irreducible(std::span<const Cause>(all_), [&](std::span<const Cause> some) {
                return empty ? leave_nothing(some, *empty)
                             : verdict_of(some) == Verdict::kImpossible;
            });
        Contradiction conflict;
        std::vector<Cause> spare;
        conflict.is_minimal = is_each_needed(causes, spare);
        name_causes(causes, conflict);
        const Problem problem = problem_of(causes);
        find_cells(causes, problem, conflict);
        return Error{
            ErrorCode::kContradiction,
            in_words(causes, problem, conflict) + in_words(spare),
            {},
            conflict};
    }

  private:
    // What the request comes to with these causes alone.
    [[nodiscard]] Problem problem_of(std::span<const Cause> causes) const {
        auto problem = read_problem(example_, with_causes(example_, parameters_, causes));
        check(problem.has_value(), "a request that was read before cannot be read");
        if (std::find(causes.begin(), causes.end(), Cause{Cause::Kind::kOrigin}) != causes.end()) {
            narrow_to_kept(*problem_.start, problem->domains);
        }
        return std::move(*problem);
    }

    Verdict verdict_of(std::span<const Cause> causes) {
        if (!effort_.take(parameters_.size->cell_count()) || stop_.stop_requested()) {
            return Verdict::kUnknown;
        }
        const Judgement judgement = judge_whole(example_, problem_of(causes), stop_);
        effort_.spend(judgement.effort);
        return judgement.verdict;
    }

    static std::optional<Site> first_empty(const Problem& problem) {
        for (std::size_t site = 0; site < problem.domains.site_count(); ++site) {
            if (problem.domains.at(static_cast<Site>(site)).empty()) {
                return static_cast<Site>(site);
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] bool leave_nothing(std::span<const Cause> causes, Site site) {
        return effort_.take(parameters_.size->cell_count()) &&
               problem_of(causes).domains.at(site).empty();
    }

    // Whether without any one of the causes there is a model, as far as that can be found out. Adds
    // to `spare` those without which there is none either.
    [[nodiscard]] bool is_each_needed(const std::vector<Cause>& causes, std::vector<Cause>& spare) {
        bool is_each = true;
        for (const Cause& cause : causes) {
            std::vector<Cause> others = causes;
            std::erase(others, cause);
            const Verdict verdict = verdict_of(others);
            is_each = is_each && verdict == Verdict::kPossible;
            if (verdict == Verdict::kImpossible) {
                spare.push_back(cause);
            }
        }
        return is_each;
    }

    void name_causes(std::span<const Cause> causes, Contradiction& conflict) const {
        for (const Cause& cause : causes) {
            switch (cause.kind) {
                case Cause::Kind::kSide:
                    conflict.sides.emplace_back(kSideNames.at(cause.number));
                    break;
                case Cause::Kind::kConstraint: {
                    const Rule& rule = parameters_.constraints[cause.number].rule;
                    conflict.constraints.push_back({cause.number, kRuleNames.at(rule.index())});
                    break;
                }
                case Cause::Kind::kOrigin:
                    conflict.has_origin = true;
                    break;
                case Cause::Kind::kPeriodic:
                    conflict.periodic.emplace_back(1, "xyz"[cause.number]);
                    break;
                case Cause::Kind::kRemoved:
                    conflict.removed.push_back(example_.pieces[cause.number].name);
                    break;
            }
        }
    }

    void find_cells(
        std::span<const Cause> causes, const Problem& problem, Contradiction& conflict
    ) {
        std::vector<Cause> removed;
        for (const Cause& cause : causes) {
            if (cause.kind == Cause::Kind::kRemoved) {
                removed.push_back(cause);
            }
        }
        const LabelSet everything = problem_of(removed).domains.at(0);
        const Judgement judgement = judge_whole(example_, problem, stop_);
        const std::vector<Site> sites =
            find_conflict_cells(problem, everything, judgement.emptied, effort_, stop_);
        for (std::size_t i = 0; sites.size() <= kCellsMax && i < sites.size(); ++i) {
            std::vector<std::string> labels;
            for_each_label(problem.domains.words(sites[i]), [&](Label label) {
                labels.push_back(example_.pieces[label].name);
            });
            conflict.cells.push_back({problem.size.cell(sites[i]), std::move(labels)});
        }
    }

    [[nodiscard]] std::vector<std::string> names_of(std::span<const Cause> causes) const {
        std::vector<std::string> names;
        for (const Cause& cause : causes) {
            if (names.size() == kCausesInWordsMax) {
                names.push_back(std::to_string(causes.size() - kCausesInWordsMax) + " more");
                break;
            }
            names.push_back(name_cause(example_, parameters_, cause));
        }
        return names;
    }

    [[nodiscard]] std::string in_words(std::span<const Cause> spare) const {
        if (spare.empty()) {
            return "";
        }
        return std::string("; without ") + (spare.size() == 1 ? "" : "any one of ") +
               join_words(names_of(spare)) + " there is none either";
    }

    [[nodiscard]] std::string in_words(
        std::span<const Cause> causes, const Problem& problem, const Contradiction& conflict
    ) {
        std::string text = "no model of this size exists: ";
        const std::vector<std::string> names = names_of(causes);
        text += names.empty() ? list_names(example_, problem.domains.at(0)) +
                                    " cannot fill it, whatever stands at its sides"
                : names.size() == 1 ? names.front() + " cannot hold"
                                    : join_words(names) + " cannot hold together";
        std::vector<std::string> cells;
        for (const Contradiction::NamedCell& place : conflict.cells) {
            if (cells.size() == kCellsInWordsMax) {
                cells.push_back(
                    std::to_string(conflict.cells.size() - kCellsInWordsMax) + " more cells"
                );
                break;
            }
            cells.push_back(in_words(problem, place));
        }
        return text + (cells.empty() ? "" : ", see " + join_words(cells));
    }

    [[nodiscard]] std::string in_words(
        const Problem& problem, const Contradiction::NamedCell& place
    ) {
        const auto site = static_cast<Site>(parameters_.size->index(place.cell));
        std::string text = "cell " + name_cell(place.cell);
        if (!place.labels.empty()) {
            return text + " (only " + list_names(example_, problem.domains.at(site)) + ")";
        }
        const std::vector<std::string> demands = demands_at(site);
        return demands.empty() ? text : text + " (" + join_words(demands) + ")";
    }

    // What each cause of the request wants at the cell, whether or not it takes part in the
    // conflict: who has to change one of them may as well look at the others.
    [[nodiscard]] std::vector<std::string> demands_at(Site site) {
        const LabelSet everything = problem_of({}).domains.at(site);
        std::vector<std::string> demands;
        for (const Cause& cause : all_) {
            if (demands.size() == kDemandsMax || !effort_.take(parameters_.size->cell_count())) {
                break;
            }
            const LabelSet own = problem_of(std::span(&cause, 1)).domains.at(site);
            if (!(own == everything)) {
                demands.push_back(
                    "only " + list_names(example_, own) + " for " +
                    name_cause(example_, parameters_, cause)
                );
            }
        }
        return demands;
    }

    const Example& example_;
    const Parameters& parameters_;
    const Problem& problem_;
    std::vector<Cause> all_;
    const std::stop_token& stop_;
    Effort effort_;
};

}  // namespace

Error explain(
    Error error,
    const Example& example,
    const Parameters& parameters,
    const Problem& problem,
    const std::stop_token& stop
) {
    auto explained = Explainer(example, parameters, problem, stop).explain();
    if (stop.stop_requested()) {
        return {ErrorCode::kCancelled, "stopped", {}};
    }
    return explained ? std::move(*explained) : std::move(error);
}

}  // namespace modelsynth::discrete
