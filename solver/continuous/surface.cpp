#include "solver/continuous/surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr FamilySet bit(std::size_t family) { return FamilySet{1} << family; }

// A border of an object in a plane along an edge.
struct Border {
    ObjectId object = 0;
    std::uint8_t family = 0;
    bool is_along_normal = true;
    bool is_forth = true;  // it runs along the heading of the edge, not against it
};

// A border between two vertices.
struct HalfEdge {
    ObjectId object = 0;
    std::uint8_t family = 0;
    bool is_along_normal = true;
    std::size_t number = 0;  // of the plane in its family
    Site from = 0;
    Site to = 0;

    [[nodiscard]] auto plane() const { return std::tuple(object, family, is_along_normal, number); }
};

// What a figure along a line says of borders along it.
class BorderTable {
  public:
    explicit BorderTable(const Figures& figures) : figures_(figures) {}

    const std::vector<Border>& at(Label edge, Heading heading) {
        const auto [found, is_new] = known_.try_emplace({edge, heading}, std::vector<Border>());
        if (is_new) {
            fill(edge, heading, found->second);
        }
        return found->second;
    }

  private:
    void fill(Label edge, Heading heading, std::vector<Border>& borders) const {
        const Topes& topes = figures_.topes();
        const Figure& figure = figures_.at(edge);
        const Point along = topes.direction(heading);
        const FamilySet around = topes.lines()[heading / 2].families;
        for (std::size_t family = 0; family < topes.family_count(); ++family) {
            if ((around & bit(family)) == 0 || (figures_.relevant(edge) & bit(family)) == 0) {
                continue;
            }
            const Point left = topes.normals()[family].cross(along);
            const auto object_at = [&](double side, bool is_above) {
                FamilySet sides = topes.sides_along(heading);
                for (std::size_t other = 0; other < topes.family_count(); ++other) {
                    const bool is_positive = other == family
                                                 ? is_above
                                                 : (around & bit(other)) != 0 &&
                                                       side * topes.normals()[other].dot(left) > 0;
                    sides |= is_positive ? bit(other) : 0;
                }
                return static_cast<ObjectId>(figure[topes.tope_of(sides)]);
            };
            const ObjectId left_above = object_at(1, true);
            const ObjectId left_below = object_at(1, false);
            const ObjectId right_above = object_at(-1, true);
            const ObjectId right_below = object_at(-1, false);
            for (const ObjectId object :
                 std::set{left_above, left_below, right_above, right_below}) {
                if (object == kEmpty) {
                    continue;
                }
                for (const bool is_along_normal : {true, false}) {
                    const auto is_face = [&](ObjectId above, ObjectId below) {
                        return is_along_normal ? below == object && above != object
                                               : above == object && below != object;
                    };
                    const bool on_left = is_face(left_above, left_below);
                    const bool on_right = is_face(right_above, right_below);
                    if (on_left != on_right) {
                        borders.push_back(
                            {object,
                             static_cast<std::uint8_t>(family),
                             is_along_normal,
                             on_left == is_along_normal}
                        );
                    }
                }
            }
        }
    }

    const Figures& figures_;
    std::map<std::pair<Label, Heading>, std::vector<Border>> known_;
};

// Whether an object has a corner where a figure stands: it changes across planes that are not all
// along one line.
class CornerTable {
  public:
    explicit CornerTable(const Figures& figures) : figures_(figures) {}

    bool at(Label label, ObjectId object) {
        const auto [found, is_new] = known_.try_emplace({label, object}, false);
        if (is_new) {
            const Topes& topes = figures_.topes();
            const Figure& figure = figures_.at(label);
            FamilySet changing = 0;
            for (std::size_t tope = 0; tope < topes.count(); ++tope) {
                for (std::size_t family = 0; family < topes.family_count(); ++family) {
                    const Tope beyond = topes.across(static_cast<Tope>(tope), family);
                    const bool is_here = static_cast<ObjectId>(figure[tope]) == object;
                    const bool is_beyond = static_cast<ObjectId>(figure[beyond]) == object;
                    changing |= is_here != is_beyond ? bit(family) : 0;
                }
            }
            found->second = rank_of(topes, changing) == 3;
        }
        return found->second;
    }

  private:
    const Figures& figures_;
    std::map<std::pair<Label, ObjectId>, bool> known_;
};

class SurfaceBuilder {
  public:
    SurfaceBuilder(const Problem& problem, std::span<const Label> labels)
        : problem_(problem),
          arrangement_(problem.arrangement),
          topes_(problem.reading->topes()),
          labels_(labels),
          corners_(problem.reading->figures()),
          points_of_(arrangement_.vertex_count(), kNoPoint) {}

