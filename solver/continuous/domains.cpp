#include "solver/continuous/domains.h"

#include "solver/continuous/constraints/object_rules.h"
#include "solver/core/weight_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// A dimension of the request, made ready to ask vertices of.
struct DimensionFilter {
    std::size_t family = 0;
    char object = 0;
    std::int64_t spacings = 1;
};

// How a vertex lies to a dimension's planes.
enum class Layer : std::uint8_t {
    kBeside,   // no plane of the family passes through it
    kEnd,      // one does where the object begins and ends
    kBetween,  // one does that the object goes on through
};

std::vector<DimensionFilter> dimension_filters(
    const ExampleReading& reading, const Parameters& parameters
) {
    std::vector<DimensionFilter> filters;
    for (const Constraint& constraint : *parameters.constraints) {
        if (const auto* rule = std::get_if<DimensionRule>(&constraint.rule)) {
            const auto& [x, y, z] = rule->normal;
            const ObjectSet objects = objects_named(reading.example(), constraint.objects);
            for (std::size_t object = 1; object < objects.size(); ++object) {
                if (objects[object]) {
                    const Eigen::Matrix3d& turn = reading.example().objects[object - 1].turn;
                    const std::size_t family = *reading.find_family(turn * Point(x, y, z));
                    filters.push_back({family, static_cast<char>(object), rule->spacings});
                }
            }
        }
    }
    return filters;
}

// Whether the figure has the object as the layer asks: at an end not on both sides of the plane, in
// between not on one alone.
bool keeps_to(
    const Topes& topes, const Figure& figure, const DimensionFilter& dimension, Layer layer
) {
    for (std::size_t t = 0; t < topes.count(); ++t) {
        const Tope beyond = topes.across(static_cast<Tope>(t), dimension.family);
        if (beyond == t || figure[t] != dimension.object) {
            continue;
        }
        const bool is_on_both = figure[beyond] == dimension.object;
        if (is_on_both == (layer == Layer::kEnd)) {
            return false;
        }
    }
    return true;
}

class DomainMaker {
  public:
    DomainMaker(
        const ExampleReading& reading,
        const Parameters& parameters,
        const Arrangement& arrangement,
        const ModelPlanes& planes,
        std::span<const Label> plain
    )
        : figures_(reading.figures()),
          boundary_(parameters.boundary),
          arrangement_(arrangement),
          planes_(planes),
          plain_(plain),
          dimensions_(dimension_filters(reading, parameters)) {}

    SiteDomains make(const LabelSet& weighted) {
        using Key = std::tuple<FamilySet, Label, std::vector<Heading>, std::vector<Layer>>;
        std::map<Key, Site> like;
        SiteDomains domains(arrangement_.vertex_count(), weighted);
        for (std::size_t i = 0; i < arrangement_.vertex_count(); ++i) {
            const auto site = static_cast<Site>(i);
            const FamilySet families = arrangement_.families(site);
            std::vector<Heading> leaving;
            for (const ArrangementEdge& edge : arrangement_.edges(site)) {
                if (edge.end == kNoSite && leaves_closed_side(site, edge.heading)) {
                    leaving.push_back(edge.heading);
                }
            }
            const Label before = leaving.empty() ? kNoLabel : plain_[site];
            std::vector<Layer> layers;
            for (const DimensionFilter& dimension : dimensions_) {
                layers.push_back(layer_of(site, dimension));
            }
            const auto [known, is_new] =
                like.try_emplace({families, before, leaving, layers}, site);
            if (is_new) {
                domains.narrow(site, fitting(families, before, leaving, layers));
            } else {
                domains.repeat(site, known->second);
            }
        }
        return domains;
    }

