#include "solver/discrete/likely_mirror.h"

#include "solver/discrete/image_candidates.h"
#include "solver/discrete/pair_images.h"
#include "solver/discrete/symmetries.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

// Two beginnings are made better and the better end is taken: every piece its own image, and each
// piece that which it looks like once moved. A step exchanges images in a way that cannot spoil the
// order of the map: two pieces become each other, or two change their roles in it, or four form a
// ring. Only those are tried that are the most alike, first in looks and then in surroundings.

namespace modelsynth::discrete {

namespace {

constexpr int kPassesMax = 8;
// How many sentences may be looked at for each of the two beginnings.
constexpr std::int64_t kLooksMax = std::int64_t{1} << 22;
constexpr std::size_t kRingCandidatesMax = 4;

// A step of the search: the pieces that change roles, and how.
struct Step {
    enum class Kind : std::uint8_t { kPair, kRoles, kRing };

    Kind kind;
    std::array<Label, 4> pieces;
};

// A map of pieces on its way to more pairs that have images.
class MirrorSearch {
  public:
    MirrorSearch(
        const PairImages& pairs, const ImageCandidates& candidates, std::vector<Label> images
    )
        : pairs_(&pairs),
          candidates_(&candidates),
          images_(std::move(images)),
          origins_(images_.size()),
          has_image_(pairs.count()),
          seen_(pairs.count()) {
        for (std::size_t label = 0; label < images_.size(); ++label) {
            origins_[images_[label]] = static_cast<Label>(label);
        }
        for (std::size_t pair = 0; pair < has_image_.size(); ++pair) {
            has_image_[pair] = pairs_->has_image(static_cast<std::uint32_t>(pair), images_) ? 1 : 0;
        }
    }

    void improve(std::size_t order) {
        bool is_better = true;
        for (int pass = 0; pass < kPassesMax && is_better; ++pass) {
            std::vector<std::pair<std::ptrdiff_t, Step>> gains;
            for_each_step(order, [&](const Step& step) {
                const std::ptrdiff_t gain = gain_of(step);
                if (gain > 0) {
                    gains.emplace_back(gain, step);
                }
            });
            std::stable_sort(gains.begin(), gains.end(), [](const auto& a, const auto& b) {
                return a.first > b.first;
            });
            is_better = false;
            for (const auto& [gain, step] : gains) {
                if (gain_of(step) > 0) {
                    take(step);
                    is_better = true;
                }
            }
        }
    }

    [[nodiscard]] std::ptrdiff_t score() const {
        return std::count(has_image_.begin(), has_image_.end(), 1);
    }

    [[nodiscard]] const std::vector<Label>& images() const { return images_; }

  private:
    template <class Visit>
    void for_each_step(std::size_t order, Visit visit) {
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const auto a = static_cast<Label>(i);
            for (const ImageCandidate& candidate : (*candidates_)[a]) {
                if (looks_left_ <= 0) {
                    return;
                }
                const Label b = candidate.image;
                if (images_[a] != b && is_in_pair(a) && is_in_pair(b)) {
                    visit({Step::Kind::kPair, {a, b, b, b}});
                } else if (images_[a] != b && order > 2) {
                    visit({Step::Kind::kRoles, {images_[a], b, b, b}});
                }
            }
            if (order == 4) {
                for_each_ring(a, visit);
            }
        }
    }

    // Rings that begin with their lowest label.
    template <class Visit>
    void for_each_ring(Label a, Visit visit) {
        const auto for_each_next = [&](Label label, auto go_on) {
            const auto& next = (*candidates_)[label];
            for (std::size_t i = 0; i < std::min(next.size(), kRingCandidatesMax); ++i) {
                if (next[i].image > a && is_in_pair(next[i].image)) {
                    go_on(next[i].image);
                }
            }
        };
        if (!is_in_pair(a)) {
            return;
        }
        for_each_next(a, [&](Label b) {
            for_each_next(b, [&](Label c) {
                for_each_next(c, [&](Label d) {
                    if (b != c && b != d && c != d && is_candidate(d, a) && looks_left_ > 0) {
                        visit({Step::Kind::kRing, {a, b, c, d}});
                    }
                });
            });
        });
    }

    [[nodiscard]] bool is_candidate(Label from, Label to) const {
        const auto& of_it = (*candidates_)[from];
        return std::any_of(of_it.begin(), of_it.end(), [to](const ImageCandidate& candidate) {
            return candidate.image == to;
        });
    }

    // Or alone.
    [[nodiscard]] bool is_in_pair(Label label) const { return images_[images_[label]] == label; }

    void set(Label from, Label to) {
        changed_.emplace_back(from, images_[from]);
        images_[from] = to;
        origins_[to] = from;
    }

    void apply(const Step& step) {
        changed_.clear();
        const auto [a, b, c, d] = step.pieces;
        switch (step.kind) {
            case Step::Kind::kPair: {
                const Label of_a = images_[a];
                const Label of_b = images_[b];
                set(a, b);
                set(b, a);
                if (of_a != a && of_b != b) {
                    set(of_a, of_b);
                    set(of_b, of_a);
                } else if (of_a != a) {
                    set(of_a, of_a);
                } else if (of_b != b) {
                    set(of_b, of_b);
                }
                break;
            }
            case Step::Kind::kRoles: {
                const auto exchanged = [a = a, b = b](Label label) {
                    return label == a ? b : label == b ? a : label;
                };
                std::vector<std::pair<Label, Label>> anew;
                for (const Label label : {a, b, origins_[a], origins_[b]}) {
                    anew.emplace_back(exchanged(label), exchanged(images_[label]));
                }
                for (const auto& [from, to] : anew) {
                    set(from, to);
                }
                break;
            }
            case Step::Kind::kRing:
                for (const Label label : {a, b, c, d}) {
                    set(images_[label], images_[label]);
                }
                set(a, b);
                set(b, c);
                set(c, d);
                set(d, a);
                break;
        }
    }

