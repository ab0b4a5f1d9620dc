#include "solver/core/sat/cnf_solver.h"

#include "solver/core/result.h"

#include <cadical.hpp>

#include <algorithm>
#include <limits>

namespace modelsynth {

namespace {

class StopTerminator final : public CaDiCaL::Terminator {
  public:
    explicit StopTerminator(const std::stop_token& stop) : stop_(stop) {}

    bool terminate() override { return stop_.stop_requested(); }

  private:
    const std::stop_token& stop_;
};

// Takes no clause, but is asked about each: one a conflict.
class ConflictCounter final : public CaDiCaL::Learner {
  public:
    bool learning(int /*size*/) override {
        ++count_;
        return false;
    }

    void learn(int /*literal*/) override {}

    [[nodiscard]] std::uint64_t count() const { return count_; }

  private:
    std::uint64_t count_ = 0;
};

}  // namespace

struct CnfSolver::Backend {
    ConflictCounter conflicts;
    CaDiCaL::Solver solver;
};

CnfSolver::CnfSolver(std::uint32_t seed) : backend_(std::make_unique<Backend>()) {
    CaDiCaL::Solver& solver = backend_->solver;
    bool known = solver.set("quiet", 1);
    known = solver.set("seed", static_cast<int>(seed & 0x3FFFFFFF)) && known;
    // Variables are false unless something else is preferred, and the easy models that lie ahead in
    // a straight line, the same for every seed, are not looked for.
    known = solver.set("phase", 0) && known;
    known = solver.set("lucky", 0) && known;
    check(known, "an option that CaDiCaL does not know");
    solver.connect_learner(&backend_->conflicts);
}

CnfSolver::~CnfSolver() { backend_->solver.disconnect_learner(); }

void CnfSolver::add(std::span<const Literal> clause) {
    for (const Literal literal : clause) {
        backend_->solver.add(literal);
    }
    backend_->solver.add(0);
    literal_count_ += clause.size();
}

void CnfSolver::prefer(Literal literal) { backend_->solver.phase(literal); }

CnfOutcome CnfSolver::solve(
    std::span<const Literal> assumed, std::uint32_t conflicts_max, const std::stop_token& stop
) {
    constexpr int kSatisfiable = 10;
    constexpr int kUnsatisfiable = 20;
    CaDiCaL::Solver& solver = backend_->solver;
    for (const Literal literal : assumed) {
        solver.assume(literal);
    }
    constexpr auto kMost = static_cast<std::uint32_t>(std::numeric_limits<int>::max());
    solver.limit("conflicts", static_cast<int>(std::min(conflicts_max, kMost)));
    StopTerminator terminator(stop);
    solver.connect_terminator(&terminator);
    const int answer = solver.solve();
    solver.disconnect_terminator();
    return answer == kSatisfiable     ? CnfOutcome::kSatisfied
           : answer == kUnsatisfiable ? CnfOutcome::kUnsatisfiable
           : stop.stop_requested()    ? CnfOutcome::kStopped
                                      : CnfOutcome::kGaveUp;
}

bool CnfSolver::is_true(Literal variable) const { return backend_->solver.val(variable) > 0; }

bool CnfSolver::is_in_core(Literal assumed) const { return backend_->solver.failed(assumed); }

std::uint64_t CnfSolver::conflict_count() const { return backend_->conflicts.count(); }

}  // namespace modelsynth
