#include "solver/discrete/explanation/judge.h"

#include "solver/discrete/box_search.h"
#include "solver/discrete/constraint_reader.h"
#include "solver/discrete/explanation/effort.h"
#include "solver/discrete/initial_model.h"
#include "solver/discrete/whole_by_sat.h"

#include <memory>
#include <vector>

namespace modelsynth::discrete {

namespace {

constexpr std::uint32_t kAttempts = 4;

}  // namespace

Judgement judge_whole(const Example& example, const Problem& problem, const std::stop_token& stop) {
    Judgement judgement;
    judgement.effort = problem.size.cell_count();
    const bool has_rules = !problem.member_rules.empty();
    if (!has_rules && find_plain_model(example, problem)) {
        judgement.verdict = Verdict::kPossible;
        return judgement;
    }
    BoxSearch search(problem);
    std::vector<Label> model(problem.size.cell_count(), kNoLabel);
    std::unique_ptr<ConstraintBoard> board;
    BoxOptions options = {kAttempts};
    if (has_rules) {
        board = make_board(problem, problem.member_rules);
        board->start(model);
        options.board = board.get();
    }
    const BlockResult result = search.modify(Box::whole(problem.size), model, options, {}, stop);
    if (result.outcome == BlockOutcome::kAccepted) {
        judgement.verdict = Verdict::kPossible;
    } else if (result.outcome == BlockOutcome::kImpossible) {
        judgement.verdict = Verdict::kImpossible;
        if (!result.impossible_constraint) {
            judgement.emptied = result.impossible_site;
        }
    } else if (result.outcome == BlockOutcome::kReverted) {
        const WholeBySat by_sat = solve_whole_by_sat(problem, 0, stop);
        judgement.effort +=
            by_sat.result.literal_count + kConflictEffort * by_sat.result.conflict_count;
        if (by_sat.result.outcome == SatOutcome::kImpossible) {
            judgement.verdict = Verdict::kImpossible;
        } else if (by_sat.result.outcome == SatOutcome::kSolved && !has_rules) {
            judgement.verdict = Verdict::kPossible;
        }
    }
    return judgement;
}

}  // namespace modelsynth::discrete
