#include "solver/discrete/analysis/warnings.h"

#include "solver/core/result.h"
#include "solver/discrete/names.h"

#include <algorithm>
#include <utility>

namespace modelsynth::discrete {

namespace {

std::vector<Label> listed(const LabelSet& labels) {
    std::vector<Label> list;
    for_each_label(labels.words(), [&list](Label label) { list.push_back(label); });
    return list;
}

// A warning of all labels of the set together: their names, then what is so of one or of several.
void add(
    std::vector<Warning>& warnings,
    WarningCode code,
    const Example& example,
    const LabelSet& labels,
    const std::pair<const char*, const char*>& of_one_or_several
) {
    if (labels.empty()) {
        return;
    }
    const auto& [of_one, of_several] = of_one_or_several;
    warnings.push_back(
        {code,
         list_names(example, labels) + (labels.count() == 1 ? of_one : of_several),
         listed(labels)}
    );
}

Warning warn_of(const Example& example, const ForcedPatch& patch) {
    LabelSet forced = patch.labels;
    forced.erase(patch.label);
    Warning warning = {
        WarningCode::kForcesCopy,
        "Where \"" + example.pieces[patch.label].name + "\" stands, " +
            (patch.is_whole ? "" : "at least ") + std::to_string(patch.cell_count) +
            " cells are copied from the example" +
            (forced.empty() ? "" : ", with " + list_names(example, forced)) + ".",
        {patch.label}};
    for_each_label(forced.words(), [&warning](Label label) { warning.labels.push_back(label); });
    return warning;
}

void add_copies(std::vector<Warning>& warnings, const Example& example, const LabelFacts& facts) {
    std::vector<const ForcedPatch*> patches;
    for (const ForcedPatch& patch : facts.forced) {
        patches.push_back(&patch);
    }
    std::stable_sort(patches.begin(), patches.end(), [](const auto* a, const auto* b) {
        return a->cell_count > b->cell_count;
    });
    for (const ForcedPatch* patch : patches) {
        warnings.push_back(warn_of(example, *patch));
    }
}

}  // namespace

const char* name_of(WarningCode code) {
    switch (code) {
        case WarningCode::kNothingFits:
            return "nothing_fits";
        case WarningCode::kNeverStands:
            return "never_stands";
        case WarningCode::kUnreachable:
            return "unreachable";
        case WarningCode::kStandsOnce:
            return "stands_once";
        case WarningCode::kForcesCopy:
            return "forces_copy";
        case WarningCode::kNothingRepeats:
            return "nothing_repeats";
        case WarningCode::kNoPlainModel:
            return "no_plain_model";
    }
    return "";
}

std::vector<Warning> list_warnings(const Example& example, const LabelFacts& facts) {
    check(facts.counts.size() == example.pieces.size(), "facts of another example");
    std::vector<Warning> warnings;
    if (facts.contradiction) {
        warnings.push_back(
            {WarningCode::kNothingFits,
             "Nothing fits the boundary: " + *facts.contradiction + ".",
             {}}
        );
    }
    add(warnings,
        WarningCode::kNeverStands,
        example,
        facts.absent,
        {" stands nowhere in the example, so it is never used.",
         " stand nowhere in the example, so they are never used."});
    add(warnings,
        WarningCode::kUnreachable,
        example,
        facts.unreachable,
        {" can stand nowhere in a model with this boundary.",
         " can stand nowhere in a model with this boundary."});
    add(warnings,
        WarningCode::kStandsOnce,
        example,
        facts.once,
        {" stands only once in the example, so it always has the same neighbours.",
         " stand only once in the example each, so they always have the same neighbours."});
    add_copies(warnings, example, facts);
    if (facts.repeating.empty()) {
        warnings.push_back(
            {WarningCode::kNothingRepeats,
             "No piece stands next to itself along every axis, so there is nothing to fill the "
             "space between things with.",
             {}}
        );
    }
    if (!facts.contradiction && !facts.has_plain_model) {
        warnings.push_back(
            {WarningCode::kNoPlainModel,
             "No model of one piece a floor fits this boundary, so the first model has to be "
             "searched for.",
             {}}
        );
    }
    return warnings;
}

}  // namespace modelsynth::discrete
