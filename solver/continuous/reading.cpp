#include "solver/continuous/reading.h"

#include "solver/continuous/check/solid_check.h"

#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// A request's tables grow with the square of it.
constexpr std::size_t kFiguresMax = 4096;

// Two figures may stand at the ends of an edge when they look the same from inside of it.
Relations relate(const Figures& figures) {
    const std::size_t headings = figures.topes().heading_count();
    std::vector<RelationId> reverse(headings);
    for (std::size_t heading = 0; heading < headings; ++heading) {
        reverse[heading] = opposite(static_cast<Heading>(heading));
    }
    Relations relations(figures.count(), std::move(reverse));
    std::vector<std::vector<Label>> ends(figures.count());  // by what they look like back along it
    for (std::size_t heading = 0; heading < headings; heading += 2) {
        const auto forth = static_cast<Heading>(heading);
        for (std::vector<Label>& same : ends) {
            same.clear();
        }
        for (std::size_t label = 0; label < figures.count(); ++label) {
            const auto far = static_cast<Label>(label);
            ends[figures.along(far, opposite(forth))].push_back(far);
        }
        for (std::size_t label = 0; label < figures.count(); ++label) {
            const auto near = static_cast<Label>(label);
            for (const Label far : ends[figures.along(near, forth)]) {
                relations.allow(forth, near, far);
            }
        }
    }
    return relations;
}

}  // namespace

std::optional<std::size_t> ExampleReading::horizontal() const {
    for (std::size_t family = 0; family < topes_.family_count(); ++family) {
        if (topes_.normals()[family].y() > 1 - kNormalTolerance) {
            return family;
        }
    }
    return std::nullopt;
}

Result<std::shared_ptr<const ExampleReading>> ExampleReading::make(Example example) {
    if (auto faults = find_solid_faults(example); !faults.empty()) {
        return tl::unexpected(Error{
            ErrorCode::kInvalidArgument,
            "the example has polyhedra that are no solids",
            std::move(faults)});
    }
    auto families = find_families(example);
    if (!families) {
        return tl::unexpected(std::move(families.error()));
    }
    auto topes = Topes::make(families->normals);
    if (!topes) {
        return tl::unexpected(std::move(topes.error()));
    }
    std::shared_ptr<ExampleReading> made(
        new ExampleReading(std::move(example), std::move(*families), std::move(*topes))
    );
    const auto seeds = read_figures(made->example_, made->families_, made->topes_);
    if (!seeds) {
        return tl::unexpected(seeds.error());
    }
    auto figures = Figures::make(made->topes_, *seeds, kFiguresMax);
    if (!figures) {
        return tl::unexpected(std::move(figures.error()));
    }
    made->figures_.emplace(std::move(*figures));
    if (const auto ground = made->example_.ground) {
        const Figure bare = face_figure(made->topes_, *made->horizontal(), *ground, kEmpty);
        if (made->figures_->find(bare) == kNoLabel) {
            return tl::unexpected(Error{
                ErrorCode::kInvalidArgument,
                "the ground of the example is bare nowhere, so there is no model to begin with"});
        }
    }
    made->relations_.emplace(relate(*made->figures_));
    return std::shared_ptr<const ExampleReading>(std::move(made));
}

}  // namespace modelsynth::continuous
