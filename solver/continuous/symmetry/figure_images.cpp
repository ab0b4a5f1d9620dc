#include "solver/continuous/symmetry/figure_images.h"

#include "solver/continuous/symmetry/figure_mover.h"
#include "solver/continuous/symmetry/motion.h"
#include "solver/continuous/symmetry/plane_images.h"
#include "solver/continuous/symmetry/shape_images.h"
#include "solver/core/label_images.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <set>
#include <tuple>

namespace modelsynth::continuous {

namespace {

constexpr int kPassesMax = 8;
// Looks at images of figures, besides as many for what is found: some tenths of a second.
constexpr std::int64_t kLooksMax = std::int64_t{1} << 19;

// A map of objects on its way to more figures that have images.
class MirrorSearch {
  public:
    MirrorSearch(const ExampleReading& reading, const SymmetryRule& rule)
        : example_(&reading.example()),
          figures_(&reading.figures()),
          mover_(reading.topes(), motion_of(rule, {}).turn),
          figures_with_(reading.example().objects.size() + 1),
          has_image_(reading.figures().count()),
          images_(object_images(reading.example(), {rule.kind})) {
        const Figures& figures = reading.figures();
        for (std::size_t l = 0; l < figures.count(); ++l) {
            const auto label = static_cast<Label>(l);
            has_image_[l] = has_image(label);
            const Figure& figure = figures.at(label);
            for (const char object : std::set<char>(figure.begin(), figure.end())) {
                figures_with_[static_cast<ObjectId>(object)].push_back(label);
            }
        }
    }

    // Exchanges the images of pairs of objects, of objects alone that are their own if told so.
    void improve(bool in_pairs_only) {
        bool is_better = true;
        for (int pass = 0; pass < kPassesMax && is_better; ++pass) {
            std::vector<std::tuple<std::ptrdiff_t, std::size_t, std::size_t>> gains;
            for (std::size_t a = 1; a < images_.size(); ++a) {
                for (std::size_t b = a + 1; b < images_.size() && looks_left_ > 0; ++b) {
                    const std::ptrdiff_t gain = gain_of(a, b, in_pairs_only);
                    if (gain > 0) {
                        gains.emplace_back(-gain, a, b);
                    }
                }
            }
            std::sort(gains.begin(), gains.end());
            is_better = false;
            for (const auto& [gain, a, b] : gains) {
                if (gain_of(a, b, in_pairs_only) > 0) {
                    exchange(a, b);
                    is_better = true;
                }
            }
        }
    }

