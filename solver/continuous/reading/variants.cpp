#include "solver/continuous/reading/variants.h"

#include <Eigen/LU>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <variant>

namespace modelsynth::continuous {

namespace {

bool is_reflection(const TurnMatrix& turn) { return turn.determinant() < 0; }

void turn_faces(std::vector<Face>& faces, const TurnMatrix& turn) {
    if (is_reflection(turn)) {
        for (Face& face : faces) {
            std::reverse(face.begin(), face.end());
        }
    }
}

// Adding 0 makes a plain 0 of its negative.
Point turned(const Point& point, const TurnMatrix& turn) { return turn * point + Point::Zero(); }

std::shared_ptr<const Shape> turned_shape(const Shape& shape, const TurnMatrix& turn) {
    Shape made = shape;
    for (Point& corner : made.corners) {
        corner = turned(corner, turn);
    }
    turn_faces(made.faces, turn);
    const bool is_quarter = turn(0, 0) == 0;
    if (is_quarter) {
        std::swap(made.is_even[0], made.is_even[2]);
    }
    return std::make_shared<const Shape>(std::move(made));
}

Decoration turned_decoration(Decoration decoration, const TurnMatrix& turn) {
    const auto turn_faces_meant = [&turn](auto& faces) {
        for (FaceChoice& face : faces) {
            const auto& [x, y, z] = face.normal;
            const Point normal = turned(Point(x, y, z), turn);
            face.normal = {normal.x(), normal.y(), normal.z()};
        }
    };
    if (auto* edge = std::get_if<EdgeDecoration>(&decoration)) {
        turn_faces_meant(edge->faces);
    } else {
        auto& corner = std::get<CornerDecoration>(decoration);
        turn_faces_meant(corner.faces);
        if (!corner.is_turned) {  // else it looks outwards wherever that is
            corner.mesh = turned_shape(*corner.mesh, turn);
        }
    }
    return decoration;
}

std::string name_of(const std::string& name, const TurnMatrix& turn) {
    const bool is_mirrored = is_reflection(turn);
    // What is mirrored is so across x first, and turned after that.
    const TurnMatrix rotation =
        is_mirrored ? TurnMatrix(turn * Eigen::Vector3d(-1, 1, 1).asDiagonal()) : turn;
    const int degrees = rotation(0, 0) == 1    ? 0
                        : rotation(0, 0) == -1 ? 180
                        : rotation(0, 2) == 1  ? 90
                                               : 270;
    return name + (is_mirrored ? " mirrored" : "") +
           (degrees == 0 ? "" : " turned " + std::to_string(degrees));
}

// The object that one becomes.
ObjectId image_of(const Example& example, ObjectId object, const TurnMatrix& turn) {
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const ObjectType& type = example.objects[i];
        if (type.variant_of == object && type.turn == turn) {
            return static_cast<ObjectId>(i + 1);
        }
    }
    return object;
}

}  // namespace

std::vector<TurnMatrix> group_of(const std::vector<TurnMatrix>& generators) {
    std::vector<TurnMatrix> turns = {TurnMatrix::Identity()};
    for (std::size_t i = 0; i < turns.size(); ++i) {
        for (const TurnMatrix& generator : generators) {
            const TurnMatrix next = generator * turns[i];
            if (std::find(turns.begin(), turns.end(), next) == turns.end()) {
                turns.push_back(next);
            }
        }
    }
    return turns;
}

std::vector<TurnMatrix> turns_of(const Variants& variants) {
    std::vector<TurnMatrix> generators;
    if (variants.turns > 1) {
        TurnMatrix quarter;
        quarter << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // x to -z: the east to the north
        generators.push_back(variants.turns == 4 ? quarter : TurnMatrix(quarter * quarter));
    }
    if (variants.mirror_x) {
        generators.emplace_back(Eigen::Vector3d(-1, 1, 1).asDiagonal());
    }
    if (variants.mirror_z) {
        generators.emplace_back(Eigen::Vector3d(1, 1, -1).asDiagonal());
    }
    return group_of(generators);
}

std::vector<ObjectId> turned_apart(const Example& example, const Parameters& parameters) {
    std::vector<bool> is_apart(example.objects.size() + 1);
    for (const Constraint& constraint : *parameters.constraints) {
        if (std::holds_alternative<DimensionRule>(constraint.rule)) {
            for (const std::string& name : constraint.objects) {
                is_apart[find_object(example, name)] = true;
            }
        }
    }
    std::vector<ObjectId> apart;
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const ObjectType& type = example.objects[i];
        const bool is_part = type.rest_of != kEmpty && is_apart[type.rest_of];
        is_apart[i + 1] = is_apart[i + 1] || type.shape != nullptr || is_part;
        if (is_apart[i + 1] && type.variant_of == kEmpty && example.ground != i + 1) {
            apart.push_back(static_cast<ObjectId>(i + 1));
        }
    }
    return apart;
}

Example with_variant_objects(
    Example example, const std::vector<TurnMatrix>& turns, const std::vector<ObjectId>& apart
) {
    for (const TurnMatrix& turn : turns) {
        if (turn == turns.front()) {
            continue;
        }
        for (const ObjectId object : apart) {
            ObjectType type = example.objects[object - 1U];
            type.variant_of = object;
            type.turn = turn;
            if (type.shape != nullptr) {
                type.shape = turned_shape(*type.shape, turn);
            }
            for (Decoration& decoration : type.decorations) {
                decoration = turned_decoration(std::move(decoration), turn);
            }
            if (type.rest_of != kEmpty) {
                type.rest_of = image_of(example, type.rest_of, turn);
            }
            type.name = name_of(type.name, turn);
            while (find_object(example, type.name) != kEmpty) {
                type.name += '\'';
            }
            example.objects.push_back(std::move(type));
        }
    }
    return example;
}

Example turned_solids(const Example& example, const TurnMatrix& turn) {
    Example made = example;
    for (Polyhedron& solid : made.polyhedra) {
        solid.object = image_of(example, solid.object, turn);
        for (Point& corner : solid.corners) {
            corner = turned(corner, turn);
        }
        turn_faces(solid.faces, turn);
    }
    if (made.bounds) {
        const Point a = turned(made.bounds->min, turn);
        const Point b = turned(made.bounds->max, turn);
        made.bounds = Bounds{a.cwiseMin(b), a.cwiseMax(b)};
    }
    return made;
}

}  // namespace modelsynth::continuous
