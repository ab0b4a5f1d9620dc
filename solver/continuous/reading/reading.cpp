#include "solver/continuous/reading/reading.h"

#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/reading/variants.h"
#include "solver/continuous/shapes/cut_boxes.h"
#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/symmetry/plane_images.h"
#include "solver/continuous/symmetry/shape_images.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
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

std::array<double, 3> steps_along_axes(const Parameters& parameters) {
    std::array<double, 3> steps;
    steps.fill(*parameters.spacing);
    for (const FamilySpacing& family : parameters.spacings) {
        const Point normal(family.normal[0], family.normal[1], family.normal[2]);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(normal[axis]) > (1 - kNormalTolerance) * normal.norm()) {
                steps[static_cast<std::size_t>(axis)] = family.spacing;
            }
        }
    }
    return steps;
}

// All that these turns and symmetries make of a model.
std::vector<TurnMatrix> with_symmetries(
    const std::vector<TurnMatrix>& turns, std::span<const SymmetryRule> symmetries
) {
    std::vector<TurnMatrix> generators = turns;
    for (const TurnMatrix& turn : turns_of(symmetries)) {
        generators.push_back(turn);
    }
    return symmetries.empty() ? turns : group_of(generators);
}

// The solids of shapes, and what was cut off them.
Example shapes_alone(Example example) {
    std::erase_if(example.polyhedra, [&example](const Polyhedron& solid) {
        return !has_image_by_shape(example, solid.object);
    });
    return example;
}

// Which objects become which does not depend on how boxes are cut, and cut ones have no images yet.
void fill_mirrors_without_cuts(const Example& example, ReadingOptions& options) {
    const bool are_filled = std::all_of(
        options.symmetries.begin(),
        options.symmetries.end(),
        [](const SymmetryRule& rule) { return rule.mirror.has_value(); }
    );
    if (are_filled) {
        return;
    }
    Example whole = with_whole_boxes(example);
    ReadingOptions of_whole;
    of_whole.variants = options.variants;
    for (const ObjectId object : options.apart) {
        if (options.variants != Variants() && object <= whole.objects.size()) {
            of_whole.apart.push_back(object);
        }
    }
    const auto reading = ExampleReading::make(std::move(whole), std::move(of_whole));
    for (SymmetryRule& rule : options.symmetries) {
        if (rule.mirror) {
            continue;
        }
        rule.mirror.emplace();
        if (!reading || !have_images((*reading)->topes(), turns_of(std::span(&rule, 1)).front())) {
            continue;
        }
        rule.mirror = likely_mirror(**reading, rule);
        const Example& read = (*reading)->example();
        std::erase_if(*rule.mirror, [&read](const auto& pair) {
            return read.objects[find_object(read, pair.first) - 1U].shape != nullptr ||
                   read.objects[find_object(read, pair.second) - 1U].shape != nullptr;
        });
    }
}

// A figure of the same cells, numbered otherwise.
Figure moved_to(const Topes& to, const Figure& figure, const Topes& from) {
    Figure moved(figure.size(), 0);
    for (std::size_t t = 0; t < figure.size(); ++t) {
        moved[t] = figure[from.tope_of(to.sides(static_cast<Tope>(t)))];
    }
    return moved;
}

}  // namespace

std::optional<std::size_t> ExampleReading::find_family(const Point& normal) const {
    for (std::size_t family = 0; family < normals_.size(); ++family) {
        const Point unit = normal.normalized();
        if ((normals_[family] - unit).norm() < kNormalTolerance ||
            (normals_[family] + unit).norm() < kNormalTolerance) {
            return family;
        }
    }
    return topes_.find_family(normal);
}

std::optional<std::size_t> ExampleReading::horizontal() const {
    for (std::size_t family = 0; family < topes_.family_count(); ++family) {
        if (topes_.normals()[family].y() > 1 - kNormalTolerance) {
            return family;
        }
    }
    return std::nullopt;
}

Result<std::shared_ptr<const ExampleReading>> ExampleReading::make(
    Example example, ReadingOptions options
) {
    return make_unshared(std::move(example), std::move(options)).map([](auto made) {
        return std::shared_ptr<const ExampleReading>(std::move(made));
    });
}