    [[nodiscard]] bool comes_back_after(std::size_t steps) const {
        for (std::size_t object = 0; object < images_.size(); ++object) {
            auto moved = static_cast<Label>(object);
            for (std::size_t i = 0; i < steps; ++i) {
                moved = images_[moved];
            }
            if (moved != object) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] std::ptrdiff_t score() const {
        return std::count(has_image_.begin(), has_image_.end(), true);
    }

    [[nodiscard]] const std::vector<Label>& images() const { return images_; }

  private:
    [[nodiscard]] bool has_image(Label label) const {
        return figures_->find(mover_.moved(figures_->at(label), images_)) != kNoLabel;
    }

    // How many figures more would have images.
    [[nodiscard]] std::ptrdiff_t gain_of(std::size_t a, std::size_t b, bool in_pairs_only) {
        if (is_settled(a) || is_settled(b)) {
            return 0;
        }
        if (in_pairs_only && (images_[a] != a || images_[b] != b)) {
            return 0;
        }
        std::swap(images_[a], images_[b]);
        std::ptrdiff_t gain = 0;
        for_each_figure_with(a, b, [&](Label label) {
            --looks_left_;
            gain += std::ptrdiff_t{has_image(label)} - std::ptrdiff_t{has_image_[label]};
        });
        std::swap(images_[a], images_[b]);
        return gain;
    }

    // The ground stays what it is, and a shape becomes what it looks like.
    [[nodiscard]] bool is_settled(std::size_t object) const {
        return object == example_->ground ||
               has_image_by_shape(*example_, static_cast<ObjectId>(object));
    }

    void exchange(std::size_t a, std::size_t b) {
        std::swap(images_[a], images_[b]);
        for_each_figure_with(a, b, [&](Label label) { has_image_[label] = has_image(label); });
    }

    template <class Visit>
    void for_each_figure_with(std::size_t a, std::size_t b, Visit visit) const {
        std::vector<Label> either;
        std::set_union(
            figures_with_[a].begin(),
            figures_with_[a].end(),
            figures_with_[b].begin(),
            figures_with_[b].end(),
            std::back_inserter(either)
        );
        for (const Label label : either) {
            visit(label);
        }
    }

    const Example* example_;
    const Figures* figures_;
    FigureMover mover_;
    std::vector<std::vector<Label>> figures_with_;  // by object, in rising order
    std::vector<bool> has_image_;                   // by figure
    std::vector<Label> images_;                     // by object
    std::int64_t looks_left_ = kLooksMax;
};

}  // namespace

std::vector<std::pair<Label, Label>> object_pairs(const Example& example, const NamePairs& names) {
    std::vector<std::pair<Label, Label>> pairs;
    for (const auto& [object, image] : names) {
        pairs.emplace_back(find_object(example, object), find_object(example, image));
    }
    return pairs;
}

NamePairs likely_mirror(const ExampleReading& reading, const SymmetryRule& rule) {
    const Example& example = reading.example();
    const MirrorSearch unmoved(reading, rule);
    const std::size_t order = order_of(rule.kind);
    if (order == 0) {
        return {};
    }
    MirrorSearch best = unmoved;
    best.improve(true);
    if (order > 2) {
        MirrorSearch rings = unmoved;
        rings.improve(false);
        if (rings.comes_back_after(order) && rings.score() > best.score()) {
            best = std::move(rings);
        }
    }
    NamePairs names;
    for (std::size_t object = 1; object < best.images().size(); ++object) {
        const Label image = best.images()[object];
        if (image != object && !has_image_by_shape(example, static_cast<ObjectId>(object))) {
            names.emplace_back(example.objects[object - 1].name, example.objects[image - 1U].name);
        }
    }
    return names;
}

void fill_mirrors(const ExampleReading& reading, Parameters& parameters) {
    const Topes& topes = reading.topes();
    // Where shapes have images, the example was read with a mirror.
    auto known = reading.options().symmetries.begin();
    for (Constraint& constraint : *parameters.constraints) {
        auto* rule = std::get_if<SymmetryRule>(&constraint.rule);
        if (rule == nullptr) {
            continue;
        }
        const bool is_known = known != reading.options().symmetries.end() &&
                              rule->kind != SymmetryRule::Kind::kTranslate;
        if (is_known) {
            rule->mirror = (known++)->mirror;
        }
        if (rule->mirror) {
            continue;
        }
        if (have_images(topes, motion_of(*rule, {}).turn)) {
            rule->mirror = likely_mirror(reading, *rule);
        }
    }
}

std::vector<Label> figure_images(const ExampleReading& reading, const SymmetryRule& rule) {
    const Example& example = reading.example();
    SymmetryRule complete = rule;
    if (!complete.mirror) {
        complete.mirror = likely_mirror(reading, rule);
    }
    const std::vector<Label> objects = object_images(example, complete);
    const Figures& figures = reading.figures();
    const FigureMover mover(reading.topes(), motion_of(rule, {}).turn);
    std::vector<Label> images;
    for (std::size_t label = 0; label < figures.count(); ++label) {
        const Figure moved = mover.moved(figures.at(static_cast<Label>(label)), objects);
        images.push_back(figures.find(moved));
    }
    return images;
}

}  // namespace modelsynth::continuous
