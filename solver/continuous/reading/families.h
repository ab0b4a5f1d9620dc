#pragma once

#include "solver/continuous/example.h"
#include "solver/core/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// A family of parallel planes has one normal n; n and -n are one family. The plane at offset o is
// { p : n . p = o }.
inline constexpr std::size_t kFamiliesMax = 32;

// A set of families, family i at bit i.
using FamilySet = std::uint32_t;

// The set of that family alone.
[[nodiscard]] constexpr FamilySet only(std::size_t family) { return FamilySet{1} << family; }

// Normals that differ by less than this angle (radians) are one; offsets that differ by less than
// this share of the example's extent are one plane.
inline constexpr double kNormalTolerance = 1e-5;
inline constexpr double kOffsetTolerance = 1e-7;

// Where a face lies.
struct FacePlane {
    std::uint8_t family = 0;
    double offset = 0;

    friend bool operator==(const FacePlane&, const FacePlane&) = default;
};

// The families of an example's faces (thesis 4.5.3: the distinct normals), and the plane of every
// face.
struct Families {
    std::vector<Point> normals;  // unit length; the first part that is not 0 is positive
    std::vector<double> areas;   // of the faces of each family, square metres
    // By polyhedron and face; those of several examples after each other.
    std::vector<std::vector<FacePlane>> planes;
};

// Families stand by how upright they are: horizontal planes first, then those along the axes, then
// by area, so that numbers do not depend on the order of the faces.
// A face that does not reach into its example's bounds makes no family; its plane is that of
// kNoFamily.
// Requires: one example, or one and its images, which are as large and as faulty.
// Fails: kInvalidArgument with the place of a face that is not flat or has no area; kTooLarge.
inline constexpr std::uint8_t kNoFamily = 255;
[[nodiscard]] Result<Families> find_families(std::span<const Example> examples);

// The area vector of a flat loop of points: its normal times its area.
[[nodiscard]] Point area_vector(std::span<const Point> points, std::span<const std::uint32_t> loop);

[[nodiscard]] inline Point area_vector(const Polyhedron& solid, const Face& face) {
    return area_vector(solid.corners, face);
}

// The largest extent of the example along an axis, metres.
[[nodiscard]] double extent_of(const Example& example);

}  // namespace modelsynth::continuous
