#include "solver/continuous/shapes/cut_boxes.h"

#include "solver/continuous/reading/families.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr double kTolerance = 1e-9;  // of the box

using Box3 = Eigen::AlignedBox3d;

Box3 box_of(const std::vector<Point>& corners) {
    Box3 box;
    for (const Point& corner : corners) {
        box.extend(corner);
    }
    return box;
}

int even_axes(const Shape& shape) {
    return static_cast<int>(std::count(shape.is_even.begin(), shape.is_even.end(), true));
}

double volume_of(const Polyhedron& solid) {
    double volume = 0;
    for (const Face& face : solid.faces) {
        volume += area_vector(solid, face).dot(solid.corners[face.front()]) / 3;
    }
    return volume;
}

bool is_box(const Polyhedron& solid) {
    const Box3 box = box_of(solid.corners);
    const double tolerance = kTolerance * box.sizes().maxCoeff();
    const bool has_its_corners =
        std::all_of(solid.corners.begin(), solid.corners.end(), [&](const Point& corner) {
            for (int axis = 0; axis < 3; ++axis) {
                if (std::min(corner[axis] - box.min()[axis], box.max()[axis] - corner[axis]) >
                    tolerance) {
                    return false;
                }
            }
            return true;
        });
    return has_its_corners &&
           std::abs(volume_of(solid) - box.volume()) <= 1e-6 * std::abs(box.volume());
}

// A convex solid whose faces may be told either way round.
Polyhedron convex(
    const Polyhedron& like, ObjectId object, std::vector<Point> corners, std::vector<Face> faces
) {
    Point middle = Point::Zero();
    for (const Point& corner : corners) {
        middle += corner / static_cast<double>(corners.size());
    }
    Polyhedron solid = {like.name, object, std::move(corners), std::move(faces)};
    for (Face& face : solid.faces) {
        if (area_vector(solid, face).dot(solid.corners[face.front()] - middle) < 0) {
            std::reverse(face.begin(), face.end());
        }
    }
    return solid;
}

// The corner of a box with the greater coordinate along the axes of which the bit is set.
Point corner_of(const Box3& box, unsigned bits) {
    Point corner;
    for (unsigned axis = 0; axis < 3; ++axis) {
        corner[axis] = (bits >> axis & 1) != 0 ? box.max()[axis] : box.min()[axis];
    }
    return corner;
}

std::pair<Polyhedron, Polyhedron> cut_into_prisms(
    const Polyhedron& solid, const std::array<bool, 3>& is_even, ObjectId rest
) {
    const auto along =
        static_cast<unsigned>(std::find(is_even.begin(), is_even.end(), false) - is_even.begin());
    const unsigned a = 1U << (along + 1) % 3;
    const unsigned b = 1U << (along + 2) % 3;
    const unsigned c = 1U << along;
    const Box3 box = box_of(solid.corners);
    const auto prism = [&](ObjectId object, const std::array<unsigned, 3>& ends) {
        std::vector<Point> corners;
        for (const unsigned top : {0U, c}) {
            for (const unsigned end : ends) {
                corners.push_back(corner_of(box, end | top));
            }
        }
        return convex(
            solid,
            object,
            std::move(corners),
            {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}
        );
    };
    return {prism(solid.object, {0, a, b}), prism(rest, {a | b, a, b})};
}

std::pair<Polyhedron, Polyhedron> cut_corner_off(const Polyhedron& solid, ObjectId rest) {
    const Box3 box = box_of(solid.corners);
    std::vector<Point> corners;
    for (unsigned bits = 0; bits < 8; ++bits) {
        corners.push_back(corner_of(box, bits));
    }
    // 1, 2 and 4 are next to corner 0 along x, y and z.
    Polyhedron corner = convex(
        solid,
        solid.object,
        {corners[0], corners[1], corners[2], corners[4]},
        {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}
    );
    corners.erase(corners.begin());
    Polyhedron others = convex(
        solid,
        rest,
        std::move(corners),
        {{0, 1, 2},  // what corner 0 leaves of the three faces at it, ...
         {0, 3, 4},
         {1, 3, 5},
         {0, 1, 3},  // ... where it was cut off, and the faces beyond
         {0, 2, 6, 4},
         {1, 2, 6, 5},
         {3, 4, 6, 5}}
    );
    return {std::move(corner), std::move(others)};
}

Polyhedron box_around(const Polyhedron& solid) {
    const Box3 box = box_of(solid.corners);
    std::vector<Point> corners;
    for (unsigned bits = 0; bits < 8; ++bits) {
        corners.push_back(corner_of(box, bits));
    }
    return convex(
        solid,
        solid.object,
        std::move(corners),
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}
    );
}

