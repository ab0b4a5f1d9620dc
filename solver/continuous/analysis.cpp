#include "solver/continuous/analysis.h"

#include "solver/continuous/display/expressions.h"
#include "solver/continuous/planes/spacing.h"
#include "solver/continuous/reading/reading.h"

#include <algorithm>

namespace modelsynth::continuous {

namespace {

std::vector<Analysis::Figure> list_figures(const ExampleReading& reading) {
    const Topes& topes = reading.topes();
    const Figures& figures = reading.figures();
    ExpressionWriter writer(topes);
    std::vector<Analysis::Figure> list;
    for (std::size_t i = 0; i < std::min(figures.count(), Analysis::kFiguresListedMax); ++i) {
        const auto label = static_cast<Label>(i);
        const FamilySet relevant = figures.relevant(label);
        Analysis::Figure& figure = list.emplace_back();
        figure.rank = rank_of(topes, relevant);
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            if ((relevant >> family & 1) != 0) {
                figure.families.push_back(family);
            }
        }
        for (const ObjectId object : objects_in(figures.at(label))) {
            figure.parts.push_back(
                {reading.example().objects[object - 1U].name,
                 writer.write(figures.at(label), object)}
            );
        }
    }
    return list;
}

}  // namespace

Analysis analyse(const ExampleReading& reading) {
    Analysis analysis;
    const Topes& topes = reading.topes();
    const Figures& figures = reading.figures();
    const std::vector<double> free(topes.family_count(), 0);
    const Spacings spacings = solve_spacings(figures, reading.example().spacing, free);
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        const Point& normal = topes.normals()[family];
        analysis.families.push_back(
            {{normal.x(), normal.y(), normal.z()}, spacings.of_family[family]}
        );
    }
    analysis.figures = figures.count();
    for (std::size_t label = 0; label < figures.count(); ++label) {
        const FamilySet relevant = figures.relevant(static_cast<Label>(label));
        analysis.corner_figures += std::size_t{rank_of(topes, relevant) == 3};
    }
    analysis.figure_list = list_figures(reading);
    analysis.warnings = spacings.conflicts;
    if (topes.family_count() > 12) {
        analysis.warnings.push_back(
            "the faces of the example have " + std::to_string(topes.family_count()) +
            " directions; time and memory grow with the cube of their number"
        );
    }
    return analysis;
}

}  // namespace modelsynth::continuous
