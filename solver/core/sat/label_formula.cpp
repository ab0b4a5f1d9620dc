#include "solver/core/sat/label_formula.h"

#include "solver/core/result.h"

#include <array>

namespace modelsynth {

LabelFormula::LabelFormula(
    const Relations& relations,
    std::span<const Word> sets,
    std::size_t literals_max,
    std::uint32_t seed
)
    : relations_(relations),
      sets_(sets.begin(), sets.end()),
      literals_max_(literals_max),
      solver_(seed) {
    const std::size_t sites = sets.size() / relations.words();
    first_.reserve(sites + 1);
    for (std::size_t site = 0; site < sites; ++site) {
        first_.push_back(next_);
        next_ += static_cast<Literal>(count_labels(set(static_cast<Site>(site))));
    }
    first_.push_back(next_);
    for (std::size_t site = 0; site < sites && !is_too_large(); ++site) {
        add_exactly_one(static_cast<Site>(site));
    }
}

LabelFormula::Guard LabelFormula::narrow_if_assumed(Site site, std::span<const Word> allowed) {
    const Literal guard = next_++;
    for_each_variable(site, [&](Label label, Literal variable) {
        if ((allowed[label / kWordBits] >> (label % kWordBits) & 1) == 0) {
            solver_.add(std::array{-guard, -variable});
        }
    });
    return static_cast<Guard>(guard);
}

void LabelFormula::prefer_drawn(const PartWeights& weights, RandomStream& random) {
    for (std::size_t i = 0; i < site_count(); ++i) {
        const auto site = static_cast<Site>(i);
        if (!has_several(set(site))) {
            continue;
        }
        const Label drawn = weights.at(site).draw(set(site), random);
        for_each_variable(site, [&](Label label, Literal variable) {
            if (label == drawn) {
                solver_.prefer(variable);
            }
        });
    }
}

CnfOutcome LabelFormula::solve(
    std::span<const Guard> assumed, std::uint32_t conflicts_max, const std::stop_token& stop
) {
    check(!is_too_large(), "a formula that is not whole was to be solved");
    clause_.clear();
    for (const Guard guard : assumed) {
        clause_.push_back(static_cast<Literal>(guard));
    }
    return solver_.solve(clause_, conflicts_max, stop);
}

Label LabelFormula::label(Site site) const {
    Label found = kNoLabel;
    for_each_variable(site, [&](Label label, Literal variable) {
        if (solver_.is_true(variable)) {
            found = label;
        }
    });
    return found;
}

bool LabelFormula::is_in_core(Guard guard) const {
    return solver_.is_in_core(static_cast<Literal>(guard));
}

// At most one: pair by pair where labels are few, else by Sinz's sequential counter ("Towards an
// optimal CNF encoding of Boolean cardinality constraints", CP 2005): a chain of variables that say
// whether a label so far is true.
void LabelFormula::add_exactly_one(Site site) {
    constexpr Literal kPairsMax = 6;
    const Literal begin = first_[site];
    const Literal end = first_[site + 1];
    clause_.clear();
    for (Literal variable = begin; variable < end; ++variable) {
        clause_.push_back(variable);
    }
    solver_.add(clause_);
    if (end - begin <= kPairsMax) {
        for (Literal a = begin; a < end; ++a) {
            for (Literal b = begin; b < a; ++b) {
                solver_.add(std::array{-a, -b});
            }
        }
        return;
    }
    for (Literal variable = begin; variable + 1 < end; ++variable) {
        const Literal so_far = next_++;
        solver_.add(std::array{-variable, so_far});
        if (variable > begin) {
            solver_.add(std::array{-(so_far - 1), so_far});
        }
        solver_.add(std::array{-(variable + 1), -so_far});
    }
}

void LabelFormula::add_arc(Site near, Site far, RelationId relation) {
    for_each_variable(near, [&](Label label, Literal variable) {
        const std::span<const Word> partners = relations_.row(relation, label);
        clause_.assign(1, -variable);
        bool any_lacks = false;
        for_each_variable(far, [&](Label partner, Literal partner_variable) {
            if ((partners[partner / kWordBits] >> (partner % kWordBits) & 1) != 0) {
                clause_.push_back(partner_variable);
            } else {
                any_lacks = true;
            }
        });
        if (any_lacks) {  // else the far site's own clause says it
            solver_.add(clause_);
        }
    });
}

}  // namespace modelsynth