    void take_back() {
        for (auto at = changed_.rbegin(); at != changed_.rend(); ++at) {
            images_[at->first] = at->second;
        }
        for (const auto& [from, to] : changed_) {
            origins_[images_[from]] = from;
        }
    }

    template <class Visit>
    void for_each_changed_pair(Visit visit) {
        ++time_;
        for (const auto& [label, was] : changed_) {
            for (const std::uint32_t pair : pairs_->pairs_of(label)) {
                if (seen_[pair] != time_) {
                    seen_[pair] = time_;
                    visit(pair);
                }
            }
        }
    }

    // How many sentences more would have images.
    [[nodiscard]] std::ptrdiff_t gain_of(const Step& step) {
        if (!is_possible(step)) {
            return 0;
        }
        apply(step);
        std::ptrdiff_t gain = 0;
        for_each_changed_pair([&](std::uint32_t pair) {
            gain += std::ptrdiff_t{pairs_->has_image(pair, images_)} - has_image_[pair];
            --looks_left_;
        });
        take_back();
        return gain;
    }

    // Whether the order of the map stays, which the steps taken since it was found may have spoilt.
    [[nodiscard]] bool is_possible(const Step& step) const {
        const auto [a, b, c, d] = step.pieces;
        switch (step.kind) {
            case Step::Kind::kPair:
                return images_[a] != b && is_in_pair(a) && is_in_pair(b);
            case Step::Kind::kRoles:
                return a != b;
            case Step::Kind::kRing:
                return is_in_pair(a) && is_in_pair(b) && is_in_pair(c) && is_in_pair(d);
        }
        return false;
    }

    void take(const Step& step) {
        apply(step);
        for_each_changed_pair([&](std::uint32_t pair) {
            has_image_[pair] = pairs_->has_image(pair, images_) ? 1 : 0;
        });
    }

    const PairImages* pairs_;
    const ImageCandidates* candidates_;
    std::vector<Label> images_;        // by label
    std::vector<Label> origins_;       // by label, that whose image it is
    std::vector<char> has_image_;      // by sentence
    std::vector<std::uint32_t> seen_;  // by sentence: when last
    std::uint32_t time_ = 0;
    std::int64_t looks_left_ = kLooksMax;
    std::vector<std::pair<Label, Label>> changed_;  // by the last step, with what they were
};

// Each piece that which it looks like, the likest first, and those of a chain that does not close
// in time themselves.
std::vector<Label> images_by_look(const ImageCandidates& candidates, std::size_t order) {
    std::vector<std::pair<ImageCandidate, Label>> likest;
    for (std::size_t label = 0; label < candidates.size(); ++label) {
        for (const ImageCandidate& candidate : candidates[label]) {
            likest.emplace_back(candidate, static_cast<Label>(label));
        }
    }
    std::sort(likest.begin(), likest.end());
    std::vector<Label> images(candidates.size(), kNoLabel);
    std::vector<bool> is_image(candidates.size());
    for (const auto& [candidate, from] : likest) {
        const Label to = candidate.image;
        if (images[from] != kNoLabel || is_image[to]) {
            continue;
        }
        if (order > 2) {
            images[from] = to;
            is_image[to] = true;
        } else if (images[to] == kNoLabel) {
            images[from] = to;
            images[to] = from;
            is_image[from] = is_image[to] = true;
        }
    }
    for (std::size_t label = 0; label < images.size(); ++label) {
        auto moved_label = static_cast<Label>(label);
        for (std::size_t i = 0; i < order && moved_label != kNoLabel; ++i) {
            moved_label = images[moved_label];
        }
        if (moved_label == label) {
            continue;
        }
        // All of the chain or ring are undone at once, the part before this one as well: its
        // labels come here in their turn.
        for (auto next = static_cast<Label>(label); next != kNoLabel;) {
            next = std::exchange(images[next], kNoLabel);
        }
    }
    for (std::size_t label = 0; label < images.size(); ++label) {
        if (images[label] == kNoLabel) {
            images[label] = static_cast<Label>(label);
        }
    }
    return images;
}

}  // namespace

NamePairs likely_mirror(const Example& example, Symmetry::Kind kind) {
    const std::size_t order = order_of(kind);
    if (order == 0) {
        return {};
    }
    const PairImages pairs(example, kind);
    const ImageCandidates candidates = find_image_candidates(example, pairs, kind);
    MirrorSearch best(pairs, candidates, images_by_look(candidates, order));
    best.improve(order);
    std::vector<Label> own(example.pieces.size());
    std::iota(own.begin(), own.end(), Label{0});
    MirrorSearch other(pairs, candidates, std::move(own));
    other.improve(order);
    if (other.score() > best.score()) {
        best = std::move(other);
    }
    NamePairs names;
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        const Label image = best.images()[label];
        if (image != label) {
            names.emplace_back(example.pieces[label].name, example.pieces[image].name);
        }
    }
    return names;
}

void fill_mirrors(const Example& example, Parameters& parameters) {
    std::array<std::optional<NamePairs>, 5> found;  // by kind of motion
    for (Constraint& constraint : parameters.constraints) {
        auto* symmetry = std::get_if<Symmetry>(&constraint.rule);
        if (symmetry != nullptr && !symmetry->mirror) {
            auto& mirror = found.at(static_cast<std::size_t>(symmetry->kind));
            if (!mirror) {
                mirror = likely_mirror(example, symmetry->kind);
            }
            symmetry->mirror = mirror;
        }
    }
}

}  // namespace modelsynth::discrete
