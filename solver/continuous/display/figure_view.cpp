#include "solver/continuous/display/figure_view.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>

namespace modelsynth::continuous {

namespace {

// Corners that are computed are right to some 1e-15 of the cube's size, divided by the least angle
// of planes, 1e-5.
constexpr double kOnPlane = 1e-9;

// A side of a cell.
struct Wall {
    std::optional<std::size_t> family;  // none: it is part of the cube's side
    Point normal;                       // outwards
    std::vector<Point> corners;         // in order, either way round
};

// A convex part of the cube.
struct Cell {
    FamilySet above = 0;  // the families that matter on whose positive side it lies
    std::vector<Wall> walls;
};

Cell whole_cube() {
    Cell cube;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Wall wall;
            wall.normal = Point::Zero();
            wall.normal[axis] = side;
            for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
                Point corner;
                corner[axis] = side;
                corner[(axis + 1) % 3] = a;
                corner[(axis + 2) % 3] = b;
                wall.corners.push_back(corner);
            }
            cube.walls.push_back(std::move(wall));
        }
    }
    return cube;
}

// The part of a convex polygon where sign * (n . p) >= 0; nothing when that is but an edge.
std::vector<Point> clipped(const std::vector<Point>& polygon, const Point& normal, double sign) {
    std::vector<Point> kept;
    bool has_inner = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& a = polygon[i];
        const Point& b = polygon[(i + 1) % polygon.size()];
        const double height_a = sign * normal.dot(a);
        const double height_b = sign * normal.dot(b);
        if (height_a >= -kOnPlane) {
            kept.push_back(a);
            has_inner = has_inner || height_a > kOnPlane;
        }
        if ((height_a > kOnPlane && height_b < -kOnPlane) ||
            (height_a < -kOnPlane && height_b > kOnPlane)) {
            kept.push_back(a + height_a / (height_a - height_b) * (b - a));
        }
    }
    return has_inner ? kept : std::vector<Point>();
}

// The corners that lie on a plane, in order around it.
std::vector<Point> section(const Cell& part, const Point& normal) {
    std::vector<Point> corners;
    for (const Wall& wall : part.walls) {
        for (const Point& corner : wall.corners) {
            const bool is_new = std::abs(normal.dot(corner)) <= kOnPlane &&
                                std::none_of(corners.begin(), corners.end(), [&](const Point& one) {
                                    return (one - corner).norm() < kOnPlane;
                                });
            if (is_new) {
                corners.push_back(corner);
            }
        }
    }
    Point middle = Point::Zero();
    for (const Point& corner : corners) {
        middle += corner / static_cast<double>(corners.size());
    }
    const Point right = normal.unitOrthogonal();
    const Point up = normal.cross(right);
    std::sort(corners.begin(), corners.end(), [&](const Point& a, const Point& b) {
        return std::atan2((a - middle).dot(up), (a - middle).dot(right)) <
               std::atan2((b - middle).dot(up), (b - middle).dot(right));
    });
    return corners;
}

// The part of a cell on one side of a family's plane; without walls when there is none.
Cell part_of(const Cell& cell, std::size_t family, const Point& normal, double sign) {
    Cell part;
    part.above = cell.above | (sign > 0 ? only(family) : 0);
    for (const Wall& wall : cell.walls) {
        auto corners = clipped(wall.corners, normal, sign);
        if (corners.size() >= 3) {
            part.walls.push_back({wall.family, wall.normal, std::move(corners)});
        }
    }
    auto corners = section(part, normal);
    if (corners.size() >= 3) {
        part.walls.push_back({family, -sign * normal, std::move(corners)});
    }
    return part;
}

std::vector<Cell> cells_of(const Topes& topes, FamilySet families) {
    std::vector<Cell> cells = {whole_cube()};
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        if ((families & only(family)) == 0) {
            continue;
        }
        std::vector<Cell> parts;
        for (const Cell& cell : cells) {
            for (const double sign : {-1.0, 1.0}) {
                Cell part = part_of(cell, family, topes.normals()[family], sign);
                if (part.walls.size() >= 4) {
                    parts.push_back(std::move(part));
                }
            }
        }
        cells = std::move(parts);
    }
    return cells;
}

class Viewer {
  public:
    Viewer(const Topes& topes, const Figure& figure, FamilySet relevant, ViewFrom from)
        : topes_(topes), relevant_(relevant), from_(from), to_viewer_(direction_to_viewer(from)) {
        for (std::size_t tope = 0; tope < topes.count(); ++tope) {
            objects_[topes.sides(static_cast<Tope>(tope)) & relevant] =
                static_cast<ObjectId>(figure[tope]);
        }
    }