std::string pointer_of(std::size_t object) {
    return "/objects/" + std::to_string(object) + "/shape";
}

}  // namespace

std::vector<Fault> find_shape_faults(const Example& example) {
    std::vector<Fault> faults;
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const auto& shape = example.objects[i].shape;
        if (shape == nullptr) {
            continue;
        }
        const Box3 whole = box_of(shape->corners);
        if (whole.isEmpty() || whole.sizes().minCoeff() <= 0) {
            faults.push_back({pointer_of(i) + "/vertices", "the shape is flat"});
        }
        if (even_axes(*shape) == 1) {
            faults.push_back({pointer_of(i) + "/even", "must name two axes or three"});
        }
        if (example.ground == i + 1) {
            faults.push_back({pointer_of(i), "the ground has no boxes to put a shape in"});
        }
        std::vector<Box3> boxes;
        for (std::size_t p = 0; p < example.polyhedra.size(); ++p) {
            const Polyhedron& solid = example.polyhedra[p];
            if (solid.object != i + 1) {
                continue;
            }
            const Box3 box = box_of(solid.corners);
            const bool touches = std::any_of(boxes.begin(), boxes.end(), [&](const Box3& other) {
                return box.intersects(other);
            });
            const std::string pointer = "/polyhedra/" + std::to_string(p);
            if (!is_box(solid)) {
                faults.push_back(
                    {pointer, "must be a box along the axes, since its object has a shape"}
                );
            } else if (touches) {
                faults.push_back(
                    {pointer, "must not touch another one of its object, since that has a shape"}
                );
            }
            boxes.push_back(box);
        }
    }
    if (example.objects.size() + static_cast<std::size_t>(std::count_if(
                                     example.objects.begin(),
                                     example.objects.end(),
                                     [](const ObjectType& object) {
                                         return object.shape != nullptr &&
                                                even_axes(*object.shape) > 0;
                                     }
                                 )) >
        kObjectTypesMax) {
        faults.push_back({"/objects", "shapes that grow evenly count twice", true});
    }
    return faults;
}

void cut_boxes(Example& example) {
    const std::size_t count = example.objects.size();
    std::vector<ObjectId> rests(count + 1, kEmpty);
    for (std::size_t i = 0; i < count; ++i) {
        const ObjectType whole = example.objects[i];
        if (whole.shape == nullptr || even_axes(*whole.shape) == 0) {
            continue;
        }
        const auto object = static_cast<ObjectId>(i + 1);
        example.objects.push_back(
            {whole.name + " (rest)", whole.material, whole.weight, nullptr, object}
        );
        rests[object] = static_cast<ObjectId>(example.objects.size());
    }
    std::vector<Polyhedron> solids;
    for (const Polyhedron& solid : example.polyhedra) {
        const ObjectId rest = rests[solid.object];
        if (rest == kEmpty) {
            solids.push_back(solid);
            continue;
        }
        const Shape& shape = *example.objects[solid.object - 1U].shape;
        auto [first, second] = even_axes(shape) == 3 ? cut_corner_off(solid, rest)
                                                     : cut_into_prisms(solid, shape.is_even, rest);
        solids.push_back(std::move(first));
        solids.push_back(std::move(second));
    }
    example.polyhedra = std::move(solids);
}

Example with_whole_boxes(Example example) {
    std::vector<Polyhedron> solids;
    for (Polyhedron& solid : example.polyhedra) {
        const ObjectType& type = example.objects[solid.object - 1U];
        if (type.rest_of != kEmpty) {
            continue;
        }
        const bool is_cut = type.shape != nullptr && even_axes(*type.shape) > 0;
        solids.push_back(is_cut ? box_around(solid) : std::move(solid));
    }
    example.polyhedra = std::move(solids);
    std::erase_if(example.objects, [](const ObjectType& type) { return type.rest_of != kEmpty; });
    return example;
}

double share_of_box(const Example& example, ObjectId object) {
    const ObjectType& type = example.objects[object - 1U];
    const bool is_rest = type.rest_of != kEmpty;
    const auto& shape = is_rest ? example.objects[type.rest_of - 1U].shape : type.shape;
    switch (shape == nullptr ? 0 : even_axes(*shape)) {
        case 2:
            return 0.5;
        case 3:
            return is_rest ? 5.0 / 6 : 1.0 / 6;
        default:
            return 1;
    }
}

}  // namespace modelsynth::continuous
