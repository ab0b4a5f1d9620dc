#include "solver/continuous/constraints/object_rules.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

// What is looked at of a cell is away from its vertex by this share of the least distance of
// parallel planes.
constexpr double kLook = 0.2;

// How a cell lies to a region. Below y = 0 the ground is left alone, and what is to fill a region
// need not go on; but what is sunk into the ground is kept out of what is above it.
enum class Within : std::uint8_t { kNot, kAbove, kBelow };

// By tope.
using Cells = std::vector<Within>;

// One rule that says which objects may not be where.
class RegionRule {
  public:
    RegionRule(const ExampleReading& reading, const Constraint& constraint, const Parameters& of)
        : figures_(reading.figures()),
          coverage_(constraint.region, *of.size),
          banned_(objects_named(reading.example(), constraint.objects)) {
        if (std::holds_alternative<FixedRule>(constraint.rule)) {
            banned_.flip();
        } else {
            banned_below_ = banned_;
            banned_below_.reset(kEmpty);
            banned_below_.reset(reading.example().ground.value_or(kEmpty));
        }
    }

    // The figures that are left to a vertex; null: all.
    const LabelSet* allowed(const Point& place, double look) {
        const Topes& topes = figures_.topes();
        const bool is_low = place.y() < look && banned_below_.any();
        if (!is_low && coverage_.is_uniform(place, look)) {
            return coverage_.at(place) >= 1 ? &inside() : nullptr;
        }
        Cells within(topes.count(), Within::kNot);
        bool any = false;
        for (std::size_t t = 0; t < topes.count(); ++t) {
            Point there = place + look * topes.inside(static_cast<Tope>(t));
            const bool is_below = there.y() < 0;
            if (is_low && is_below) {
                there.y() = 0;
            }
            if (coverage_.at(there) >= 1) {
                within[t] = is_below ? Within::kBelow : Within::kAbove;
                any = true;
            }
        }
        return any ? &of_cells(std::move(within)) : nullptr;
    }

  private:
    const LabelSet& inside() {
        if (!inside_) {
            inside_ = filtered(Cells(figures_.topes().count(), Within::kAbove));
        }
        return *inside_;
    }

    const LabelSet& of_cells(Cells within) {
        const auto known = of_cells_.find(within);
        if (known != of_cells_.end()) {
            return known->second;
        }
        LabelSet set = filtered(within);
        return of_cells_.emplace(std::move(within), std::move(set)).first->second;
    }

    [[nodiscard]] LabelSet filtered(const Cells& within) const {
        LabelSet set(figures_.count());
        for (std::size_t l = 0; l < figures_.count(); ++l) {
            const Figure& figure = figures_.at(static_cast<Label>(l));
            bool fits = true;
            for (std::size_t t = 0; t < within.size(); ++t) {
                const auto object = static_cast<ObjectId>(figure[t]);
                fits = fits && !(within[t] == Within::kAbove && banned_[object]) &&
                       !(within[t] == Within::kBelow && banned_below_[object]);
            }
            if (fits) {
                set.insert(static_cast<Label>(l));
            }
        }
        return set;
    }

    const Figures& figures_;
    Coverage coverage_;
    ObjectSet banned_;
    ObjectSet banned_below_;  // y = 0
    std::optional<LabelSet> inside_;
    std::map<Cells, LabelSet> of_cells_;
};

bool bans_objects(const Constraint& constraint) {
    const auto* probability = std::get_if<ProbabilityRule>(&constraint.rule);
    return std::holds_alternative<FixedRule>(constraint.rule) ||
           std::holds_alternative<ForbiddenRule>(constraint.rule) ||
           (probability != nullptr && probability->weight == 0);
}

}  // namespace

ObjectSet objects_named(const Example& example, const std::vector<std::string>& names) {
    ObjectSet objects;
    for (const std::string& name : names) {
        objects.set(find_object(example, name));  // kEmpty of kEmptyName
    }
    // Either comes after what it is of.
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const ObjectType& type = example.objects[i];
        for (const ObjectId whole : {type.rest_of, type.variant_of}) {
            if (whole != kEmpty && objects[whole]) {
                objects.set(i + 1);
            }
        }
    }
    return objects;
}

LabelSet figures_of(const Figures& figures, const ObjectSet& objects) {
    LabelSet set(figures.count());
    for (std::size_t l = 0; l < figures.count(); ++l) {
        for (const char object : figures.at(static_cast<Label>(l))) {
            if (objects[static_cast<ObjectId>(object)]) {
                set.insert(static_cast<Label>(l));
            }
        }
    }
    return set;
}

void narrow_to_regions(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Arrangement& arrangement,
    SiteDomains& domains
) {
    const double look = kLook * arrangement.least_distance();
    for (const Constraint& constraint : *parameters.constraints) {
        if (!bans_objects(constraint)) {
            continue;
        }
        RegionRule rule(reading, constraint, parameters);
        for (std::size_t i = 0; i < arrangement.vertex_count(); ++i) {
            const auto site = static_cast<Site>(i);
            if (const LabelSet* allowed = rule.allowed(arrangement.position(site), look)) {
                domains.narrow(site, *allowed);
            }
        }
    }
}

}  // namespace modelsynth::continuous
