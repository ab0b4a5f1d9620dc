#pragma once

#include "solver/core/label_set.h"
#include "solver/core/random.h"
#include "solver/core/relations.h"
#include "solver/core/sat/cnf_solver.h"
#include "solver/core/site_weights.h"
#include "solver/core/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth {

// That every site takes one label of its set, and that the two ends of every arc allow each other,
// as a formula: a variable for each label of each site, of which exactly one a site is true, and
// for each label and each arc a clause that one of its partners stands at the far end (the direct
// encoding, with Gent's support clauses: "Arc consistency in SAT", ECAI 2002). Unit propagation
// then sees what arc consistency sees.
// Cost: literals go with sites * labels * partners; about 30 bytes each.
// Thread-safety: one thread at a time.
class LabelFormula {
  public:
    // Something said of a site that holds only when it is assumed.
    enum class Guard : std::int32_t {};

    // Shape:    sets holds relations.words() words a site, as Catalog::all_labels().
    // Requires: the relations outlive it.
    // A formula that comes to more literals than `literals_max` is given up: is_too_large().
    LabelFormula(
        const Relations& relations,
        std::span<const Word> sets,
        std::size_t literals_max,
        std::uint32_t seed
    );

    // Every arc of the topology allows what its relation allows.
    template <Topology T>
    void add_arcs(const T& topology) {
        for (std::size_t i = 0; i < site_count(); ++i) {
            const auto site = static_cast<Site>(i);
            topology.for_each_arc(site, [&](Site far, RelationId relation) {
                if (!is_too_large()) {
                    add_arc(site, far, relation);
                }
            });
        }
    }

    // The site takes one of these labels whenever the guard is assumed.
    [[nodiscard]] Guard narrow_if_assumed(Site site, std::span<const Word> allowed);

    // Labels drawn by weight are tried first, so that not every model is the same dull one.
    void prefer_drawn(const PartWeights& weights, RandomStream& random);

    [[nodiscard]] bool is_too_large() const { return solver_.literal_count() > literals_max_; }

    [[nodiscard]] std::size_t literal_count() const { return solver_.literal_count(); }

    [[nodiscard]] std::size_t site_count() const { return first_.size() - 1; }

    [[nodiscard]] std::uint64_t conflict_count() const { return solver_.conflict_count(); }

    // Requires: not is_too_large() (checked).
    [[nodiscard]] CnfOutcome solve(
        std::span<const Guard> assumed, std::uint32_t conflicts_max, const std::stop_token& stop
    );

    // After kSatisfied: the label of the site.
    [[nodiscard]] Label label(Site site) const;

    // After kUnsatisfiable: whether the guard is one of those that cannot hold together.
    [[nodiscard]] bool is_in_core(Guard guard) const;

  private:
    using Literal = CnfSolver::Literal;

    [[nodiscard]] std::span<const Word> set(Site site) const {
        return {sets_.data() + site * relations_.words(), relations_.words()};
    }

    // Calls visit(Label, Literal) for every label of the site.
    template <class Visit>
    void for_each_variable(Site site, Visit visit) const {
        Literal variable = first_[site];
        for_each_label(set(site), [&](Label label) { visit(label, variable++); });
    }

    void add_exactly_one(Site site);
    void add_arc(Site near, Site far, RelationId relation);

    const Relations& relations_;
    std::vector<Word> sets_;
    std::size_t literals_max_;
    CnfSolver solver_;
    std::vector<Literal> first_;  // by site: the variable of its first label; and past the last
    Literal next_ = 1;            // variable that is not used yet
    std::vector<Literal> clause_;
};

}  // namespace modelsynth
