#include "solver/continuous/symmetry/figure_images.h"

#include "solver/continuous/symmetry/motion.h"
#include "solver/continuous/symmetry/plane_images.h"
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

std::vector<Tope> tope_images(const Topes& topes, const Eigen::Matrix3d& turn) {
    std::vector<FamilyImage> families;
    for (std::size_t i = 0; i < topes.family_count(); ++i) {
        families.push_back(family_image(topes, i, turn).value());
    }
    std::vector<Tope> images;
    for (std::size_t t = 0; t < topes.count(); ++t) {
        FamilySet sides = 0;
        for (std::size_t i = 0; i < families.size(); ++i) {
            const bool is_above = (topes.sides(static_cast<Tope>(t)) >> i & 1) != 0;
            if (is_above != families[i].is_turned_round) {
                sides |= FamilySet{1} << families[i].family;
            }
        }
        images.push_back(topes.tope_of(sides));
    }
    return images;
}

// Figures as a motion and a map of objects leave them.
class FigureMover {
  public:
    FigureMover(const Figures& figures, const SymmetryRule& rule)
        : figures_(&figures), topes_(tope_images(figures.topes(), motion_of(rule, {}).turn)) {}

    [[nodiscard]] Label image(Label label, const std::vector<Label>& objects) const {
        const Figure& figure = figures_->at(label);
        Figure moved(figure.size(), 0);
        for (std::size_t t = 0; t < figure.size(); ++t) {
            moved[topes_[t]] = static_cast<char>(objects[static_cast<ObjectId>(figure[t])]);
        }
        return figures_->find(moved);
    }

  private:
    const Figures* figures_;
    std::vector<Tope> topes_;
};

// A map of objects on its way to more figures that have images.
class MirrorSearch {
  public:
    MirrorSearch(const ExampleReading& reading, const SymmetryRule& rule)
        : ground_(reading.example().ground),
          mover_(reading.figures(), rule),
          figures_with_(reading.example().objects.size() + 1),
          has_image_(reading.figures().count()),
          images_(figures_with_.size()) {
        std::iota(images_.begin(), images_.end(), Label{0});
        const Figures& figures = reading.figures();
        for (std::size_t l = 0; l < figures.count(); ++l) {
            const auto label = static_cast<Label>(l);
            has_image_[l] = mover_.image(label, images_) != kNoLabel;
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
    // How many figures more would have images.
    [[nodiscard]] std::ptrdiff_t gain_of(std::size_t a, std::size_t b, bool in_pairs_only) {
        if (a == ground_ || b == ground_) {
            return 0;
        }
        if (in_pairs_only && (images_[a] != a || images_[b] != b)) {
            return 0;
        }
        std::swap(images_[a], images_[b]);
        std::ptrdiff_t gain = 0;
        for_each_figure_with(a, b, [&](Label label) {
            --looks_left_;
            gain += std::ptrdiff_t{mover_.image(label, images_) != kNoLabel} -
                    std::ptrdiff_t{has_image_[label]};
        });
        std::swap(images_[a], images_[b]);
        return gain;
    }

    void exchange(std::size_t a, std::size_t b) {
        std::swap(images_[a], images_[b]);
        for_each_figure_with(a, b, [&](Label label) {
            has_image_[label] = mover_.image(label, images_) != kNoLabel;
        });
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

    std::optional<ObjectId> ground_;  // stays what it is
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
        if (image != object) {
            names.emplace_back(example.objects[object - 1].name, example.objects[image - 1U].name);
        }
    }
    return names;
}

void fill_mirrors(const ExampleReading& reading, Parameters& parameters) {
    const Topes& topes = reading.topes();
    for (Constraint& constraint : *parameters.constraints) {
        auto* rule = std::get_if<SymmetryRule>(&constraint.rule);
        if (rule == nullptr || rule->mirror) {
            continue;
        }
        const Motion motion = motion_of(*rule, *parameters.size);
        bool is_whole = true;
        for (std::size_t i = 0; i < topes.family_count(); ++i) {
            is_whole = is_whole && family_image(topes, i, motion.turn);
        }
        if (is_whole) {
            rule->mirror = likely_mirror(reading, *rule);
        }
    }
}

std::vector<Label> figure_images(const ExampleReading& reading, const SymmetryRule& rule) {
    const Example& example = reading.example();
    const std::vector<Label> objects = label_images(
        example.objects.size() + 1,
        object_pairs(example, rule.mirror ? *rule.mirror : likely_mirror(reading, rule))
    );
    const Figures& figures = reading.figures();
    const FigureMover mover(figures, rule);
    std::vector<Label> images;
    for (std::size_t label = 0; label < figures.count(); ++label) {
        images.push_back(mover.image(static_cast<Label>(label), objects));
    }
    return images;
}

}  // namespace modelsynth::continuous
