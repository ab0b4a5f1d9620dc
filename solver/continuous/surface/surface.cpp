#include "solver/continuous/surface/surface.h"

#include "solver/continuous/surface/borders.h"
#include "solver/continuous/surface/loops.h"
#include "solver/continuous/surface/perturb.h"
#include "solver/continuous/surface/rim.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

// A border of an object in a plane along an edge of the arrangement. Without an edge it says that
// the object has the plane for a face where no border is near.
struct HalfEdge {
    ObjectId object = 0;
    std::uint8_t family = 0;
    bool is_along_normal = true;
    std::size_t number = 0;  // of the plane in its family
    Site at = kNoSite;       // the edge: from this vertex ...
    Heading heading = 0;
    Site end = kNoSite;    // ... to that one, or out of the arrangement's box
    bool is_forth = true;  // the border runs that way, too

    [[nodiscard]] auto plane() const { return std::tuple(object, family, is_along_normal, number); }
};

class SurfaceBuilder {
  public:
    SurfaceBuilder(const Problem& problem, std::span<const Label> labels)
        : arrangement_(problem.arrangement),
          box_(problem.box),
          reading_(*problem.reading),
          topes_(problem.reading->topes()),
          labels_(labels),
          corners_(problem.reading->figures()),
          tolerance_(1e-9 * (box_.max - box_.min).maxCoeff()),
          points_(box_),
          point_of_(arrangement_.vertex_count(), kNoPoint) {}

