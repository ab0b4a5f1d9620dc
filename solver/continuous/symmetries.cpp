#include "solver/continuous/symmetries.h"

#include "solver/core/label_images.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

using Kind = SymmetryRule::Kind;

constexpr double kSameDirection = 1e-6;
constexpr double kSamePlace = 1e-6;  // spacings

std::string field_of(Kind kind) {
    switch (kind) {
        case Kind::kReflectX:
        case Kind::kReflectZ:
            return "/reflect";
        case Kind::kHalfTurn:
        case Kind::kQuarterTurn:
            return "/rotate";
        case Kind::kTranslate:
            break;
    }
    return "/translate";
}

std::string text_of(const Point& point) {
    char text[96];
    std::snprintf(text, sizeof text, "[%.4g, %.4g, %.4g]", point.x(), point.y(), point.z());
    return text;
}

// The family that a family's planes become, and whether its normal turns round.
struct FamilyImage {
    std::size_t family = 0;
    bool is_turned_round = false;
};

std::optional<FamilyImage> image_of(const Topes& topes, std::size_t family, const Motion& motion) {
    const Point normal = motion.turn * topes.normals()[family];
    for (std::size_t i = 0; i < topes.family_count(); ++i) {
        const double along = normal.dot(topes.normals()[i]);
        if (std::abs(along) > 1 - kSameDirection * kSameDirection) {
            return FamilyImage{i, along < 0};
        }
    }
    return std::nullopt;
}

// The image of each object, kEmpty among them.
std::vector<Label> object_images(const Example& example, const SymmetryRule& rule) {
    std::vector<std::pair<Label, Label>> pairs;
    for (const auto& [object, image] : rule.mirror) {
        pairs.emplace_back(find_object(example, object), find_object(example, image));
    }
    return label_images(example.objects.size() + 1, pairs);
}

std::vector<Label> figure_images(
    const Example& example, const Figures& figures, const SymmetryRule& rule, const Motion& motion
) {
    const Topes& topes = figures.topes();
    const std::vector<Label> objects = object_images(example, rule);
    std::vector<Tope> topes_moved;
    for (std::size_t t = 0; t < topes.count(); ++t) {
        FamilySet sides = 0;
        for (std::size_t i = 0; i < topes.family_count(); ++i) {
            const FamilyImage image = *image_of(topes, i, motion);
            const bool is_above = (topes.sides(static_cast<Tope>(t)) >> i & 1) != 0;
            if (is_above != image.is_turned_round) {
                sides |= FamilySet{1} << image.family;
            }
        }
        topes_moved.push_back(topes.tope_of(sides));
    }
    std::vector<Label> images;
    for (std::size_t l = 0; l < figures.count(); ++l) {
        const Figure& figure = figures.at(static_cast<Label>(l));
        Figure moved(figure.size(), 0);
        for (std::size_t t = 0; t < figure.size(); ++t) {
            moved[topes_moved[t]] = static_cast<char>(objects[static_cast<ObjectId>(figure[t])]);
        }
        images.push_back(figures.find(moved));
    }
    return images;
}

// Finds vertices by where they are.
class PlaceFinder {
  public:
    explicit PlaceFinder(const Arrangement& arrangement) : arrangement_(arrangement) {}

    [[nodiscard]] Site at(const Point& place) const {
        const Arrangement::Frame& frame = arrangement_.frame();
        const double tolerance = kSamePlace * frame.cell;
        const auto cell_of = [&](double along, std::int32_t count) {
            const double cell = std::floor(along / frame.cell);
            return static_cast<std::int32_t>(std::clamp(cell, 0.0, count - 1.0));
        };
        const auto low = [&](int axis, std::int32_t count) {
            return cell_of(place[axis] - tolerance, count);
        };
        const auto high = [&](int axis, std::int32_t count) {
            return cell_of(place[axis] + tolerance, count) + 1;
        };
        const Box cells = {
            {low(0, frame.cells.x), low(1, frame.cells.y), low(2, frame.cells.z)},
            {high(0, frame.cells.x), high(1, frame.cells.y), high(2, frame.cells.z)}};
        Site found = kNoSite;
        arrangement_.for_each_vertex(cells, [&](Site site) {
            if ((arrangement_.position(site) - place).cwiseAbs().maxCoeff() < tolerance) {
                found = site;
            }
        });
        return found;
    }

