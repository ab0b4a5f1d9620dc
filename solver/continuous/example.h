#pragma once

#include "solver/continuous/constraints/constraints.h"
#include "solver/continuous/decoration/decoration.h"
#include "solver/mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::continuous {

// Metres, right-handed, y up.
using Point = Eigen::Vector3d;

// What fills space at a place: 0 is empty space, i the object type of that number.
using ObjectId = std::uint8_t;
inline constexpr ObjectId kEmpty = 0;
inline constexpr std::size_t kObjectTypesMax = 255;

// A flat polygon without holes. Shape: numbers of corners, counter-clockwise seen from outside;
// convex or not.
using Face = std::vector<std::uint32_t>;

// A mesh that is put in the place of an object's boxes, stretched over each (thesis 4.6.4).
struct Shape {
    std::vector<Point> corners;  // their bounding box is laid over the box
    std::vector<Face> faces;     // convex, nearly flat
    // Faces that meet at a lesser angle (degrees) look smooth.
    double smooth_degrees = 40;
    // The axes along which the boxes grow by the same factor: none, or two or three.
    std::array<bool, 3> is_even = {};

    friend bool operator==(const Shape&, const Shape&) = default;
};

// A kind of solid: a material of its own, and what a request may call it.
struct ObjectType {
    std::string name;
    std::uint32_t material = 0;                    // index into Example::materials
    double weight = 1;                             // of the figures in which it takes part
    std::shared_ptr<const Shape> shape = nullptr;  // null: it looks like its solids
    // Not kEmpty: no object of its own, but what was cut off that one's boxes; see cut_boxes().
    ObjectId rest_of = kEmpty;
    std::vector<Decoration> decorations = {};  // of its edges and corners in models
    // Not kEmpty: no object of its own, but that one as it became by a turn; see variants.h.
    ObjectId variant_of = kEmpty;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();

    friend bool operator==(const ObjectType&, const ObjectType&) = default;
};

// A closed solid of one object type: every edge of a face is an edge of another face, the other
// way round.
struct Polyhedron {
    std::string name;  // to name it in errors
    ObjectId object = 1;
    std::vector<Point> corners;
    std::vector<Face> faces;
};

// A box, the border included.
struct Bounds {
    Point min = Point::Zero();
    Point max = Point::Zero();
};

// An object that is exactly one spacing wide across the planes of a normal (thesis 4.6.1): where
// one of them meets it, it ends.
struct Dimension {
    ObjectId object = 1;
    Point normal = Point::UnitY();  // need not be of unit length
};

// An example model E of solids with any slopes (thesis 4.2).
struct Example {
    std::string name;
    std::string title;
    std::string description;
    std::vector<Material> materials;
    std::vector<ObjectType> objects;  // object i is objects[i - 1]
    // Where solids overlap, the later one counts.
    std::vector<Polyhedron> polyhedra;
    // This object fills all below y = 0 that no solid fills.
    std::optional<ObjectId> ground;
    // Only what is strictly inside is example: solids may leave it, and are as if they went on for
    // ever. None: all of it.
    std::optional<Bounds> bounds;
    // What holds for its models unless a request says otherwise: dimensions, and objects of which
    // all together hang together (thesis 4.6.2).
    std::vector<Dimension> dimensions;
    std::vector<std::vector<ObjectId>> connected;
    std::vector<Constraint> constraints;       // others that hold so, such as where objects may be
    double spacing = 1;                        // default distance of parallel planes, metres
    std::array<double, 3> size = {20, 8, 20};  // default size of a model, metres
    double density = 0.3;                      // default; see Parameters
};

// The object of a name; kEmpty when there is none.
[[nodiscard]] ObjectId find_object(const Example& example, const std::string& name);

}  // namespace modelsynth::continuous
