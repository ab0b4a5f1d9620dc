#include "solver/continuous/model_planes.h"

#include "solver/continuous/initial_model.h"
#include "solver/continuous/symmetry/motion.h"
#include "solver/continuous/symmetry/plane_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace modelsynth::continuous {

namespace {

std::size_t family_of(const ExampleReading& reading, const std::array<double, 3>& normal) {
    return *reading.topes().find_family(Point(normal[0], normal[1], normal[2]));
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

ModelPlanes planes_through(
    const Point& point, const ExampleReading& reading, const Parameters& parameters
) {
    const std::span<const Point> normals = reading.topes().normals();
    const Bounds box = model_box(reading, parameters);
    const double tolerance = kOffsetTolerance * (box.max - box.min).maxCoeff();
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
            add(spaced_planes(reach_along(normal, box), normal.dot(point), spacing), family);
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
    return {Point(0, -below, 0), Point(size[0], size[1], size[2])};
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
        listed |= FamilySet{1} << family_of(reading, family.normal);
    }
    return listed;
}

Spacings spacings_of(const ExampleReading& reading, const Parameters& parameters) {
    std::vector<double> fixed(reading.topes().family_count(), 0);
    for (const FamilySpacing& family : parameters.spacings) {
        fixed[family_of(reading, family.normal)] = family.spacing;
    }
    return solve_spacings(
        reading.figures(), *parameters.spacing, fixed, listed_families(reading, parameters)
    );
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