  private:
    const Arrangement& arrangement_;
};

std::vector<std::vector<Label>> all_figure_images(
    const Example& example,
    const Figures& figures,
    std::span<const SymmetryRule> rules,
    const std::array<double, 3>& size
) {
    std::vector<std::vector<Label>> images;
    for (const SymmetryRule& rule : rules) {
        images.push_back(figure_images(example, figures, rule, motion_of(rule, size)));
    }
    return images;
}

// The first plane of a family, by offset, whose image is in the model and no plane of it.
std::optional<double> plane_without_image(
    const Topes& topes,
    std::size_t family,
    const Motion& motion,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
) {
    const FamilyImage image = *image_of(topes, family, motion);
    const Point& normal = topes.normals()[image.family];
    const double sign = image.is_turned_round ? -1 : 1;
    const PlaneOffsets& others = planes[image.family];
    double low = 0;
    double high = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = normal[axis] * size[static_cast<std::size_t>(axis)];
        low += std::min(0.0, reach);
        high += std::max(0.0, reach);
    }
    const double tolerance = kSamePlace * (high - low);
    for (const double offset : planes[family]) {
        const double moved = sign * offset + normal.dot(motion.shift);
        const auto next = std::lower_bound(others.begin(), others.end(), moved - tolerance);
        const bool is_plane = next != others.end() && *next < moved + tolerance;
        const bool is_inside = moved > low + tolerance && moved < high - tolerance;
        if (is_inside && !is_plane) {
            return offset;
        }
    }
    return std::nullopt;
}

}  // namespace

Motion motion_of(const SymmetryRule& rule, const std::array<double, 3>& size) {
    Motion motion = {Eigen::Matrix3d::Identity(), Point::Zero()};
    switch (rule.kind) {
        case Kind::kReflectX:
            motion.turn(0, 0) = -1;
            break;
        case Kind::kReflectZ:
            motion.turn(2, 2) = -1;
            break;
        case Kind::kHalfTurn:
            motion.turn(0, 0) = motion.turn(2, 2) = -1;
            break;
        case Kind::kQuarterTurn:
            motion.turn << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // x to -z: the east to the north
            break;
        case Kind::kTranslate:
            motion.shift = Point(rule.translation[0], rule.translation[1], rule.translation[2]);
            return motion;
    }
    const Point middle(size[0] / 2, 0, size[2] / 2);
    motion.shift = middle - motion.turn * middle;
    return motion;
}

std::size_t order_of(Kind kind) {
    return kind == Kind::kTranslate ? 0 : kind == Kind::kQuarterTurn ? 4 : 2;
}

std::optional<SymmetryFault> find_symmetry_fault(
    const Example& example,
    const Topes& topes,
    const SymmetryRule& rule,
    std::span<const PlaneOffsets> planes,
    const std::array<double, 3>& size
) {
    const std::string field = field_of(rule.kind);
    if (rule.kind == Kind::kQuarterTurn && size[0] != size[2]) {
        return SymmetryFault{field, "a quarter turn needs a model that is as wide as deep"};
    }
    const Motion motion = motion_of(rule, size);
    if (rule.kind == Kind::kTranslate && motion.shift.norm() == 0) {
        return SymmetryFault{field, "is no step away"};
    }
    std::vector<std::pair<Label, Label>> pairs;
    for (const auto& [object, image] : rule.mirror) {
        pairs.emplace_back(find_object(example, object), find_object(example, image));
    }
    if (auto fault = find_image_fault(example.objects.size() + 1, pairs, order_of(rule.kind))) {
        return SymmetryFault{"/mirror", std::move(*fault)};
    }
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        const std::string normal = text_of(topes.normals()[family]);
        if (!image_of(topes, family, motion)) {
            return SymmetryFault{
                field,
                "the example has faces of the normal " + normal +
                    " and none that would be their images"};
        }
        if (const auto plane = plane_without_image(topes, family, motion, planes, size)) {
            return SymmetryFault{
                field,
                "the plane of the normal " + normal + " at " + std::to_string(*plane) +
                    " m would have its image between planes; a size or a step of whole spacings "
                    "helps"};
        }
    }
    return std::nullopt;
}

