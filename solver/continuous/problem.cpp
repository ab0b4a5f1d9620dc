#include "solver/continuous/problem.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

// With a ground, the box begins so many spacings below it: what stands on it has its lowest planes
// inside.
constexpr double kBelowGround = 0.25;

PlaneOffsets planes_through(const Point& normal, double spacing, const Bounds& box) {
    double low = 0;
    double high = 0;
    for (int axis = 0; axis < 3; ++axis) {
        low += std::min(normal[axis] * box.min[axis], normal[axis] * box.max[axis]);
        high += std::max(normal[axis] * box.min[axis], normal[axis] * box.max[axis]);
    }
    PlaneOffsets offsets;
    for (double k = std::floor(low / spacing); k * spacing < high - 1e-9 * spacing; ++k) {
        if (k * spacing > low + 1e-9 * spacing) {
            offsets.push_back(k * spacing);
        }
    }
    return offsets;
}

Arrangement::Frame frame_of(const Parameters& parameters, bool has_ground) {
    const double spacing = *parameters.spacing;
    const std::array<double, 3>& size = *parameters.size;
    Arrangement::Frame frame;
    frame.box.min = Point(0, has_ground ? -kBelowGround * spacing : 0, 0);
    frame.box.max = Point(size[0], size[1], size[2]);
    frame.cells = cells_of(parameters);
    frame.cell = spacing;
    return frame;
}

std::vector<Label> initial_labels(const ExampleReading& reading, const Arrangement& arrangement) {
    const Topes& topes = reading.topes();
    const Figures& figures = reading.figures();
    const Label empty = figures.find(uniform_figure(topes, kEmpty));
    std::vector<Label> labels(arrangement.vertex_count(), empty);
    if (const auto ground = reading.example().ground) {
        const std::size_t family = *reading.horizontal();
        const Label below = figures.find(uniform_figure(topes, *ground));
        const Label bare = figures.find(face_figure(topes, family, *ground, kEmpty));
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const auto site = static_cast<Site>(i);
            const double y = arrangement.position(site).y();
            // Planes of other families may meet very near to the ground's.
            const bool is_on_plane = (arrangement.families(site) >> family & 1) != 0;
            const bool is_on_ground =
                is_on_plane && std::abs(y) < arrangement.frame().cell * kBelowGround;
            labels[i] = is_on_ground ? bare : y < 0 ? below : empty;
        }
    }
    return labels;
}

// The figures that an object's dimension takes from vertices on a plane of the family: those in
// which the object is on both sides of it.
void forbid_wider(
    const ExampleReading& reading,
    FamilySet families,
    const DimensionRule& dimension,
    LabelSet& allowed
) {
    const Topes& topes = reading.topes();
    const auto& [x, y, z] = dimension.normal;
    const std::size_t family = *topes.find_family(Point(x, y, z));
    const auto object = static_cast<char>(find_object(reading.example(), dimension.object));
    if ((families >> family & 1) == 0) {
        return;
    }
    for (std::size_t l = 0; l < reading.figures().count(); ++l) {
        const Figure& figure = reading.figures().at(static_cast<Label>(l));
        for (std::size_t t = 0; t < topes.count(); ++t) {
            const Tope beyond = topes.across(static_cast<Tope>(t), family);
            if (beyond != t && figure[t] == object && figure[beyond] == object) {
                allowed.erase(static_cast<Label>(l));
                break;
            }
        }
    }
}

// A vertex takes figures that have a weight and change only across its planes, and that look the
// same as the initial model along edges that leave the box.
SiteDomains domains_of(
    const ExampleReading& reading,
    const Parameters& parameters,
    const LabelWeights& weights,
    const Arrangement& arrangement,
    std::span<const Label> initial
) {
    const Figures& figures = reading.figures();
    using Key = std::tuple<FamilySet, Label, std::vector<Heading>>;
    std::map<Key, Site> like;
    SiteDomains domains(arrangement.vertex_count(), LabelSet::all(figures.count()));
    for (std::size_t i = 0; i < arrangement.vertex_count(); ++i) {
        const auto site = static_cast<Site>(i);
        const FamilySet families = arrangement.families(site);
        std::vector<Heading> leaving;
        for (const ArrangementEdge& edge : arrangement.edges(site)) {
            if (edge.end == kNoSite) {
                leaving.push_back(edge.heading);
            }
        }
        const Label before = leaving.empty() ? kNoLabel : initial[site];
        const auto [known, is_new] = like.try_emplace({families, before, leaving}, site);
        if (!is_new) {
            domains.repeat(site, known->second);
            continue;
        }
        LabelSet allowed(figures.count());
        for (std::size_t l = 0; l < figures.count(); ++l) {
            const auto label = static_cast<Label>(l);
            const bool fits =
                (figures.relevant(label) & ~families) == 0 &&
                std::all_of(leaving.begin(), leaving.end(), [&](Heading heading) {
                    return figures.along(label, heading) == figures.along(before, heading);
                });
            if (fits) {
                allowed.insert(label);
            }
        }
        for (std::size_t l = 0; l < figures.count(); ++l) {
            if (weights.of(static_cast<Label>(l)) == 0) {
                allowed.erase(static_cast<Label>(l));
            }
        }
        for (const DimensionRule& dimension : *parameters.dimensions) {
            forbid_wider(reading, families, dimension, allowed);
        }
        domains.narrow(site, allowed);
    }
    return domains;
}

