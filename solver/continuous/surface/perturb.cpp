#include "solver/continuous/surface/perturb.h"

#include "solver/continuous/check/face_crossings.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/surface/plane_index.h"
#include "solver/continuous/triangulation/triangulation.h"
#include "solver/core/disjoint_sets.h"
#include "solver/core/random.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr std::uint32_t kPurposePerturbation = 18;  // RandomKey::purpose
constexpr double kShortest = 0.3;                   // of an edge, of what it was
constexpr int kRounds = 32;

// Polygons that touch in one plane are one face. Free faces that cannot be moved one by one are one
// body; it goes along the firm faces that it meets.
class Perturbation {
  public:
    Perturbation(
        Surface& surface,
        const Topes& topes,
        const Bounds& box,
        double most,
        const StiffObjects& stiff
    )
        : surface_(surface),
          box_(box),
          most_(most),
          before_(surface.points),
          faces_(surface.polygons.size()),
          bodies_(surface.polygons.size()),
          is_firm_(surface.polygons.size()),
          stays_(surface.polygons.size()),
          is_rigid_(surface.polygons.size()),
          along_(surface.polygons.size()) {
        const PlaneIndex index(surface, topes);
        index.for_each_touching([this](std::size_t a, std::size_t b) { faces_.join(a, b); });
        find_normals(topes);
        for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
            const SurfacePolygon& polygon = surface.polygons[p];
            if (polygon.family == kNoFamily || polygon.object == stiff.ground) {
                is_firm_[faces_.find(p)] = true;
            }
        }
        find_faces_at_points(index);
        make_bodies(stiff);
    }

    void move() {
        for (int round = 0; round < kRounds; ++round) {
            for (std::size_t point = 0; point < before_.size(); ++point) {
                surface_.points[point] = before_[point] + shift_of(point);
            }
            if (!hold_what_goes_wrong() && !hold_what_crosses()) {
                return;
            }
        }
        surface_.points = before_;
    }

  private:
    [[nodiscard]] std::size_t body_of(std::size_t polygon) {
        return bodies_.find(faces_.find(polygon));
    }

    void find_normals(const Topes& topes) {
        for (const SurfacePolygon& polygon : surface_.polygons) {
            normals_.push_back(
                polygon.family == kNoFamily
                    ? area_vector(surface_.points, polygon.loops.front()).normalized()
                    : topes.normals()[polygon.family]
            );
        }
    }

    // A point's own faces, and those that come by without a corner there.
    void find_faces_at_points(const PlaneIndex& index) {
        faces_at_.resize(surface_.points.size());
        for (std::size_t p = 0; p < surface_.polygons.size(); ++p) {
            for (const auto& loop : surface_.polygons[p].loops) {
                for (const std::uint32_t point : loop) {
                    faces_at_[point].push_back(p);
                }
            }
        }
        for (std::size_t point = 0; point < faces_at_.size(); ++point) {
            std::vector<std::size_t>& faces = faces_at_[point];
            if (faces.empty()) {
                continue;
            }
            index.find(surface_.points[point], faces);
            for (std::size_t& face : faces) {
                face = faces_.find(face);
            }
            std::sort(faces.begin(), faces.end());
            faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        }
    }

    void make_bodies(const StiffObjects& stiff) {
        std::vector<std::vector<std::size_t>> together = opposite_faces(stiff);
        for (const std::vector<std::size_t>& faces : faces_at_) {
            if (faces.size() > 3) {
                together.push_back(faces);
            }
        }
        for (const std::vector<std::size_t>& faces : together) {
            const std::size_t first = free_face(faces);
            for (const std::size_t face : faces) {
                if (!is_firm_[face]) {
                    bodies_.join(face, first);
                }
            }
        }
        for (const std::vector<std::size_t>& faces : together) {
            const std::size_t first = free_face(faces);
            if (first == kNone) {
                continue;
            }
            const std::size_t body = bodies_.find(first);
            is_rigid_[body] = true;
            for (const std::size_t face : faces) {
                if (is_firm_[face]) {
                    go_along(body, normals_[face]);
                }
            }
        }
    }

    // Faces that keep their distance: of each piece of an object those of a family across which it
    // is stiff.
    [[nodiscard]] std::vector<std::vector<std::size_t>> opposite_faces(const StiffObjects& stiff) {
        DisjointSets pieces(surface_.polygons.size());
        std::map<std::pair<ObjectId, std::uint32_t>, std::size_t> polygon_at;
        for (std::size_t p = 0; p < surface_.polygons.size(); ++p) {
            for (const auto& loop : surface_.polygons[p].loops) {
                for (const std::uint32_t point : loop) {
                    const auto [at, is_new] =
                        polygon_at.try_emplace({surface_.polygons[p].object, point}, p);
                    pieces.join(p, at->second);
                }
            }
        }
        std::map<std::pair<std::size_t, std::uint8_t>, std::vector<std::size_t>> opposite;
        for (std::size_t p = 0; p < surface_.polygons.size(); ++p) {
            const SurfacePolygon& polygon = surface_.polygons[p];
            if (polygon.family != kNoFamily &&
                (stiff.across[polygon.object] >> polygon.family & 1) != 0) {
                opposite[{pieces.find(p), polygon.family}].push_back(faces_.find(p));
            }
        }
        std::vector<std::vector<std::size_t>> faces;
        for (auto& [piece, of_piece] : opposite) {
            faces.push_back(std::move(of_piece));
        }
        return faces;
    }

    // kNone: there is none.
    [[nodiscard]] std::size_t free_face(const std::vector<std::size_t>& faces) const {
        const auto free = std::find_if(faces.begin(), faces.end(), [this](std::size_t face) {
            return !is_firm_[face];
        });
        return free == faces.end() ? kNone : *free;
    }

    // The body does not move across faces of the normal.
    void go_along(std::size_t body, Point normal) {
        for (const Point& other : along_[body]) {
            normal -= normal.dot(other) * other;
        }
        if (normal.norm() > 1e-6) {
            along_[body].push_back(normal.normalized());
        }
    }

    // Of a body that is moved as a whole.
    [[nodiscard]] Point shift_of_body(std::size_t body) const {
        if (stays_[body]) {
            return Point::Zero();
        }
        Point shift = most_ * random_of(body);
        for (const Point& normal : along_[body]) {
            shift -= shift.dot(normal) * normal;
        }
        return shift;
    }

    // By how much a face moves along its normal.
    [[nodiscard]] double offset_of(std::size_t face) {
        const std::size_t body = bodies_.find(face);
        if (is_firm_[face] || stays_[body]) {
            return 0;
        }
        return is_rigid_[body] ? normals_[face].dot(shift_of_body(body))
                               : most_ * random_of(body).x();
    }

    // A random point in a ball, or its first number between -1 and 1, that depends on where the
    // body is.
    [[nodiscard]] Point random_of(std::size_t body) const {
        const Point& normal = normals_[body];
        const Point& place = before_[surface_.polygons[body].loops.front().front()];
        const auto number = [](double metres) {
            return static_cast<std::uint32_t>(std::llround(metres * 1024));
        };
        RandomStream random(
            {std::uint64_t{number(place.x())} << 32 | number(place.z()),
             number(place.y()),
             number(normal.x() + 2 * normal.y() + 4 * normal.z()),
             kPurposePerturbation}
        );
        Point point;
        do {
            for (int axis = 0; axis < 3; ++axis) {
                point[axis] = random.next() / 2147483648.0 - 1;
            }
        } while (point.norm() > 1);
        return point;
    }

    [[nodiscard]] Point shift_of(std::size_t point) {
        const std::vector<std::size_t>& faces = faces_at_[point];
        if (faces.size() < 3) {
            return Point::Zero();
        }
        if (faces.size() > 3) {  // one body, beside firm faces
            const std::size_t free = free_face(faces);
            return free == kNone ? Point(Point::Zero()) : shift_of_body(bodies_.find(free));
        }
        Eigen::Matrix3d normals;
        Point offsets;
        for (int i = 0; i < 3; ++i) {
            const std::size_t face = faces[static_cast<std::size_t>(i)];
            normals.row(i) = normals_[face];
            offsets[i] = offset_of(face);
        }
        return normals.inverse() * offsets;
    }

    // Whether there was any; the bodies at it stay from now on.
    bool hold_what_goes_wrong() {
        bool any = false;
        const auto hold_at = [&](std::uint32_t point) {
            for (const std::size_t face : faces_at_[point]) {
                any = (!is_firm_[face] && hold(bodies_.find(face))) || any;
            }
        };
        for (const SurfacePolygon& polygon : surface_.polygons) {
            for (const auto& loop : polygon.loops) {
                for (std::size_t i = 0; i < loop.size(); ++i) {
                    const std::uint32_t a = loop[i];
                    const std::uint32_t b = loop[(i + 1) % loop.size()];
                    const Point was = before_[b] - before_[a];
                    const Point is = surface_.points[b] - surface_.points[a];
                    if (!is_in_box(surface_.points[a])) {
                        hold_at(a);
                    }
                    if (!(is.dot(was) >= kShortest * was.squaredNorm())) {
                        hold_at(a);
                        hold_at(b);
                    }
                }
            }
        }
        return any;
    }

    // As above, of faces that go through each other: those of boxes cannot, but slopes may come
    // near to what they do not touch. Looked at part by part.
    bool hold_what_crosses() {
        if (are_all_along_axes()) {
            return false;
        }
        bool any = false;
        for (const auto& [cell, triangles] : triangles_by_cell()) {
            Polyhedron part;
            for (const Triangle& triangle : triangles) {
                const auto first = static_cast<std::uint32_t>(part.corners.size());
                for (const std::uint32_t corner : triangle.corners) {
                    part.corners.push_back(surface_.points[corner]);
                }
                part.faces.push_back({first, first + 1, first + 2});
            }
            std::size_t work = kCrossingWorkMax;
            const auto crossings = find_crossings(
                part, 1e-7 * (box_.max - box_.min).maxCoeff(), part.faces.size(), work
            );
            if (!crossings) {
                for (const Triangle& triangle : triangles) {
                    any = hold(body_of(triangle.polygon)) || any;
                }
                continue;
            }
            for (const FaceCrossing& crossing : *crossings) {
                any = hold(body_of(triangles[crossing.first].polygon)) || any;
                any = hold(body_of(triangles[crossing.second].polygon)) || any;
            }
        }
        return any;
    }

    // Whether the body stays from now on, and did not so far.
    bool hold(std::size_t body) {
        const bool was_free = !stays_[body];
        stays_[body] = true;
        return was_free;
    }

    [[nodiscard]] bool are_all_along_axes() const {
        return std::all_of(normals_.begin(), normals_.end(), [](const Point& normal) {
            return normal.cwiseAbs().maxCoeff() > 1 - kNormalTolerance;
        });
    }

    struct Triangle {
        std::size_t polygon = 0;
        std::array<std::uint32_t, 3> corners = {};
    };

    // In each cell of a coarse grid what reaches into it.
    [[nodiscard]] std::map<std::array<std::int64_t, 3>, std::vector<Triangle>> triangles_by_cell(
    ) const {
        const double cell = 24 * most_;
        std::map<std::array<std::int64_t, 3>, std::vector<Triangle>> cells;
        for (std::size_t p = 0; p < surface_.polygons.size(); ++p) {
            for (const auto& corners : triangles_of(p)) {
                Point min = surface_.points[corners[0]];
                Point max = min;
                for (const std::uint32_t corner : corners) {
                    min = min.cwiseMin(surface_.points[corner]);
                    max = max.cwiseMax(surface_.points[corner]);
                }
                const auto first = [&](int axis) { return std::llround(min[axis] / cell - 0.5); };
                const auto last = [&](int axis) { return std::llround(max[axis] / cell - 0.5); };
                for (std::int64_t x = first(0); x <= last(0); ++x) {
                    for (std::int64_t y = first(1); y <= last(1); ++y) {
                        for (std::int64_t z = first(2); z <= last(2); ++z) {
                            cells[{x, y, z}].push_back({p, corners});
                        }
                    }
                }
            }
        }
        return cells;
    }

    [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles_of(std::size_t polygon
    ) const {
        const Point right = normals_[polygon].unitOrthogonal();
        const bool is_seen_against = surface_.polygons[polygon].family == kNoFamily ||
                                     surface_.polygons[polygon].is_along_normal;
        const Point up = (is_seen_against ? 1 : -1) * normals_[polygon].cross(right);
        std::vector<std::uint32_t> numbers;
        std::vector<Point2> flat;
        std::vector<Loop> loops;
        std::unordered_map<std::uint32_t, std::uint32_t> known;
        for (const auto& loop : surface_.polygons[polygon].loops) {
            Loop& own = loops.emplace_back();
            for (const std::uint32_t point : loop) {
                const auto next = static_cast<std::uint32_t>(flat.size());
                const auto [at, is_new] = known.try_emplace(point, next);
                if (is_new) {
                    numbers.push_back(point);
                    const Point& place = surface_.points[point];
                    flat.push_back({place.dot(right), place.dot(up)});
                }
                own.push_back(at->second);
            }
        }
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (const auto& [a, b, c] :
             triangulate(flat, loops.front(), std::span(loops).subspan(1))) {
            triangles.push_back({numbers[a], numbers[b], numbers[c]});
        }
        return triangles;
    }

    [[nodiscard]] bool is_in_box(const Point& point) const {
        const double tolerance = 1e-9 * (box_.max - box_.min).maxCoeff();
        return (point.array() >= box_.min.array() - tolerance).all() &&
               (point.array() <= box_.max.array() + tolerance).all();
    }

    static constexpr std::size_t kNone = ~std::size_t{0};

    Surface& surface_;
    const Bounds& box_;
    double most_;
    std::vector<Point> before_;
    DisjointSets faces_;                              // of polygons
    DisjointSets bodies_;                             // of faces, by their names
    std::vector<Point> normals_;                      // by polygon
    std::vector<bool> is_firm_;                       // by face
    std::vector<bool> stays_;                         // by body
    std::vector<bool> is_rigid_;                      // by body: else it is one face
    std::vector<std::vector<Point>> along_;           // by body, at right angles to each other
    std::vector<std::vector<std::size_t>> faces_at_;  // by point, each once, rising
};

}  // namespace

void perturb(
    Surface& surface, const Topes& topes, const Bounds& box, double most, const StiffObjects& stiff
) {
    Perturbation(surface, topes, box, most, stiff).move();
}

}  // namespace modelsynth::continuous
