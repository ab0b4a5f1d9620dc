#include "solver/continuous/symmetry/symmetries.h"

#include "solver/continuous/planes/vertex_finder.h"
#include "solver/continuous/symmetry/figure_images.h"
#include "solver/continuous/symmetry/motion.h"
#include "solver/core/label_images.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace modelsynth::continuous {

namespace {

using Kind = SymmetryRule::Kind;

constexpr double kSamePlace = 1e-6;  // of the model's extent

std::vector<std::vector<Label>> all_figure_images(
    const ExampleReading& reading, std::span<const SymmetryRule> rules
) {
    std::vector<std::vector<Label>> images;
    for (const SymmetryRule& rule : rules) {
        images.push_back(figure_images(reading, rule));
    }
    return images;
}

}  // namespace

Symmetries::Symmetries(
    const ExampleReading& reading,
    const Arrangement& arrangement,
    std::span<const SymmetryRule> rules,
    const std::array<double, 3>& size
)
    : Symmetries(reading.relations(), arrangement, rules, all_figure_images(reading, rules), size) {
}

Symmetries::Symmetries(
    const Relations& along_edges,
    const Arrangement& arrangement,
    std::span<const SymmetryRule> rules,
    std::vector<std::vector<Label>> labels,
    const std::array<double, 3>& size
)
    : middle_(size[0] / 2, 0, size[2] / 2), relations_(relations_with_images(along_edges, labels)) {
    check(!rules.empty(), "symmetries without any");
    const VertexFinder vertices(arrangement);
    const std::size_t count = arrangement.vertex_count();
    for (std::size_t i = 0; i < rules.size(); ++i) {
        kinds_.push_back(rules[i].kind);
        const Motion motion = motion_of(rules[i], size);
        Generator& generator = generators_.emplace_back(Generator{
            std::vector<Site>(count, kNoSite),
            std::vector<Site>(count, kNoSite),
            std::move(labels[i]),
            order_of(rules[i].kind) == 2});
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

std::size_t Symmetries::imageless() const {
    std::size_t count = 0;
    for (std::size_t label = 0; label < relations_.label_count(); ++label) {
        count += std::any_of(
                     generators_.begin(),
                     generators_.end(),
                     [&](const Generator& generator) { return generator.labels[label] == kNoLabel; }
                 )
                     ? 1U
                     : 0U;
    }
    return count;
}

bool Symmetries::hold_at(Site vertex, std::span<const Label> labels) const {
    return std::all_of(generators_.begin(), generators_.end(), [&](const Generator& generator) {
        const Site image = generator.images[vertex];
        return image == kNoSite || generator.labels[labels[vertex]] == labels[image];
    });
}

bool Symmetries::is_filled_by_images(const Point& corner) const {
    // Reflections and turns all together leave a half of the model, or a quarter, to be made: that
    // with the lesser x and z. What begins exactly in the middle has vertices on the line there.
    const bool is_east = corner.x() > middle_.x() * (1 + kSamePlace);
    const bool is_south = corner.z() > middle_.z() * (1 + kSamePlace);
    return std::any_of(kinds_.begin(), kinds_.end(), [&](Kind kind) {
        switch (kind) {
            case Kind::kReflectX:
            case Kind::kHalfTurn:
                return is_east;
            case Kind::kReflectZ:
                return is_south;
            case Kind::kQuarterTurn:
                return is_east || is_south;
            case Kind::kTranslate:
                break;
        }
        return false;
    });
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
