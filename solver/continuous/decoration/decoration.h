#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace modelsynth::continuous {

struct Shape;

inline constexpr std::size_t kDecorationsMax = 16;  // of an object
inline constexpr std::size_t kProfilePointsMax = 64;
inline constexpr double kProfileOffsetMax = 1000;  // metres

// Which faces are meant, by where they look.
enum class FaceKind : std::uint8_t {
    kAny,
    kUp,
    kDown,
    kSide,
    kSlope,     // upwards, but not straight up
    kOverhang,  // downwards, but not straight down
    kNormal
};

struct FaceChoice {
    FaceKind kind = FaceKind::kAny;
    std::array<double, 3> normal = {};  // of kNormal; need not be of unit length

    friend bool operator==(const FaceChoice&, const FaceChoice&) = default;
};

// How an object turns at an edge: it fills less than half of what is around it where it is convex.
// A corner is convex where all its edges are, and else concave.
enum class Turn : std::uint8_t { kConvex, kConcave, kAny };

// Offsets out of the planes of two faces, in metres; negative: within.
using ProfilePoint = std::array<double, 2>;

// A moulding along edges: a profile is swept along every edge of an object in which two such faces
// meet. Offsets are from the faces' planes, so that it fits any angle.
struct EdgeDecoration {
    std::array<FaceChoice, 2> faces;
    Turn turn = Turn::kConvex;
    std::vector<ProfilePoint> profile;  // simple, either way round
    std::uint8_t look = 0;              // the object whose material it has; 0: its own

    friend bool operator==(const EdgeDecoration&, const EdgeDecoration&) = default;
};

// A mesh that is put at every corner of an object in which three such faces meet, different ones.
struct CornerDecoration {
    std::array<FaceChoice, 3> faces;
    Turn turn = Turn::kConvex;
    std::shared_ptr<const Shape> mesh;  // metres; the corner is its origin
    bool is_turned = false;             // about y, so that its +x looks outwards
    std::uint8_t look = 0;

    friend bool operator==(const CornerDecoration&, const CornerDecoration&) = default;
};

using Decoration = std::variant<EdgeDecoration, CornerDecoration>;

// Whether a profile encloses an area and neither crosses nor touches itself.
[[nodiscard]] bool is_simple(const std::vector<ProfilePoint>& profile);

// Above 0 where it is counter-clockwise.
[[nodiscard]] double signed_area(const std::vector<ProfilePoint>& profile);

}  // namespace modelsynth::continuous