    Surface build() {
        collect_borders();
        collect_faces();
        std::sort(half_edges_.begin(), half_edges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
            return std::tuple(a.plane(), a.at, a.heading) < std::tuple(b.plane(), b.at, b.heading);
        });
        for (std::size_t first = 0; first < half_edges_.size();) {
            std::size_t end = first + 1;
            while (end < half_edges_.size() &&
                   half_edges_[end].plane() == half_edges_[first].plane()) {
                ++end;
            }
            add_plane(std::span(half_edges_).subspan(first, end - first));
            first = end;
        }
        add_sides();
        surface_.points = points_.take();
        return std::move(surface_);
    }

  private:
    static constexpr std::uint32_t kNoPoint = 0xFFFFFFFF;

    void collect_borders() {
        const Figures& figures = reading_.figures();
        BorderTable borders(figures);
        for (std::size_t i = 0; i < arrangement_.vertex_count(); ++i) {
            const auto site = static_cast<Site>(i);
            for (const ArrangementEdge& edge : arrangement_.edges(site)) {
                if (edge.heading % 2 != 0 && edge.end != kNoSite) {
                    continue;  // it is seen from its other end
                }
                const Label label = figures.along(labels_[site], edge.heading);
                if (std::popcount(figures.relevant(label)) < 2) {
                    continue;
                }
                for (const Border& border : borders.at(label, edge.heading)) {
                    half_edges_.push_back(
                        {border.object,
                         border.family,
                         border.is_along_normal,
                         arrangement_.plane_through(site, border.family),
                         site,
                         edge.heading,
                         edge.end,
                         border.is_forth}
                    );
                }
            }
        }
    }

    // Faces that have no border near any vertex of their plane: at some vertex of each plane they
    // are seen.
    void collect_faces() {
        std::vector<std::vector<std::uint8_t>> is_seen(topes_.family_count());
        for (std::size_t family = 0; family < is_seen.size(); ++family) {
            is_seen[family].resize(arrangement_.planes(family).size());
        }
        FamilySet left = 0;  // families with planes that were not seen
        std::vector<std::size_t> counts;
        for (std::size_t family = 0; family < is_seen.size(); ++family) {
            counts.push_back(is_seen[family].size());
            left |= counts.back() > 0 ? only(family) : 0;
        }
        for (std::size_t v = 0; v < arrangement_.vertex_count() && left != 0; ++v) {
            const auto site = static_cast<Site>(v);
            const FamilySet here = arrangement_.families(site) & left;
            for (std::size_t family = 0; family < topes_.family_count(); ++family) {
                if ((here & only(family)) == 0) {
                    continue;
                }
                const std::size_t number = arrangement_.plane_through(site, family);
                if (std::exchange(is_seen[family][number], std::uint8_t{1}) == 0) {
                    collect_faces_at(site, family, number);
                    left &= --counts[family] == 0 ? ~only(family) : ~FamilySet{0};
                }
            }
        }
        // Where there is no vertex at all, there is the bare ground.
        if (const auto ground = reading_.example().ground) {
            const std::size_t family = *reading_.horizontal();
            const PlaneOffsets& planes = arrangement_.planes(family);
            const auto at = std::find(planes.begin(), planes.end(), 0.0);
            const auto number = static_cast<std::size_t>(at - planes.begin());
            if (at != planes.end() && is_seen[family][number] == 0) {
                half_edges_.push_back({*ground, static_cast<std::uint8_t>(family), true, number});
            }
        }
    }

    void collect_faces_at(Site site, std::size_t family, std::size_t number) {
        const Figure& figure = reading_.figures().at(labels_[site]);
        for (std::size_t t = 0; t < topes_.count(); ++t) {
            const auto tope = static_cast<Tope>(t);
            const Tope beyond = topes_.across(tope, family);
            const auto object = static_cast<ObjectId>(figure[tope]);
            if (beyond != tope && object != kEmpty && figure[beyond] != figure[tope]) {
                const bool is_above = (topes_.sides(tope) & only(family)) != 0;
                half_edges_.push_back({object, static_cast<std::uint8_t>(family), !is_above, number}
                );
            }
        }
    }

    // What of one plane, and of one object on one side of it, is in the model's box.
    void add_plane(std::span<const HalfEdge> half_edges) {
        const HalfEdge& plane = half_edges.front();
        const Point& family_normal = topes_.normals()[plane.family];
        const double offset = arrangement_.planes(plane.family)[plane.number];
        const Rim rim = rim_of(box_, family_normal, offset);
        if (rim.corners.empty()) {
            return;  // it lies beyond, or in a side of the box
        }
        std::vector<PlaneEdge> edges;
        bool has_borders = false;
        for (const HalfEdge& half_edge : half_edges) {
            has_borders = has_borders || half_edge.at != kNoSite;
            if (half_edge.at != kNoSite) {
                add_cut(half_edge, edges);
            }
        }
        const Point normal = (plane.is_along_normal ? 1 : -1) * family_normal;
        const bool is_full =
            edges.empty() && (!has_borders || is_face_at(place_on(rim), half_edges));
        put(find_loops(points_, edges, normal, oriented(rim, plane.is_along_normal), 0, is_full),
            plane.object,
            plane.family,
            plane.is_along_normal);
    }

    // The part of an edge within the box.
    void add_cut(const HalfEdge& half_edge, std::vector<PlaneEdge>& edges) {
        const Point& from = arrangement_.position(half_edge.at);
        const Point way = half_edge.end == kNoSite
                              ? topes_.direction(half_edge.heading)
                              : Point(arrangement_.position(half_edge.end) - from);
        const double length = way.norm();
        const Point along = way / length;
        double begin = 0;
        double end = half_edge.end == kNoSite ? std::numeric_limits<double>::infinity() : length;
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(along[axis]) < 1e-12) {
                if (from[axis] <= box_.min[axis] + tolerance_ ||
                    from[axis] >= box_.max[axis] - tolerance_) {
                    return;
                }
                continue;
            }
            const double a = (box_.min[axis] - from[axis]) / along[axis];
            const double b = (box_.max[axis] - from[axis]) / along[axis];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        }
        if (end - begin <= 4 * tolerance_) {
            return;
        }
        const Site far = half_edge.end;
        const bool ends_within = far != kNoSite && is_inside(arrangement_.position(far));
        const std::uint32_t first =
            is_inside(from) ? point_of(half_edge.at) : points_.on_box(from + begin * along);
        const std::uint32_t second =
            ends_within ? point_of(far) : points_.on_box(from + end * along);
        const bool is_first_corner =
            !is_inside(from) || corners_.at(labels_[half_edge.at], half_edge.object);
        const bool is_second_corner = !ends_within || corners_.at(labels_[far], half_edge.object);
        edges.push_back(
            half_edge.is_forth ? PlaneEdge{first, second, is_first_corner}
                               : PlaneEdge{second, first, is_second_corner}
        );
    }

    [[nodiscard]] bool is_inside(const Point& point) const {
        return (point.array() > box_.min.array() + tolerance_).all() &&
               (point.array() < box_.max.array() - tolerance_).all();
    }

    std::uint32_t point_of(Site site) {
        if (point_of_[site] == kNoPoint) {
            point_of_[site] = points_.add(arrangement_.position(site));
        }
        return point_of_[site];
    }

    // Some place on it; not quite its middle, which is in line with too much.
    [[nodiscard]] static Point place_on(const Rim& rim) {
        Point sum = Point::Zero();
        double weights = 0;
        for (std::size_t i = 0; i < rim.corners.size(); ++i) {
            const double weight = 1 + 0.618034 * static_cast<double>(i * i % 5);
            sum += weight * rim.corners[i];
            weights += weight;
        }
        return sum / weights;
    }

    // The rim as it is seen against the family's normal or along it.
    [[nodiscard]] static Rim oriented(Rim rim, bool is_along_normal) {
        if (!is_along_normal) {
            std::reverse(rim.corners.begin(), rim.corners.end());
            std::reverse(rim.sides.begin(), rim.sides.end());
            std::rotate(rim.sides.begin(), rim.sides.begin() + 1, rim.sides.end());
        }
        return rim;
    }

    // Whether a place in a plane of which no border comes into the box is on the object's face:
    // what stands at the nearest vertex of the plane, on the way to it, tells, and how many borders
    // are crossed on that way. From a vertex within the box, if there is any, there are none. Lines
    // that only cut off a corner of the arrangement's box have no vertices, and none of what is
    // beyond them is known: so the way is to be short.
    [[nodiscard]] bool is_face_at(const Point& place, std::span<const HalfEdge> half_edges) const {
        const HalfEdge& plane = half_edges.front();
        Site nearest = kNoSite;
        std::pair<bool, double> least = {true, std::numeric_limits<double>::infinity()};
        for (const Site site : vertices_of(plane.family, plane.number)) {
            const Point& at = arrangement_.position(site);
            const std::pair away(!is_inside(at), (at - place).squaredNorm());
            if (away < least) {
                least = away;
                nearest = site;
            }
        }
        if (nearest == kNoSite) {
            return true;  // the bare ground
        }
        const Point& from = arrangement_.position(nearest);
        const bool is_face_there = is_face_beside(nearest, (place - from).normalized(), plane);
        return is_face_there != (borders_crossed(from, place, half_edges) % 2 == 1);
    }

    // Whether the object has its face a little way from the vertex.
    [[nodiscard]] bool is_face_beside(Site site, const Point& way, const HalfEdge& plane) const {
        constexpr double kAside = 1e-7;
        const Figure& figure = reading_.figures().at(labels_[site]);
        const auto object_at = [&](double side) {
            // On no plane, so that it lies in some cell.
            const Point aside = kAside * 1e-3 * Point(0.31, 0.53, 0.79);
            const Point there = way + side * topes_.normals()[plane.family] + aside;
            FamilySet sides = 0;
            for (std::size_t family = 0; family < topes_.family_count(); ++family) {
                sides |= topes_.normals()[family].dot(there) > 0 ? only(family) : 0;
            }
            return static_cast<ObjectId>(figure[topes_.tope_of(sides)]);
        };
        const double out = plane.is_along_normal ? kAside : -kAside;
        return object_at(-out) == plane.object && object_at(out) != plane.object;
    }

    // Of those in the plane, on the straight way from a vertex to a place.
    [[nodiscard]] std::size_t borders_crossed(
        const Point& from, const Point& to, std::span<const HalfEdge> half_edges
    ) const {
        const double length = (to - from).norm();
        const Point along = (to - from) / length;
        const Point left = topes_.normals()[half_edges.front().family].cross(along);
        std::size_t count = 0;
        for (const HalfEdge& half_edge : half_edges) {
            if (half_edge.at == kNoSite) {
                continue;
            }
            const auto [a, b] = ends_of(half_edge);
            const double above_a = (a - from).dot(left);
            const double above_b = (b - from).dot(left);
            if ((above_a > 0) != (above_b > 0)) {
                const Point met = a + above_a / (above_a - above_b) * (b - a);
                const double away = (met - from).dot(along);
                count += std::size_t{away > tolerance_ && away < length};
            }
        }
        return count;
    }

    // The ends of an edge; where the arrangement's box ends it, it ends.
    [[nodiscard]] std::pair<Point, Point> ends_of(const HalfEdge& half_edge) const {
        const Point& at = arrangement_.position(half_edge.at);
        if (half_edge.end != kNoSite) {
            return {at, arrangement_.position(half_edge.end)};
        }
        const Bounds& box = arrangement_.frame().box;
        const Point along = topes_.direction(half_edge.heading);
        double way = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(along[axis]) > 1e-12) {
                const double limit = along[axis] > 0 ? box.max[axis] : box.min[axis];
                way = std::min(way, (limit - at[axis]) / along[axis]);
            }
        }
        return {at, at + way * along};
    }

    // Of one plane. They are gathered when first asked for.
    [[nodiscard]] std::span<const Site> vertices_of(std::size_t family, std::size_t number) const {
        if (vertices_.empty()) {
            vertices_.resize(topes_.family_count());
            for (std::size_t f = 0; f < vertices_.size(); ++f) {
                vertices_[f].resize(arrangement_.planes(f).size());
            }
            for (std::size_t v = 0; v < arrangement_.vertex_count(); ++v) {
                const auto site = static_cast<Site>(v);
                for (std::size_t f = 0; f < vertices_.size(); ++f) {
                    if ((arrangement_.families(site) & only(f)) != 0) {
                        vertices_[f][arrangement_.plane_through(site, f)].push_back(site);
                    }
                }
            }
        }
        return vertices_[family][number];
    }

    void put(
        std::optional<PlaneLoops> loops, ObjectId object, std::uint8_t family, bool is_along_normal
    ) {
        if (!loops) {
            surface_.is_closed = false;
            return;
        }
        for (auto& polygon : loops->polygons) {
            surface_.polygons.push_back({object, family, is_along_normal, std::move(polygon)});
        }
        for (const RimPiece& piece : loops->pieces) {
            if (family != kNoFamily) {
                cuts_[{piece.side, object}].push_back({piece.to, piece.from});
            }
        }
    }

    // Where the box cuts through objects they end in its sides.
    void add_sides() {
        for (BoxSide side = 0; side < kBoxSides; ++side) {
            const ObjectId throughout = object_throughout(side);
            if (throughout != kEmpty && !cuts_.contains({side, throughout})) {
                cuts_[{side, throughout}] = {};
            }
        }
        const std::map<std::pair<BoxSide, ObjectId>, std::vector<PlaneEdge>> cuts =
            std::move(cuts_);
        for (const auto& [where, edges] : cuts) {
            const auto& [side, object] = where;
            put(find_loops(
                    points_,
                    edges,
                    normal_of(side),
                    rim_of(box_, side),
                    static_cast<BoxSides>(1U << side),
                    true
                ),
                object,
                kNoFamily,
                true);
        }
    }

    // An object that fills a whole side of the box, as some edge that leaves through it shows.
    [[nodiscard]] ObjectId object_throughout(BoxSide side) const {
        const double limit = side % 2 == 0 ? box_.min[side / 2] : box_.max[side / 2];
        const double out = side % 2 == 0 ? -1 : 1;
        for (std::size_t v = 0; v < arrangement_.vertex_count(); ++v) {
            const auto site = static_cast<Site>(v);
            const Point& from = arrangement_.position(site);
            if (!is_inside(from)) {
                continue;
            }
            for (const ArrangementEdge& edge : arrangement_.edges(site)) {
                const Point along = topes_.direction(edge.heading);
                const double speed = out * along[side / 2];
                if (speed < 1e-9) {
                    continue;
                }
                const double way = out * (limit - from[side / 2]) / speed;
                if (edge.end != kNoSite && (arrangement_.position(edge.end) - from).norm() < way) {
                    continue;
                }
                Point met = from + way * along;
                met[side / 2] = (box_.min[side / 2] + box_.max[side / 2]) / 2;
                if (!is_inside(met)) {
                    continue;
                }
                const Figure& figure =
                    reading_.figures().at(reading_.figures().along(labels_[site], edge.heading));
                const bool is_uniform = std::all_of(figure.begin(), figure.end(), [&](char object) {
                    return object == figure.front();
                });
                return is_uniform ? static_cast<ObjectId>(figure.front()) : kEmpty;
            }
        }
        return side == 2 ? reading_.example().ground.value_or(kEmpty) : kEmpty;
    }

    const Arrangement& arrangement_;
    Bounds box_;
    const ExampleReading& reading_;
    const Topes& topes_;
    std::span<const Label> labels_;
    CornerTable corners_;
    double tolerance_;
    PointTable points_;
    std::vector<std::uint32_t> point_of_;  // by vertex
    std::vector<HalfEdge> half_edges_;
    mutable std::vector<std::vector<std::vector<Site>>> vertices_;  // see vertices_of()
    // Where objects are cut off by sides of the box.
    std::map<std::pair<BoxSide, ObjectId>, std::vector<PlaneEdge>> cuts_;
    Surface surface_;
};

}  // namespace

Surface make_surface(const Problem& problem, std::span<const Label> labels) {
    Surface surface = SurfaceBuilder(problem, labels).build();
    if (problem.perturbation > 0) {
        const ObjectId ground = problem.reading->example().ground.value_or(kEmpty);
        perturb(
            surface,
            problem.reading->topes(),
            problem.box,
            problem.perturbation,
            {ground, problem.stiff}
        );
    }
    return surface;
}

}  // namespace modelsynth::continuous