Symmetries::Symmetries(
    const Example& example,
    const Figures& figures,
    const Relations& along_edges,
    const Arrangement& arrangement,
    std::span<const SymmetryRule> rules,
    const std::array<double, 3>& size
)
    : relations_(
          relations_with_images(along_edges, all_figure_images(example, figures, rules, size))
      ) {
    check(!rules.empty(), "symmetries without any");
    const PlaceFinder vertices(arrangement);
    const std::size_t count = arrangement.vertex_count();
    for (const SymmetryRule& rule : rules) {
        const Motion motion = motion_of(rule, size);
        Generator& generator = generators_.emplace_back(Generator{
            std::vector<Site>(count, kNoSite),
            std::vector<Site>(count, kNoSite),
            figure_images(example, figures, rule, motion),
            order_of(rule.kind) == 2});
        for (std::size_t v = 0; v < count; ++v) {
            const auto vertex = static_cast<Site>(v);
            const Point there = motion.turn * arrangement.position(vertex) + motion.shift;
            const Site image = vertices.at(there);
            generator.images[v] = image;
            if (image != kNoSite) {
                generator.origins[image] = vertex;
            }
        }
    }
}

std::vector<Site> Symmetries::close(std::vector<Site> vertices) const {
    std::vector<std::uint8_t> is_met(generators_.front().images.size());
    for (const Site vertex : vertices) {
        is_met[vertex] = 1;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        for (const Generator& generator : generators_) {
            for (const Site image :
                 {generator.images[vertices[i]], generator.origins[vertices[i]]}) {
                if (image != kNoSite && std::exchange(is_met[image], std::uint8_t{1}) == 0) {
                    vertices.push_back(image);
                }
            }
        }
    }
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

std::vector<GraphArc> Symmetries::arcs(std::span<const Site> part) const {
    const auto inside = [&](Site site) {
        return static_cast<Site>(std::lower_bound(part.begin(), part.end(), site) - part.begin());
    };
    std::vector<GraphArc> arcs;
    const std::size_t along_edges = relations_.count() - 2 * generators_.size();
    for (std::size_t i = 0; i < part.size(); ++i) {
        for (std::size_t g = 0; g < generators_.size(); ++g) {
            const Site image = generators_[g].images[part[i]];
            const bool is_seen = generators_[g].is_involution && image < part[i];
            if (image != kNoSite && image != part[i] && !is_seen) {
                const auto relation = static_cast<RelationId>(along_edges + 2 * g);
                arcs.push_back(
                    {static_cast<Site>(i),
                     inside(image),
                     relation,
                     static_cast<RelationId>(relation + 1)}
                );
            }
        }
    }
    return arcs;
}

void Symmetries::narrow(SiteDomains& domains) const {
    for (const Generator& generator : generators_) {
        LabelSet own(relations_.label_count());
        for (std::size_t l = 0; l < generator.labels.size(); ++l) {
            if (generator.labels[l] == l) {
                own.insert(static_cast<Label>(l));
            }
        }
        for (std::size_t v = 0; v < generator.images.size(); ++v) {
            if (generator.images[v] == v) {
                domains.narrow(static_cast<Site>(v), own);
            }
        }
    }
}

}  // namespace modelsynth::continuous
