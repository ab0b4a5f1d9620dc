#include "solver/continuous/warnings.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace modelsynth::continuous {

namespace {

// "h1, h3 and h5", as expressions call the half-spaces of these families.
std::string names_of(FamilySet families) {
    std::string names;
    for (std::size_t family = 0; family < kFamiliesMax; ++family) {
        if ((families >> family & 1) == 0) {
            continue;
        }
        families &= ~only(family);
        names += (names.empty()   ? "h"
                  : families == 0 ? " and h"
                                  : ", h") +
                 std::to_string(family + 1);
    }
    return names;
}

std::string without_place(std::size_t some, std::size_t all, FamilySet families) {
    return std::to_string(some) + " of " + std::to_string(all) +
           (some == 1 ? " figures has" : " figures have") +
           " no place: no point of the model has planes of families " + names_of(families) +
           " at once";
}

}  // namespace

std::vector<std::string> warnings_of(const Problem& problem) {
    const Figures& figures = problem.reading->figures();
    std::map<FamilySet, std::size_t> without;
    for (const Label label : problem.homeless) {
        ++without[figures.relevant(label)];
    }
    std::vector<std::string> warnings;
    if (const Nudged* nudged = problem.reading->nudged()) {
        char text[96];
        std::snprintf(
            text,
            sizeof text,
            "faces are turned by up to %.3g degrees, so that their planes meet",
            nudged->largest_degrees
        );
        warnings.emplace_back(text);
    }
    for (const auto& [families, count] : without) {
        warnings.push_back(without_place(count, figures.count(), families));
    }
    if (problem.symmetries && problem.symmetries->imageless() > 0) {
        const std::size_t some = problem.symmetries->imageless();
        warnings.push_back(
            std::to_string(some) + " of " + std::to_string(figures.count()) +
            (some == 1 ? " figures is left out: the example does not have its image"
                       : " figures are left out: the example does not have their images")
        );
    }
    const std::vector<std::string>& conflicts = problem.spacings.conflicts;
    warnings.insert(warnings.end(), conflicts.begin(), conflicts.end());
    if (warnings.size() > kWarningsMax) {
        const std::size_t left_out = warnings.size() - (kWarningsMax - 1);
        warnings.resize(kWarningsMax - 1);
        warnings.push_back("and " + std::to_string(left_out) + " more of the kind");
    }
    return warnings;
}

}  // namespace modelsynth::continuous