    Surface build() {
        collect();
        add_ground();
        std::sort(half_edges_.begin(), half_edges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
            return std::tuple(a.plane(), a.from, a.to) < std::tuple(b.plane(), b.from, b.to);
        });
        for (std::size_t first = 0; first < half_edges_.size();) {
            std::size_t end = first + 1;
            while (end < half_edges_.size() &&
                   half_edges_[end].plane() == half_edges_[first].plane()) {
                ++end;
            }
            chain(first, end);
            first = end;
        }
        return std::move(surface_);
    }

  private:
    static constexpr std::uint32_t kNoPoint = 0xFFFFFFFF;

    void collect() {
        const Figures& figures = problem_.reading->figures();
        BorderTable borders(figures);
        for (std::size_t i = 0; i < arrangement_.vertex_count(); ++i) {
            const auto site = static_cast<Site>(i);
            for (const ArrangementEdge& edge : arrangement_.edges(site)) {
                if (edge.heading % 2 != 0 || edge.end == kNoSite) {
                    continue;
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
                         border.is_forth ? site : edge.end,
                         border.is_forth ? edge.end : site}
                    );
                }
            }
        }
    }

    // The border of the ground where the box ends, and its sides and bottom.
    void add_ground() {
        const auto ground = problem_.reading->example().ground;
        if (!ground) {
            return;
        }
        const Bounds& box = arrangement_.frame().box;
        const auto family = static_cast<std::uint8_t>(*problem_.reading->horizontal());
        std::array<std::uint32_t, 4> top = {};
        std::array<std::uint32_t, 4> bottom = {};
        // Counter-clockwise seen from above.
        for (std::size_t i = 0; i < 4; ++i) {
            const double x = i == 1 || i == 2 ? box.max.x() : 0;
            const double z = i >= 2 ? 0 : box.max.z();
            top[i] = static_cast<std::uint32_t>(surface_.points.size());
            surface_.points.emplace_back(x, 0, z);
            bottom[i] = static_cast<std::uint32_t>(surface_.points.size());
            surface_.points.emplace_back(x, box.min.y(), z);
        }
        rim_ = {top[0], top[1], top[2], top[3]};
        ground_ = {*ground, family};
        surface_.polygons.push_back(
            {*ground, family, false, {{bottom[3], bottom[2], bottom[1], bottom[0]}}}
        );
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t next = (i + 1) % 4;
            // Sides lie on planes of no family; kNoFamily says so.
            surface_.polygons.push_back(
                {*ground, kNoFamily, true, {{bottom[i], bottom[next], top[next], top[i]}}}
            );
        }
        // Where nothing stands on the ground there are no edges in its plane.
        const PlaneOffsets& planes = arrangement_.planes(family);
        ground_plane_ = static_cast<std::size_t>(
            std::lower_bound(planes.begin(), planes.end(), -1e-9 * arrangement_.frame().cell) -
            planes.begin()
        );
        half_edges_.push_back({*ground, family, true, ground_plane_, kNoSite, kNoSite});
    }

    // The half-edges of one plane become loops and the loops polygons.
    void chain(std::size_t first, std::size_t end) {
        const HalfEdge& plane = half_edges_[first];
        const Point normal = (plane.is_along_normal ? 1 : -1) * topes_.normals()[plane.family];
        std::vector<std::vector<std::uint32_t>> outers;
        std::vector<std::vector<std::uint32_t>> holes;
        if (ground_ && plane.object == ground_->first && plane.family == ground_->second &&
            plane.is_along_normal && plane.number == ground_plane_) {
            outers.push_back(rim_);
        }
        std::vector<std::uint8_t> is_used(end - first);
        for (std::size_t start = first; start < end; ++start) {
            if (is_used[start - first] != 0 || half_edges_[start].from == kNoSite) {
                continue;
            }
            std::vector<std::uint32_t> loop;
            std::size_t at = start;
            do {
                is_used[at - first] = 1;
                if (corners_.at(labels_[half_edges_[at].from], plane.object)) {
                    loop.push_back(point_of(half_edges_[at].from));
                }
                at = next_of(at, first, end, normal, is_used, start);
            } while (at != start);
            (area_of(loop, normal) > 0 ? outers : holes).push_back(std::move(loop));
        }
        std::vector<SurfacePolygon> polygons;
        for (std::vector<std::uint32_t>& outer : outers) {
            polygons.push_back(
                {plane.object, plane.family, plane.is_along_normal, {std::move(outer)}}
            );
        }
        for (std::vector<std::uint32_t>& hole : holes) {
            SurfacePolygon* const around = find_around(polygons, hole, normal);
            check(around != nullptr, "a hole that is in no polygon");
            around->loops.push_back(std::move(hole));
        }
        for (SurfacePolygon& polygon : polygons) {
            surface_.polygons.push_back(std::move(polygon));
        }
    }

    // Where several borders meet in a point, the one that keeps the polygon on the left simple.
    std::size_t next_of(
        std::size_t at,
        std::size_t first,
        std::size_t end,
        const Point& normal,
        const std::vector<std::uint8_t>& is_used,
        std::size_t start
    ) const {
        const Site vertex = half_edges_[at].to;
        const auto range_begin = half_edges_.begin() + static_cast<std::ptrdiff_t>(first);
        const auto range_end = half_edges_.begin() + static_cast<std::ptrdiff_t>(end);
        auto candidate =
            std::lower_bound(range_begin, range_end, vertex, [](const HalfEdge& edge, Site site) {
                return edge.from < site;
            });
        check(candidate != range_end && candidate->from == vertex, "a border that ends");
        auto best = range_end;
        double least = 0;
        const Point back =
            arrangement_.position(half_edges_[at].from) - arrangement_.position(vertex);
        for (; candidate != range_end && candidate->from == vertex; ++candidate) {
            const auto number = static_cast<std::size_t>(candidate - half_edges_.begin());
            if (is_used[number - first] != 0 && number != start) {
                continue;
            }
            const Point out = arrangement_.position(candidate->to) - arrangement_.position(vertex);
            double angle = std::atan2(out.cross(back).dot(normal), out.dot(back));
            angle = angle <= 1e-9 ? angle + 2 * std::numbers::pi : angle;  // clockwise from back
            if (best == range_end || angle < least) {
                best = candidate;
                least = angle;
            }
        }
        check(best != range_end, "borders that form no loop");
        return static_cast<std::size_t>(best - half_edges_.begin());
    }

    std::uint32_t point_of(Site site) {
        if (points_of_[site] == kNoPoint) {
            points_of_[site] = static_cast<std::uint32_t>(surface_.points.size());
            surface_.points.push_back(arrangement_.position(site));
        }
        return points_of_[site];
    }

    [[nodiscard]] double area_of(const std::vector<std::uint32_t>& loop, const Point& normal)
        const {
        Point sum = Point::Zero();
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            const Point a = surface_.points[loop[i]] - surface_.points[loop[0]];
            const Point b = surface_.points[loop[i + 1]] - surface_.points[loop[0]];
            sum += a.cross(b) / 2;
        }
        return sum.dot(normal);
    }

    // The smallest polygon around a hole.
    SurfacePolygon* find_around(
        std::vector<SurfacePolygon>& polygons,
        const std::vector<std::uint32_t>& hole,
        const Point& normal
    ) const {
        const Point& a = surface_.points[hole[0]];
        const Point& b = surface_.points[hole[1]];
        // A little to the left of the hole's first side the polygon is.
        const Point probe = (a + b) / 2 + 1e-4 * normal.cross(b - a);
        SurfacePolygon* best = nullptr;
        double least = 0;
        for (SurfacePolygon& polygon : polygons) {
            if (surrounds(polygon.loops.front(), probe, normal)) {
                const double area = area_of(polygon.loops.front(), normal);
                if (best == nullptr || area < least) {
                    best = &polygon;
                    least = area;
                }
            }
        }
        return best;
    }

    [[nodiscard]] bool surrounds(
        const std::vector<std::uint32_t>& loop, const Point& probe, const Point& normal
    ) const {
        const Point right = normal.unitOrthogonal();
        const Point up = normal.cross(right);
        bool is_inside = false;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point a = surface_.points[loop[i]] - probe;
            const Point b = surface_.points[loop[(i + 1) % loop.size()]] - probe;
            const double ay = a.dot(up);
            const double by = b.dot(up);
            if ((ay > 0) != (by > 0)) {
                const double ax = a.dot(right);
                const double bx = b.dot(right);
                is_inside = is_inside != (ax + (bx - ax) * ay / (ay - by) > 0);
            }
        }
        return is_inside;
    }

    const Problem& problem_;
    const Arrangement& arrangement_;
    const Topes& topes_;
    std::span<const Label> labels_;
    CornerTable corners_;
    std::vector<std::uint32_t> points_of_;  // by vertex
    std::vector<HalfEdge> half_edges_;
    std::vector<std::uint32_t> rim_;                           // the ground's
    std::optional<std::pair<ObjectId, std::uint8_t>> ground_;  // and its plane's family
    std::size_t ground_plane_ = 0;                             // its number
    Surface surface_;
};

}  // namespace

Surface make_surface(const Problem& problem, std::span<const Label> labels) {
    return SurfaceBuilder(problem, labels).build();
}

}  // namespace modelsynth::continuous
