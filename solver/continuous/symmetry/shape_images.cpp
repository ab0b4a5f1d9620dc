#include "solver/continuous/symmetry/shape_images.h"

#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/symmetry/figure_mover.h"
#include "solver/continuous/symmetry/motion.h"
#include "solver/continuous/symmetry/plane_images.h"
#include "solver/core/label_images.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

namespace modelsynth::continuous {

namespace {

// Places of a shape's corners are told apart by so many steps along its box.
constexpr double kStepsAlongBox = 1e5;

using Place = std::array<std::int64_t, 3>;

// The corners of every face of a turned shape, about the middle of its box: equal for what looks
// alike in a box.
std::vector<std::vector<Place>> look_of(const Shape& shape, const TurnMatrix& turn) {
    Eigen::AlignedBox3d box;
    for (const Point& corner : shape.corners) {
        box.extend(corner);
    }
    std::vector<std::vector<Place>> faces;
    for (const Face& face : shape.faces) {
        std::vector<Place>& places = faces.emplace_back();
        for (const std::uint32_t corner : face) {
            const Point share =
                turn * (shape.corners[corner] - box.center()).cwiseQuotient(box.sizes());
            Place& place = places.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis) {
                place.at(axis) =
                    std::llround(share[static_cast<Eigen::Index>(axis)] * kStepsAlongBox);
            }
        }
        std::sort(places.begin(), places.end());
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

// Whether a box that is cut so is cut alike when it is turned; see cut_boxes().
bool is_cut_alike(const Shape& shape, const TurnMatrix& turn) {
    const auto& is_even = shape.is_even;
    const Point normal(is_even[0] ? 1 : 0, is_even[1] ? 1 : 0, is_even[2] ? 1 : 0);
    return turn * normal == normal || turn * normal == -normal;
}

bool is_own_image(const Shape& shape, const TurnMatrix& turn) {
    return is_cut_alike(shape, turn) &&
           look_of(shape, turn) == look_of(shape, TurnMatrix::Identity());
}

// A mirror that cannot be is a fault of the request, and says nothing of figures.
std::vector<std::pair<Label, Label>> sound_pairs(const Example& example, const SymmetryRule& rule) {
    const NamePairs names = rule.mirror.value_or(NamePairs());
    const auto is_known = [&](const std::string& name) {
        return name == kEmptyName || find_object(example, name) != kEmpty;
    };
    const bool are_known = std::all_of(names.begin(), names.end(), [&](const auto& pair) {
        return is_known(pair.first) && is_known(pair.second);
    });
    if (!are_known) {
        return {};
    }
    auto pairs = object_pairs(example, names);
    return find_image_fault(example.objects.size() + 1, pairs, order_of(rule.kind))
               ? std::vector<std::pair<Label, Label>>()
               : pairs;
}

// The object that a base object becomes by a turn; the object itself where there is none such.
ObjectId variant_by(const Example& example, ObjectId base, const TurnMatrix& turn) {
    if (turn == TurnMatrix::Identity()) {
        return base;
    }
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        if (example.objects[i].variant_of == base && example.objects[i].turn == turn) {
            return static_cast<ObjectId>(i + 1);
        }
    }
    return base;
}

}  // namespace

std::vector<TurnMatrix> turns_of(std::span<const SymmetryRule> rules) {
    std::vector<TurnMatrix> turns;
    for (const SymmetryRule& rule : rules) {
        turns.push_back(motion_of(rule, {}).turn);
    }
    return turns;
}

std::vector<ObjectId> shapes_of(const Example& example) {
    std::vector<ObjectId> objects;
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const ObjectType& type = example.objects[i];
        if (type.shape != nullptr || type.rest_of != kEmpty) {
            objects.push_back(static_cast<ObjectId>(i + 1));
        }
    }
    return objects;
}

std::vector<SymmetryRule> symmetries_of_shapes(
    const Example& example, const Parameters& parameters
) {
    std::vector<SymmetryRule> rules;
    for (const Constraint& constraint : *parameters.constraints) {
        const auto* rule = std::get_if<SymmetryRule>(&constraint.rule);
        if (rule != nullptr && rule->kind != SymmetryRule::Kind::kTranslate) {
            rules.push_back(*rule);
        }
    }
    const std::vector<TurnMatrix> turns = turns_of(rules);
    const bool is_turned = parameters.variants != Variants();
    const bool has_images =
        std::any_of(example.objects.begin(), example.objects.end(), [&](const ObjectType& type) {
            const auto is_own = [&](const TurnMatrix& turn) {
                return is_own_image(*type.shape, turn);
            };
            return type.shape != nullptr &&
                   (is_turned || !std::all_of(turns.begin(), turns.end(), is_own));
        });
    return has_images ? rules : std::vector<SymmetryRule>();
}

bool has_image_by_shape(const Example& example, ObjectId object) {
    if (object == kEmpty) {
        return false;
    }
    const ObjectType& type = example.objects[object - 1U];
    const bool is_shape = type.shape != nullptr || type.rest_of != kEmpty;
    const ObjectId base = type.variant_of == kEmpty ? object : type.variant_of;
    return is_shape && std::any_of(
                           example.objects.begin(),
                           example.objects.end(),
                           [&](const ObjectType& other) { return other.variant_of == base; }
                       );
}

std::vector<Label> object_images(const Example& example, const SymmetryRule& rule) {
    std::vector<Label> images =
        label_images(example.objects.size() + 1, sound_pairs(example, rule));
    const TurnMatrix turn = motion_of(rule, {}).turn;
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const auto object = static_cast<ObjectId>(i + 1);
        if (has_image_by_shape(example, object)) {
            const ObjectType& type = example.objects[i];
            const ObjectId base = type.variant_of == kEmpty ? object : type.variant_of;
            images[object] = variant_by(example, base, turn * type.turn);
        }
    }
    return images;
}

void add_images_of_shapes(
    std::vector<Figure>& figures,
    const Topes& topes,
    const Example& example,
    std::span<const SymmetryRule> rules,
    std::size_t count_max
) {
    std::vector<FigureMover> movers;
    std::vector<std::vector<Label>> objects;
    for (const SymmetryRule& rule : rules) {
        const TurnMatrix turn = motion_of(rule, {}).turn;
        if (!have_images(topes, turn)) {
            return;
        }
        movers.emplace_back(topes, turn);
        objects.push_back(object_images(example, rule));
    }
    std::vector<bool> is_shape(example.objects.size() + 1);
    for (std::size_t object = 1; object < is_shape.size(); ++object) {
        is_shape[object] = has_image_by_shape(example, static_cast<ObjectId>(object));
    }
    std::set<Figure> known(figures.begin(), figures.end());
    for (std::size_t i = 0; i < figures.size() && figures.size() <= count_max; ++i) {
        const Figure figure = figures[i];
        const bool has_shape = std::any_of(figure.begin(), figure.end(), [&](char object) {
            return is_shape[static_cast<ObjectId>(object)];
        });
        for (std::size_t rule = 0; has_shape && rule < movers.size(); ++rule) {
            Figure image = movers[rule].moved(figure, objects[rule]);
            if (known.insert(image).second) {
                figures.push_back(std::move(image));
            }
        }
    }
}

}  // namespace modelsynth::continuous
