#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>

namespace modelsynth {

enum class CnfOutcome : std::uint8_t {
    kSatisfied,
    kUnsatisfiable,  // proved
    kGaveUp,         // as many conflicts as were allowed
    kStopped,        // the stop token was requested
};

// A formula in conjunctive normal form and CaDiCaL (github.com/arminbiere/cadical), which decides
// it. Variables are numbered from 1; a literal is a variable, or its negative where it is false.
//
// Equal calls in equal order have equal outcomes: the solver is one thread that counts its steps
// and looks at no clock.
// Thread-safety: one thread at a time; distinct objects may be used from distinct threads.
class CnfSolver {
  public:
    using Literal = std::int32_t;

    explicit CnfSolver(std::uint32_t seed);
    ~CnfSolver();
    CnfSolver(const CnfSolver&) = delete;
    CnfSolver& operator=(const CnfSolver&) = delete;

    // At least one of the literals holds; of none, nothing can.
    void add(std::span<const Literal> clause);

    // All literals of all clauses: what memory goes with.
    [[nodiscard]] std::size_t literal_count() const { return literal_count_; }

    // Where the solver may choose, the literal holds.
    void prefer(Literal literal);

    // Whether all clauses and, this time, all literals of `assumed` can hold.
    // Cost: unbounded in theory, within seconds for some ten thousand conflicts in practice.
    [[nodiscard]] CnfOutcome solve(
        std::span<const Literal> assumed, std::uint32_t conflicts_max, const std::stop_token& stop
    );

    // After kSatisfied: whether the variable is true.
    [[nodiscard]] bool is_true(Literal variable) const;

    // After kUnsatisfiable: whether an assumed literal is one of those that cannot hold together.
    [[nodiscard]] bool is_in_core(Literal assumed) const;

    // Dead ends that were learned from, in all calls of solve().
    [[nodiscard]] std::uint64_t conflict_count() const;

  private:
    struct Backend;

    std::unique_ptr<Backend> backend_;
    std::size_t literal_count_ = 0;
};

}  // namespace modelsynth