LabelWeights weights_of(const ExampleReading& reading, const Parameters& parameters) {
    const Figures& figures = reading.figures();
    const Example& example = reading.example();
    std::vector<double> of_object = {1};
    for (const ObjectType& object : example.objects) {
        double weight = object.weight;
        for (const auto& [name, given] : parameters.weights) {
            weight = name == object.name ? given : weight;
        }
        of_object.push_back(weight);
    }
    const double emptiness = 1 / (*parameters.density * *parameters.density);
    std::vector<double> weights;
    for (std::size_t label = 0; label < figures.count(); ++label) {
        std::set<ObjectId> objects;
        for (const char object : figures.at(static_cast<Label>(label))) {
            objects.insert(static_cast<ObjectId>(object));
        }
        objects.erase(kEmpty);
        if (example.ground) {
            objects.erase(*example.ground);
        }
        const FamilySet relevant = figures.relevant(static_cast<Label>(label));
        const bool is_background = objects.empty() && rank_of(reading.topes(), relevant) <= 1;
        double weight = is_background ? emptiness : 1;
        for (const ObjectId object : objects) {
            weight *= of_object[object];
        }
        weights.push_back(weight);
    }
    return LabelWeights(weights);
}

}  // namespace

Result<Problem> make_problem(
    std::shared_ptr<const ExampleReading> reading, const Parameters& parameters
) {
    const Topes& topes = reading->topes();
    const Figures& figures = reading->figures();
    const std::vector<double> fixed(topes.family_count(), 0);
    Spacings spacings = solve_spacings(figures, *parameters.spacing, fixed);
    const Arrangement::Frame frame = frame_of(parameters, reading->example().ground.has_value());
    std::vector<PlaneOffsets> planes;
    for (std::size_t family = 0; family < topes.family_count(); ++family) {
        planes.push_back(
            planes_through(topes.normals()[family], spacings.of_family[family], frame.box)
        );
    }
    auto arrangement = Arrangement::make(topes, planes, frame, kVerticesMax);
    if (!arrangement) {
        return tl::unexpected(std::move(arrangement.error()));
    }
    std::vector<Label> initial = initial_labels(*reading, *arrangement);
    const LabelWeights label_weights = weights_of(*reading, parameters);
    SiteDomains domains = domains_of(*reading, parameters, label_weights, *arrangement, initial);
    std::set<FamilySet> types;
    for (std::size_t site = 0; site < arrangement->vertex_count(); ++site) {
        types.insert(arrangement->families(static_cast<Site>(site)));
    }
    std::vector<Label> homeless;
    for (std::size_t l = 0; l < figures.count(); ++l) {
        const FamilySet relevant = figures.relevant(static_cast<Label>(l));
        const bool has_place = std::any_of(types.begin(), types.end(), [&](FamilySet families) {
            return (relevant & ~families) == 0;
        });
        if (!has_place) {
            homeless.push_back(static_cast<Label>(l));
        }
    }
    SiteWeights weights(label_weights);
    return Problem{
        std::move(reading),
        std::move(spacings),
        std::move(*arrangement),
        std::move(domains),
        std::move(weights),
        std::move(initial),
        std::move(homeless)};
}

GraphPart part_of(const Arrangement& arrangement, const Box& cells) {
    std::vector<Site> sites;
    arrangement.for_each_vertex(cells, [&](Site site) { sites.push_back(site); });
    const auto inside = [&](Site site) {
        const auto at = std::lower_bound(sites.begin(), sites.end(), site);
        return at != sites.end() && *at == site ? static_cast<Site>(at - sites.begin()) : kNoSite;
    };
    std::vector<GraphArc> arcs;
    std::vector<GraphPart::OutwardArc> outward;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        for (const ArrangementEdge& edge : arrangement.edges(sites[i])) {
            if (edge.end == kNoSite) {
                continue;
            }
            const Site far = inside(edge.end);
            if (far == kNoSite) {
                outward.push_back({static_cast<Site>(i), edge.end, edge.heading});
            } else if (edge.heading % 2 == 0) {
                arcs.push_back({static_cast<Site>(i), far, edge.heading, opposite(edge.heading)});
            }
        }
    }
    GraphTopology inner(sites.size(), arcs);
    return {std::move(inner), std::move(sites), std::move(outward)};
}

}  // namespace modelsynth::continuous
