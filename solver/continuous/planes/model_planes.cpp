#include "solver/continuous/planes/model_planes.h"

#include "solver/continuous/initial_model.h"
#include "solver/continuous/symmetry/motion.h"
#include "solver/continuous/symmetry/plane_images.h"
#include "solver/core/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace modelsynth::continuous {

namespace {

// By so many spacings a model ends before its free sides: planes, and lines in which they meet, lie
// in these often, and what is cut along a face is neither there nor not. By side, all different, so
// that none passes through an edge of the box either.
constexpr std::array<double, 6> kShortened = {5.0e-4, 6.3e-4, 7.7e-4, 9.1e-4, 1.07e-3, 1.29e-3};

constexpr std::uint32_t kPurposeJitter = 17;  // RandomKey::purpose

std::size_t family_of(const ExampleReading& reading, const std::array<double, 3>& normal) {
    return *reading.find_family(Point(normal[0], normal[1], normal[2]));
}

struct NumberedPlanes {
    PlaneOffsets offsets;
    std::int64_t first_number = 0;
};

NumberedPlanes spaced_planes(const Reach& reach, double through, double spacing) {
    NumberedPlanes planes;
    const double tolerance = 1e-9 * spacing;
    double k = std::floor((reach.low - through) / spacing);
    for (; through + k * spacing < reach.high - tolerance; ++k) {
        if (through + k * spacing > reach.low + tolerance) {
            if (planes.offsets.empty()) {
                planes.first_number = std::llround(k);
            }
            planes.offsets.push_back(through + k * spacing);
        }
    }
    return planes;
}

// Planes nearer to each other than the tolerance are one.
NumberedPlanes listed_planes(PlaneOffsets listed, const Reach& reach, double tolerance) {
    std::sort(listed.begin(), listed.end());
    NumberedPlanes planes;
    double last = -std::numeric_limits<double>::infinity();
    for (const double offset : listed) {
        if (offset - last <= tolerance) {
            continue;
        }
        last = offset;
        if (offset <= reach.low + tolerance) {
            ++planes.first_number;
        } else if (offset < reach.high - tolerance) {
            planes.offsets.push_back(offset);
        }
    }
    return planes;
}

// The offsets asked for, along the normal that the family has in the example.
PlaneOffsets along_family(const FamilyOffsets& asked, const Point& normal) {
    const auto& [x, y, z] = asked.normal;
    const double sign = Point(x, y, z).dot(normal) < 0 ? -1 : 1;
    PlaneOffsets offsets;
    for (const double offset : asked.offsets) {
        offsets.push_back(sign * offset);
    }
    return offsets;
}

// Exactly at 0, where the ground ends.
void put_ground(double tolerance, PlaneOffsets& offsets) {
    std::erase_if(offsets, [&](double offset) { return std::abs(offset) <= tolerance; });
    offsets.push_back(0);
}

// Whether the planes are their own image under every reflection and turn asked for.
bool are_symmetric(
    const ExampleReading& reading, const Parameters& parameters, const ModelPlanes& planes
) {
    const Topes& topes = reading.topes();
    for (const Constraint& constraint : *parameters.constraints) {
        const auto* rule = std::get_if<SymmetryRule>(&constraint.rule);
        if (rule == nullptr || rule->kind == SymmetryRule::Kind::kTranslate) {
            continue;
        }
        const Motion motion = motion_of(*rule, *parameters.size);
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            if (!family_image(topes, family, motion.turn) ||
                plane_without_image(topes, family, motion, planes.offsets, *parameters.size)) {
                return false;
            }
        }
    }
    return true;
}

// The families whose planes cannot be moved one by one.
FamilySet firm_families(const ExampleReading& reading, const Parameters& parameters) {
    FamilySet firm = dependent_families(reading.figures());
    const Example& example = reading.example();
    for (const Constraint& constraint : *parameters.constraints) {
        if (const auto* rule = std::get_if<DimensionRule>(&constraint.rule)) {
            const auto& [x, y, z] = rule->normal;
            for (const ObjectType& object : example.objects) {
                if (const auto family = reading.find_family(object.turn * Point(x, y, z))) {
                    firm |= only(*family);
                }
            }
        }
    }
    return firm;
}

// Each by its own random share of `most`, but for the ground's and where it would leave the box.
void move_planes(
    double most, bool has_ground, const Reach& reach, std::size_t family, ModelPlanes& planes
) {
    PlaneOffsets& offsets = planes.offsets[family];
    const double tolerance = 1e-9 * (reach.high - reach.low);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        const auto number = static_cast<std::uint64_t>(planes.first_number[family]) + i;
        if (has_ground && number == 0) {
            continue;
        }
        RandomStream random({number, static_cast<std::uint32_t>(family), 0, kPurposeJitter});
        const double share = random.next() / 4294967296.0 - 0.5;
        const double moved = offsets[i] + share * most;
        if (moved > reach.low + tolerance && moved < reach.high - tolerance) {
            offsets[i] = moved;
        }
    }
}

