#include "tests/support/random_solids.h"

#include "solver/examples/solids/shapes.h"
#include "tests/support/half_space_hull.h"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace modelsynth::testing {

namespace {

using continuous::Example;
using continuous::ObjectId;
using continuous::Point;
using continuous::Polyhedron;

class Maker {
  public:
    explicit Maker(std::uint32_t seed) : random_(seed) {}

    // The standard distributions differ between libraries, the engine does not.
    int between(int min, int max) {
        return min + static_cast<int>(random_() % static_cast<std::uint64_t>(max - min + 1));
    }

    Point point(int min, int max) {
        const int x = between(min, max);
        const int y = between(min, max);
        return Point(x, y, between(min, max));
    }

    ObjectId object() { return static_cast<ObjectId>(between(2, 3)); }

    Polyhedron box() {
        const Point low = point(0, 2);
        return examples::box(object(), low, low + point(1, 2));
    }

    Polyhedron wedge() {
        const int width = between(1, 3);
        const int height = between(1, 2);
        const double ridge = between(0, 2) * 0.5 * width;
        const examples::Outline outline = {{0.0, 0.0}, {1.0 * width, 0.0}, {ridge, 1.0 * height}};
        const int length = between(1, 3);
        Polyhedron solid = between(0, 1) == 0
                               ? examples::prism_along_z(object(), outline, 0, length)
                               : examples::prism_along_x(object(), outline, 0, length);
        return examples::moved(std::move(solid), point(0, 2));
    }

    Polyhedron tetrahedron() {
        Polyhedron solid;
        solid.object = object();
        double volume = 0;
        while (volume == 0) {
            solid.corners = {point(0, 3), point(0, 3), point(0, 3), point(0, 3)};
            const Point& origin = solid.corners[0];
            volume = (solid.corners[1] - origin)
                         .cross(solid.corners[2] - origin)
                         .dot(solid.corners[3] - origin);
        }
        if (volume < 0) {
            std::swap(solid.corners[2], solid.corners[3]);
        }
        solid.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
        return solid;
    }

    Polyhedron convex() {
        for (;;) {
            std::vector<HalfSpace> spaces;
            if (between(0, 1) == 0) {
                for (int axis = 0; axis < 3; ++axis) {
                    spaces.push_back({Point::Unit(axis), 3});
                    spaces.push_back({-Point::Unit(axis), 0});
                }
            }
            for (int i = between(4, 7); i > 0; --i) {
                const Point normal = point(-2, 2);
                if (normal.norm() > 0 && spaces.size() < 8) {
                    // Offsets such that some point of the middle is inside.
                    spaces.push_back({normal, normal.dot(point(1, 2)) + between(0, 2)});
                }
            }
            if (auto hull = make_hull(object(), spaces, 8)) {
                return *hull;
            }
        }
    }

    // One of the others, nearly where another one is.
    void add_sliver(std::vector<Polyhedron>& solids) {
        const Polyhedron solid = between(0, 1) == 0 ? box() : convex();
        solids.push_back(solid);
        const double size = std::pow(10.0, -between(1, 10));
        switch (between(0, 3)) {
            case 0:
                solids.push_back(examples::moved(solid, size * point(-1, 1)));
                break;
            case 1: {  // a slice
                const Point low = point(0, 2);
                const Point extent = point(1, 2).cwiseProduct(Point(1, size, 1));
                solids.push_back(examples::box(object(), low, low + extent));
                break;
            }
            case 2: {  // turned a little
                Polyhedron turned = solid;
                for (Point& corner : turned.corners) {
                    corner = Point(corner.x() - size * corner.z(), corner.y(), corner.z());
                }
                solids.push_back(std::move(turned));
                break;
            }
            default: {  // corners off their planes
                Polyhedron bent = solid;
                bent.corners[0] += size * point(-1, 1);
                solids.push_back(std::move(bent));
                break;
            }
        }
    }

  private:
    std::mt19937_64 random_;
};

}  // namespace

Example make_random_solids(SolidsKind kind, std::uint32_t seed) {
    Maker maker(seed * 16 + static_cast<std::uint32_t>(kind));
    Example example;
    example.name = "random";
    example.materials = {{"ground", {}}, {"one", {}}, {"other", {}}};
    example.objects = {{"ground", 0}, {"one", 1}, {"other", 2}};
    for (int i = maker.between(1, kind == SolidsKind::kConvex ? 2 : 3); i > 0; --i) {
        switch (kind) {
            case SolidsKind::kBoxes:
                example.polyhedra.push_back(maker.box());
                break;
            case SolidsKind::kWedges:
                example.polyhedra.push_back(maker.between(0, 2) == 0 ? maker.box() : maker.wedge());
                break;
            case SolidsKind::kTetrahedra:
                example.polyhedra.push_back(maker.tetrahedron());
                break;
            case SolidsKind::kConvex:
                example.polyhedra.push_back(maker.convex());
                break;
            case SolidsKind::kSlivers:
                maker.add_sliver(example.polyhedra);
                break;
        }
    }
    if (maker.between(0, 1) == 0) {
        example.ground = ObjectId{1};
    }
    if (maker.between(0, 3) == 0) {
        const double low = maker.between(-4, 1) - 0.25 * maker.between(0, 2);
        const double high = maker.between(2, 4) + 0.25 * maker.between(0, 2);
        example.bounds = continuous::Bounds{Point(low, -1, low), Point(high, high, high)};
    }
    return example;
}

}  // namespace modelsynth::testing