Result<std::shared_ptr<ExampleReading>> ExampleReading::make_unshared(
    Example example, ReadingOptions options
) {
    if (auto faults = find_solid_faults(example); !faults.empty()) {
        return tl::unexpected(Error{
            ErrorCode::kInvalidArgument,
            "the example has polyhedra that are no solids",
            std::move(faults)});
    }
    const std::vector<TurnMatrix> turns = turns_of(options.variants);
    const std::vector<TurnMatrix> all_turns = with_symmetries(turns, options.symmetries);
    if (example.objects.size() + (all_turns.size() - 1) * options.apart.size() > kObjectTypesMax) {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "turned objects that have a dimension or a shape count as others, and those come to "
            "more than " +
                std::to_string(kObjectTypesMax)});
    }
    example = with_variant_objects(std::move(example), all_turns, options.apart);
    std::vector<Example> images;
    for (const TurnMatrix& turn : turns) {
        images.push_back(turned_solids(example, turn));
    }
    std::vector<Example> with_faces = images;
    for (std::size_t i = 1; i < all_turns.size() && !options.symmetries.empty(); ++i) {
        with_faces.push_back(turned_solids(shapes_alone(example), all_turns[i]));
    }
    auto families = find_families(with_faces);
    if (!families) {
        return tl::unexpected(std::move(families.error()));
    }
    auto topes = Topes::make(families->normals);
    if (!topes) {
        return tl::unexpected(std::move(topes.error()));
    }
    std::vector<Figure> seeds;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::size_t count = images[i].polyhedra.size();
        const auto planes = std::span(families->planes).subspan(i * count, count);
        auto figures = read_figures(images[i], planes, *topes, images.size());
        if (!figures) {
            return tl::unexpected(std::move(figures.error()));
        }
        std::move(figures->begin(), figures->end(), std::back_inserter(seeds));
    }
    if (!options.symmetries.empty()) {
        add_images_of_shapes(seeds, *topes, example, options.symmetries, kFiguresMax);
    }
    std::optional<Nudged> nudged;
    if (options.nudge_degrees > 0) {
        nudged = nudge(*topes, options.steps, options.nudge_degrees);
        if (nudged && nudged->largest_degrees == 0) {
            nudged.reset();
        }
    }
    if (nudged) {
        Topes turned = Topes::make(nudged->normals).value();
        for (Figure& seed : seeds) {
            seed = moved_to(turned, seed, *topes);
        }
        topes = std::move(turned);
    }
    std::shared_ptr<ExampleReading> made(new ExampleReading(
        std::move(example), std::move(options), std::move(families->normals), std::move(*topes)
    ));
    made->nudged_ = std::move(nudged);
    auto figures = Figures::make(made->topes_, seeds, kFiguresMax);
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
    return made;
}

Result<std::shared_ptr<const ExampleReading>> ExampleReading::read_for(
    const std::shared_ptr<const ExampleReading>& reading, const Parameters& parameters
) {
    const auto& plain = reading->plain_ == nullptr ? reading : reading->plain_;
    auto volumes = bounding_volumes_of(plain->example(), parameters);
    if (!volumes) {
        return tl::unexpected(std::move(volumes.error()));
    }
    std::optional<Example> changed;
    if (!volumes->empty()) {
        changed = with_bounding_volumes(plain->example(), *volumes);
    }
    const Example& example = changed ? *changed : plain->example();
    ReadingOptions options = {
        parameters.variants, {}, {}, std::move(*volumes), parameters.nudge, {}};
    if (options.variants != Variants()) {
        options.apart = turned_apart(example, parameters);
    }
    options.symmetries = symmetries_of_shapes(example, parameters);
    if (!options.symmetries.empty()) {
        if (options.variants == Variants()) {
            options.apart = shapes_of(example);
        }
        fill_mirrors_without_cuts(example, options);
    }
    if (options.nudge_degrees > 0) {
        options.steps = steps_along_axes(parameters);
    }
    if (options == reading->options_) {
        return reading;
    }
    if (options == plain->options_) {
        return plain;
    }
    const std::lock_guard lock(plain->mutex_);
    std::erase_if(plain->others_, [](const auto& other) { return other.second.expired(); });
    for (const auto& [of_other, other] : plain->others_) {
        if (auto found = other.lock(); found && of_other == options) {
            return found;
        }
    }
    auto made = make_unshared(example, options);
    if (!made) {
        return tl::unexpected(std::move(made.error()));
    }
    (*made)->plain_ = plain;
    plain->others_.emplace_back(std::move(options), *made);
    return std::move(*made);
}

}  // namespace modelsynth::continuous