ModelPlanes planes_through(
    const Point& point, const ExampleReading& reading, const Parameters& parameters
) {
    const std::span<const Point> normals = reading.topes().normals();
    const Bounds box = arranged_box(reading, parameters);
    const double tolerance = kOffsetTolerance * (box.max - box.min).maxCoeff();
    const FamilySet firm = parameters.jitter > 0 ? firm_families(reading, parameters) : 0;
    ModelPlanes planes;
    planes.spacings = spacings_of(reading, parameters);
    const auto add = [&planes](NumberedPlanes of_family, std::size_t family) {
        planes.offsets[family] = std::move(of_family.offsets);
        planes.first_number[family] = of_family.first_number;
    };
    planes.offsets.resize(normals.size());
    planes.first_number.resize(normals.size());
    for (std::size_t family = 0; family < normals.size(); ++family) {
        if (const double spacing = planes.spacings.of_family[family]; spacing > 0) {
            const Point& normal = normals[family];
            const Reach reach = reach_along(normal, box);
            add(spaced_planes(reach, normal.dot(point), spacing), family);
            if (parameters.jitter > 0 && (firm >> family & 1) == 0) {
                const bool has_ground = reading.example().ground && family == reading.horizontal();
                move_planes(parameters.jitter * spacing, has_ground, reach, family, planes);
            }
        }
    }
    for (const FamilyOffsets& asked : parameters.offsets) {
        const std::size_t family = family_of(reading, asked.normal);
        PlaneOffsets offsets = along_family(asked, normals[family]);
        if (reading.example().ground && family == reading.horizontal()) {
            put_ground(tolerance, offsets);
        }
        add(listed_planes(std::move(offsets), reach_along(normals[family], box), tolerance),
            family);
    }
    return planes;
}

}  // namespace

Bounds model_box(const ExampleReading& reading, const Parameters& parameters) {
    const std::array<double, 3>& size = *parameters.size;
    const double below = reading.example().ground ? kBelowGround * *parameters.spacing : 0;
    Bounds box = {Point(0, -below, 0), Point(size[0], size[1], size[2])};
    for (int axis = 0; axis < 3; ++axis) {
        const auto side = static_cast<std::size_t>(2 * axis);
        const auto shortened = [&](std::size_t at) {
            return parameters.boundary[at] == SideKind::kFree ? kShortened[at] * *parameters.spacing
                                                              : 0;
        };
        box.min[axis] += shortened(side);
        box.max[axis] -= shortened(side + 1);
    }
    return box;
}

Bounds arranged_box(const ExampleReading& reading, const Parameters& parameters) {
    constexpr double kMargin =
        1.25;                      // of the widest spacing given, as long as that is no more than
    constexpr double kWidest = 4;  // so many times the usual one
    double widest = *parameters.spacing;
    for (const FamilySpacing& family : parameters.spacings) {
        widest = std::max(widest, family.spacing);
    }
    const double margin = kMargin * std::min(widest, kWidest * *parameters.spacing);
    Bounds box = model_box(reading, parameters);
    for (int axis = 0; axis < 3; ++axis) {
        const auto side = static_cast<std::size_t>(2 * axis);
        box.min[axis] -= parameters.boundary[side] == SideKind::kFree ? margin : 0;
        box.max[axis] += parameters.boundary[side + 1] == SideKind::kFree ? margin : 0;
    }
    return box;
}

Reach reach_along(const Point& normal, const Bounds& box) {
    Reach reach;
    for (int axis = 0; axis < 3; ++axis) {
        reach.low += std::min(normal[axis] * box.min[axis], normal[axis] * box.max[axis]);
        reach.high += std::max(normal[axis] * box.min[axis], normal[axis] * box.max[axis]);
    }
    return reach;
}

FamilySet listed_families(const ExampleReading& reading, const Parameters& parameters) {
    FamilySet listed = 0;
    for (const FamilyOffsets& family : parameters.offsets) {
        listed |= only(family_of(reading, family.normal));
    }
    return listed;
}

Spacings spacings_of(const ExampleReading& reading, const Parameters& parameters) {
    const Nudged* nudged = reading.nudged();
    std::vector<double> fixed = nudged == nullptr
                                    ? std::vector<double>(reading.topes().family_count(), 0)
                                    : nudged->spacings;
    for (const FamilySpacing& family : parameters.spacings) {
        fixed[family_of(reading, family.normal)] = family.spacing;
    }
    Spacings solved = solve_spacings(
        reading.figures(), *parameters.spacing, fixed, listed_families(reading, parameters)
    );
    if (nudged != nullptr) {
        solved.conflicts.clear();  // all meet in points of the lattice, seldom as these may be
    }
    return solved;
}

ModelPlanes make_planes(const ExampleReading& reading, const Parameters& parameters) {
    ModelPlanes planes = planes_through(Point::Zero(), reading, parameters);
    if (!are_symmetric(reading, parameters, planes)) {
        const std::array<double, 3>& size = *parameters.size;
        ModelPlanes others =
            planes_through(Point(size[0] / 2, 0, size[2] / 2), reading, parameters);
        if (are_symmetric(reading, parameters, others)) {
            return others;
        }
    }
    return planes;
}

}  // namespace modelsynth::continuous
