#include "solver/discrete/explanation/cause.h"

#include "solver/discrete/names.h"

#include <algorithm>
#include <variant>

namespace modelsynth::discrete {

namespace {

// Others only prefer some models to others, as a probability other than 0.
bool is_cause(const Constraint& constraint) {
    const auto* probability = std::get_if<Probability>(&constraint.rule);
    return probability != nullptr
               ? probability->weight == 0
               : names_pieces(constraint.rule) || std::holds_alternative<Symmetry>(constraint.rule);
}

constexpr std::size_t axis_of(std::size_t side) { return side / 2; }

}  // namespace

std::vector<Cause> find_causes(
    const Example& example, const Parameters& parameters, const Problem& problem
) {
    std::vector<Cause> causes;
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const BoundaryKind kind = parameters.boundary[side]->kind;
        if (kind == BoundaryKind::kPieces || kind == BoundaryKind::kExample) {
            causes.push_back({Cause::Kind::kSide, side});
        }
    }
    for (std::size_t i = 0; i < parameters.constraints.size(); ++i) {
        if (is_cause(parameters.constraints[i])) {
            causes.push_back({Cause::Kind::kConstraint, i});
        }
    }
    if (problem.start) {
        causes.push_back({Cause::Kind::kOrigin, 0});
    }
    for (std::size_t side = 0; side < kDirectionCount; side += 2) {
        if (parameters.boundary[side]->kind == BoundaryKind::kPeriodic) {
            causes.push_back({Cause::Kind::kPeriodic, axis_of(side)});
        }
    }
    const LabelSet known = usable_labels(example, std::vector<double>(example.pieces.size(), 1.0));
    for_each_label(known.words(), [&](Label label) {
        if (problem.weights.table(0).of(label) == 0) {
            causes.push_back({Cause::Kind::kRemoved, label});
        }
    });
    return causes;
}

Parameters with_causes(
    const Example& example, const Parameters& parameters, std::span<const Cause> causes
) {
    const auto has = [&causes](Cause::Kind kind, std::size_t number) {
        return std::find(causes.begin(), causes.end(), Cause{kind, number}) != causes.end();
    };
    Parameters kept = parameters;
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const bool is_periodic = parameters.boundary[side]->kind == BoundaryKind::kPeriodic;
        if (!(is_periodic ? has(Cause::Kind::kPeriodic, axis_of(side))
                          : has(Cause::Kind::kSide, side))) {
            kept.boundary[side] = SideBoundary{};
        }
    }
    kept.constraints.clear();
    for (std::size_t i = 0; i < parameters.constraints.size(); ++i) {
        if (has(Cause::Kind::kConstraint, i)) {
            kept.constraints.push_back(parameters.constraints[i]);
        }
    }
    WeightList weights;
    for (const Cause& cause : causes) {
        if (cause.kind == Cause::Kind::kRemoved) {
            weights.emplace_back(example.pieces[cause.number].name, 0.0);
        }
    }
    kept.weights = std::move(weights);
    return kept;
}

std::string name_cause(const Example& example, const Parameters& parameters, const Cause& cause) {
    switch (cause.kind) {
        case Cause::Kind::kSide:
            return std::string("the ") + kSideNames.at(cause.number) + " side";
        case Cause::Kind::kConstraint: {
            const Constraint& constraint = parameters.constraints[cause.number];
            const LabelSet pieces = set_of(labels_by_name(example), constraint.pieces);
            return name_rule(example, {cause.number, constraint.rule, pieces, {}});
        }
        case Cause::Kind::kOrigin:
            return "what is kept of the model that this one starts from";
        case Cause::Kind::kPeriodic:
            return std::string("the periodic ") + "xyz"[cause.number] + " axis";
        case Cause::Kind::kRemoved:
            break;
    }
    return "the removal of \"" + example.pieces[cause.number].name + "\"";
}

}  // namespace modelsynth::discrete