    [[nodiscard]] FigureView view() {
        std::vector<Cell> cells = cells_of(topes_, relevant_);
        FamilySet towards = 0;
        for (std::size_t family = 0; family < topes_.family_count(); ++family) {
            const bool is_towards = topes_.normals()[family].dot(to_viewer_) > 0;
            towards |= is_towards ? relevant_ & only(family) : 0;
        }
        view_.is_point_hidden = object_at(towards) != kEmpty;
        std::stable_sort(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) {
            return std::popcount(~(a.above ^ towards) & relevant_) <
                   std::popcount(~(b.above ^ towards) & relevant_);
        });
        for (const Cell& cell : cells) {
            if (object_at(cell.above) != kEmpty) {
                add(cell);
            }
        }
        return std::move(view_);
    }

  private:
    // What stands in the cell of these sides of the families that matter. Beside a cell that is
    // thinner than can be computed there may be none of those.
    [[nodiscard]] ObjectId object_at(FamilySet above) const {
        const auto found = objects_.find(above);
        return found == objects_.end() ? kEmpty : found->second;
    }

    void add(const Cell& cell) {
        const ObjectId object = object_at(cell.above);
        for (const Wall& wall : cell.walls) {
            const bool is_towards = wall.normal.dot(to_viewer_) > kOnPlane;
            if (!wall.family) {
                if (is_towards) {
                    view_.cuts.push_back(piece_of(object, wall, cut_edges(cell, wall)));
                }
                continue;
            }
            const ObjectId beyond = object_at(cell.above ^ only(*wall.family));
            if (beyond == object) {
                continue;
            }
            const std::vector<Stroke> edges = surface_edges(cell, wall);
            view_.edges.insert(view_.edges.end(), edges.begin(), edges.end());
            if (beyond == kEmpty && is_towards) {
                view_.surfaces.push_back(piece_of(object, wall, edges));
            }
        }
    }

    [[nodiscard]] FigurePiece piece_of(ObjectId object, const Wall& wall, std::vector<Stroke> edges)
        const {
        FigurePiece piece = {object, wall.normal, {}, std::move(edges)};
        for (const Point& corner : wall.corners) {
            piece.outline.push_back(place_of(corner, from_));
        }
        return piece;
    }

    // The other families whose planes pass through an edge of a wall.
    [[nodiscard]] FamilySet families_through(const Wall& wall, const Point& a, const Point& b)
        const {
        FamilySet through = 0;
        for (std::size_t family = 0; family < topes_.family_count(); ++family) {
            const Point& normal = topes_.normals()[family];
            const bool is_through = (relevant_ & only(family)) != 0 && wall.family != family &&
                                    std::abs(normal.dot(a)) <= kOnPlane &&
                                    std::abs(normal.dot(b)) <= kOnPlane;
            through |= is_through ? only(family) : 0;
        }
        return through;
    }

    // Beyond an edge, in the plane of the wall, one is on the other side of each other plane that
    // passes through the edge. A surface goes on there when the same objects meet.
    [[nodiscard]] std::vector<Stroke> surface_edges(const Cell& cell, const Wall& wall) const {
        const FamilySet own = only(*wall.family);
        return edges_where(wall, [&](const Point& a, const Point& b) {
            const FamilySet through = families_through(wall, a, b);
            const FamilySet next = cell.above ^ through;
            return through == 0 || object_at(next) != object_at(cell.above) ||
                   object_at(next ^ own) != object_at(cell.above ^ own);
        });
    }

    [[nodiscard]] std::vector<Stroke> cut_edges(const Cell& cell, const Wall& wall) const {
        return edges_where(wall, [&](const Point& a, const Point& b) {
            int sides = 0;  // of the cube, that the edge lies on
            for (int axis = 0; axis < 3; ++axis) {
                sides += std::abs(a[axis] + b[axis]) > 2 - kOnPlane ? 1 : 0;
            }
            const FamilySet through = families_through(wall, a, b);
            return sides > 1 || object_at(cell.above ^ through) != object_at(cell.above);
        });
    }

    template <class Predicate>
    std::vector<Stroke> edges_where(const Wall& wall, const Predicate& is_edge) const {
        std::vector<Stroke> edges;
        for (std::size_t i = 0; i < wall.corners.size(); ++i) {
            const Point& a = wall.corners[i];
            const Point& b = wall.corners[(i + 1) % wall.corners.size()];
            if (is_edge(a, b)) {
                edges.emplace_back(place_of(a, from_), place_of(b, from_));
            }
        }
        return edges;
    }

    const Topes& topes_;
    FamilySet relevant_;
    ViewFrom from_;
    Point to_viewer_;
    std::map<FamilySet, ObjectId> objects_;
    FigureView view_;
};

// 30 degrees to the right, and up.
const double kHalf = 0.5;
const double kRest = 0.86602540378443865;

}  // namespace

Point direction_to_viewer(ViewFrom from) {
    const Point to_front(kHalf * kRest, kHalf, kRest * kRest);
    return from == ViewFrom::kFront ? to_front : Point(-to_front);
}

Place place_of(const Point& point, ViewFrom from) {
    const double right = Point(kRest, 0, -kHalf).dot(point);
    const double up = Point(-kHalf * kHalf, kRest, -kHalf * kRest).dot(point);
    return {from == ViewFrom::kFront ? right : -right, up};
}

FigureView view_figure(
    const Topes& topes, const Figure& figure, FamilySet relevant, ViewFrom from
) {
    return Viewer(topes, figure, relevant, from).view();
}

CubeEdges cube_edges(ViewFrom from) {
    // The viewer of the front is on the positive side of all three axes.
    const double far = from == ViewFrom::kFront ? -1 : 1;
    CubeEdges edges;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double a : {-1.0, 1.0}) {
            for (const double b : {-1.0, 1.0}) {
                Point end;
                end[axis] = -1;
                end[(axis + 1) % 3] = a;
                end[(axis + 2) % 3] = b;
                Point other = end;
                other[axis] = 1;
                (a == far && b == far ? edges.behind : edges.rest)
                    .emplace_back(place_of(end, from), place_of(other, from));
            }
        }
    }
    return edges;
}

}  // namespace modelsynth::continuous