  private:
    // Whether an edge that leaves the arrangement's box does so where the model ends.
    [[nodiscard]] bool leaves_closed_side(Site site, Heading heading) const {
        const Bounds& box = arrangement_.frame().box;
        const Point& from = arrangement_.position(site);
        const Point along = arrangement_.topes().direction(heading);
        std::array<double, 6> ways;
        ways.fill(std::numeric_limits<double>::infinity());
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(along[axis]) > 1e-9) {
                const bool is_max = along[axis] > 0;
                const double limit = is_max ? box.max[axis] : box.min[axis];
                ways[static_cast<std::size_t>(2 * axis + int{is_max})] =
                    (limit - from[axis]) / along[axis];
            }
        }
        const double first = *std::min_element(ways.begin(), ways.end());
        const double same = 1e-9 * (box.max - box.min).maxCoeff();
        for (std::size_t side = 0; side < ways.size(); ++side) {
            if (boundary_[side] == SideKind::kClosed && ways[side] <= first + same) {
                return true;
            }
        }
        return false;
    }

    [[nodiscard]] Layer layer_of(Site site, const DimensionFilter& dimension) const {
        const std::size_t family = dimension.family;
        if ((arrangement_.families(site) >> family & 1) == 0) {
            return Layer::kBeside;
        }
        if (dimension.spacings == 1) {
            return Layer::kEnd;
        }
        const std::size_t plane = arrangement_.plane_through(site, family);
        const auto number = planes_.first_number[family] + static_cast<std::int64_t>(plane);
        return number % dimension.spacings == 0 ? Layer::kEnd : Layer::kBetween;
    }

    [[nodiscard]] LabelSet fitting(
        FamilySet families,
        Label before,
        const std::vector<Heading>& leaving,
        const std::vector<Layer>& layers
    ) const {
        LabelSet allowed(figures_.count());
        for (std::size_t l = 0; l < figures_.count(); ++l) {
            const auto label = static_cast<Label>(l);
            bool fits = (figures_.relevant(label) & ~families) == 0;
            for (const Heading heading : leaving) {
                fits = fits && figures_.along(label, heading) == figures_.along(before, heading);
            }
            for (std::size_t d = 0; d < layers.size() && fits; ++d) {
                fits = layers[d] == Layer::kBeside ||
                       keeps_to(figures_.topes(), figures_.at(label), dimensions_[d], layers[d]);
            }
            if (fits) {
                allowed.insert(label);
            }
        }
        return allowed;
    }

    const Figures& figures_;
    const std::array<SideKind, 6>& boundary_;
    const Arrangement& arrangement_;
    const ModelPlanes& planes_;
    std::span<const Label> plain_;
    std::vector<DimensionFilter> dimensions_;
};

std::vector<double> weights_of_objects(const Example& example, const Parameters& parameters) {
    std::vector<double> weights = {1};
    for (const ObjectType& object : example.objects) {
        weights.push_back(object.weight);
    }
    for (const auto& [name, weight] : parameters.weights) {
        const ObjectSet objects = objects_named(example, {name});
        for (std::size_t object = 1; object < weights.size(); ++object) {
            weights[object] = objects[object] ? weight : weights[object];
        }
    }
    return weights;
}

std::vector<double> weights_of_figures(
    const ExampleReading& reading, const Parameters& parameters
) {
    const Figures& figures = reading.figures();
    const Example& example = reading.example();
    const std::vector<double> of_object = weights_of_objects(example, parameters);
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
    return weights;
}

}  // namespace

SiteDomains make_domains(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Arrangement& arrangement,
    const ModelPlanes& planes,
    std::span<const Label> plain
) {
    const std::vector<double> weights = weights_of_figures(reading, parameters);
    LabelSet weighted(weights.size());
    for (std::size_t l = 0; l < weights.size(); ++l) {
        if (weights[l] > 0) {
            weighted.insert(static_cast<Label>(l));
        }
    }
    DomainMaker maker(reading, parameters, arrangement, planes, plain);
    SiteDomains domains = maker.make(weighted);
    narrow_to_regions(reading, parameters, arrangement, domains);
    return domains;
}

Result<SiteWeights> make_weights(
    const ExampleReading& reading, const Parameters& parameters, const Arrangement& arrangement
) {
    WeightTables tables(arrangement.vertex_count(), weights_of_figures(reading, parameters));
    for (std::size_t i = 0; i < parameters.constraints->size(); ++i) {
        const Constraint& constraint = (*parameters.constraints)[i];
        const auto* rule = std::get_if<ProbabilityRule>(&constraint.rule);
        if (rule == nullptr) {
            continue;
        }
        const Coverage coverage(constraint.region, *parameters.size);
        const LabelSet named =
            figures_of(reading.figures(), objects_named(reading.example(), constraint.objects));
        for (std::size_t v = 0; v < arrangement.vertex_count(); ++v) {
            const auto site = static_cast<Site>(v);
            const double factor = 1 + coverage.at(arrangement.position(site)) * (rule->weight - 1);
            if (factor > 0 && factor != 1 && !tables.multiply(site, i, named, factor)) {
                return tl::unexpected(Error{
                    ErrorCode::kTooLarge,
                    "the probabilities come to more than " + std::to_string(kWeightTablesMax) +
                        " different tables of weights; use masks of fewer grey values",
                    {}});
            }
        }
    }
    return std::move(tables).finish();
}

}  // namespace modelsynth::continuous
