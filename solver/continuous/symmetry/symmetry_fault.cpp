#include "solver/continuous/symmetry/symmetry_fault.h"

#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/symmetry/plane_images.h"
#include "solver/continuous/symmetry/shape_images.h"
#include "solver/core/label_images.h"

#include <cstdio>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

using Kind = SymmetryRule::Kind;

std::string field_of(Kind kind) {
    switch (kind) {
        case Kind::kReflectX:
        case Kind::kReflectZ:
            return "/reflect";
        case Kind::kHalfTurn:
        case Kind::kQuarterTurn:
            return "/rotate";
        case Kind::kTranslate:
            break;
    }
    return "/translate";
}

std::string text_of(const Point& point) {
    char text[96];
    std::snprintf(text, sizeof text, "[%.4g, %.4g, %.4g]", point.x(), point.y(), point.z());
    return text;
}

}  // namespace

std::optional<SymmetryFault> find_symmetry_fault(
    const ExampleReading& reading,
    const SymmetryRule& rule,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
) {
    const std::string field = field_of(rule.kind);
    if (rule.kind == Kind::kQuarterTurn && size[0] != size[2]) {
        return SymmetryFault{field, "a quarter turn needs a model that is as wide as deep"};
    }
    const Motion motion = motion_of(rule, size);
    if (rule.kind == Kind::kTranslate && motion.shift.norm() == 0) {
        return SymmetryFault{field, "is no step away"};
    }
    const Example& example = reading.example();
    if (example.ground && motion.shift.y() != 0) {
        return SymmetryFault{field, "cannot go up or down: the ground stays where it is"};
    }
    if (rule.mirror) {
        for (const auto& [from, to] : object_pairs(example, *rule.mirror)) {
            const bool is_kept =
                from == kEmpty || to == kEmpty || from == example.ground || to == example.ground;
            if (is_kept && from != to) {
                return SymmetryFault{
                    "/mirror",
                    "the ground and empty space, where there are any, are their own images"};
            }
        }
        auto fault = find_image_fault(
            example.objects.size() + 1, object_pairs(example, *rule.mirror), order_of(rule.kind)
        );
        if (fault) {
            return SymmetryFault{"/mirror", std::move(*fault)};
        }
        const std::vector<Label> images = object_images(example, rule);
        for (const auto& [from, to] : object_pairs(example, *rule.mirror)) {
            for (const Label object : {from, to}) {
                if (images[from] != to &&
                    has_image_by_shape(example, static_cast<ObjectId>(object))) {
                    return SymmetryFault{
                        "/mirror",
                        "what becomes of object \"" + example.objects[object - 1U].name +
                            "\" follows from its shape"};
                }
            }
        }
    }
    const Topes& topes = reading.topes();
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        const std::string normal = text_of(topes.normals()[family]);
        if (!family_image(topes, family, motion.turn)) {
            return SymmetryFault{
                field,
                "the example has faces of the normal " + normal +
                    " and none that would be their images"};
        }
        if (const auto plane = plane_without_image(topes, family, motion, planes, size)) {
            return SymmetryFault{
                field,
                "the plane of the normal " + normal + " at " + std::to_string(*plane) +
                    " m would have its image between planes; a size or a step of whole spacings "
                    "helps"};
        }
    }
    return std::nullopt;
}

}  // namespace modelsynth::continuous
