#include "solver/discrete/image_candidates.h"

#include "solver/discrete/piece_looks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace modelsynth::discrete {

namespace {

// Pieces are compared with so many on either side in an order in which the images are near.
constexpr std::size_t kWindow = 192;
constexpr std::size_t kCandidatesMax = 12;
// Surroundings are compared up to so many steps away.
constexpr int kSteps = 4;
// Looks are compared in such parts of a cell's width.
constexpr float kLookParts = 200;
constexpr float kUnlikeMax = 1000;

// How differently many neighbours the image has in the images of the directions.
std::uint32_t difference_of_degrees(const PairImages& pairs, Label from, Label to) {
    std::uint32_t sum = 0;
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
        const std::uint32_t a = pairs.degree(from, d);
        const std::uint32_t b = pairs.degree(to, static_cast<std::size_t>(pairs.directions()[d]));
        sum += std::max(a, b) - std::min(a, b);
    }
    return sum;
}

// Labels by what no motion about an upright line changes.
std::vector<Label> in_order_of_invariants(
    const PairImages& pairs, const std::vector<PieceLook>& looks
) {
    const auto key = [&](Label label) {
        const PieceLook& look = looks[label];
        const auto degree = [&](Direction direction) {
            return pairs.degree(label, static_cast<std::size_t>(direction));
        };
        const std::uint32_t around = degree(Direction::kEast) + degree(Direction::kWest) +
                                     degree(Direction::kSouth) + degree(Direction::kNorth);
        return std::tuple(
            look.is_drawn,
            std::lround(look.max[1] * 256),
            std::lround(look.mean[1] * 256),
            std::lround((look.square[0] + look.square[2]) * 256),
            degree(Direction::kUp),
            degree(Direction::kDown),
            around,
            label
        );
    };
    std::vector<Label> labels(looks.size());
    std::iota(labels.begin(), labels.end(), Label{0});
    std::sort(labels.begin(), labels.end(), [&](Label a, Label b) { return key(a) < key(b); });
    return labels;
}

}  // namespace

ImageCandidates find_image_candidates(
    const Example& example, const PairImages& pairs, Symmetry::Kind kind
) {
    const std::vector<PieceLook> looks = piece_looks(example);
    const std::vector<Label> ordered = in_order_of_invariants(pairs, looks);
    std::array<std::vector<std::uint64_t>, kSteps> here;
    std::array<std::vector<std::uint64_t>, kSteps> there;
    for (int steps = 0; steps < kSteps; ++steps) {
        here.at(static_cast<std::size_t>(steps)) = pairs.colours(false, steps + 1);
        there.at(static_cast<std::size_t>(steps)) = pairs.colours(true, steps + 1);
    }
    const auto doubts_of = [&](Label from, Label to) {
        int doubts = 0;
        for (std::size_t steps = 0; steps < kSteps; ++steps) {
            doubts += there.at(steps)[from] == here.at(steps)[to] ? 0 : 1;
        }
        return doubts;
    };
    ImageCandidates candidates(ordered.size());
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        const Label from = ordered[i];
        const PieceLook image = moved(looks[from], kind);
        std::vector<ImageCandidate>& of_it = candidates[from];
        const std::size_t end = std::min(ordered.size(), i + kWindow + 1);
        for (std::size_t j = i - std::min(i, kWindow); j < end; ++j) {
            const Label to = ordered[j];
            const float unlike = difference(image, looks[to]);
            if (std::isfinite(unlike)) {
                of_it.push_back(
                    {static_cast<int>(std::min(unlike, kUnlikeMax) * kLookParts),
                     doubts_of(from, to),
                     difference_of_degrees(pairs, from, to),
                     from != to,
                     to}
                );
            }
        }
        std::sort(of_it.begin(), of_it.end());
        of_it.resize(std::min(of_it.size(), kCandidatesMax));
    }
    return candidates;
}

}  // namespace modelsynth::discrete
