#include "solver/examples/solids/turned.h"

namespace modelsynth::examples {

using continuous::Point;
using continuous::Polyhedron;

Point turned(const Point& point, int quarters) {
    Point at = point;
    for (int i = 0; i < quarters; ++i) {
        at = Point(at.z(), at.y(), -at.x());
    }
    return at;
}

Polyhedron turned(Polyhedron solid, int quarters) {
    for (Point& corner : solid.corners) {
        corner = turned(corner, quarters);
    }
    return solid;
}

Polyhedron rolled(Polyhedron solid, int times) {
    for (Point& corner : solid.corners) {
        for (int i = 0; i < times; ++i) {
            corner = Point(corner.z(), corner.x(), corner.y());
        }
    }
    return solid;
}

}  // namespace modelsynth::examples
