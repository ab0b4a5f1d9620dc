#pragma once

#include "solver/core/label_set.h"
#include "solver/discrete/example.h"
#include "solver/discrete/pair_images.h"
#include "solver/discrete/parameters.h"

#include <cstdint>
#include <tuple>
#include <vector>

namespace modelsynth::discrete {

// A piece that another may become under a motion; those sort first that are the most alike, in
// looks and then in surroundings.
struct ImageCandidate {
    int look;    // how unlike they are, in steps too small to see
    int doubts;  // at how many of the distances their surroundings differ
    std::uint32_t degrees;
    bool is_other;
    Label image;

    [[nodiscard]] auto key() const { return std::tuple(look, doubts, degrees, is_other, image); }

    friend bool operator<(const ImageCandidate& a, const ImageCandidate& b) {
        return a.key() < b.key();
    }
};

// By label, the likeliest first.
using ImageCandidates = std::vector<std::vector<ImageCandidate>>;

// The few likeliest images of every piece, among those that are as high and have much the same
// neighbours: what is drawn has none that is not.
// Cost: O(pieces log pieces + pairs), with a large factor.
[[nodiscard]] ImageCandidates find_image_candidates(
    const Example& example, const PairImages& pairs, Symmetry::Kind kind
);

}  // namespace modelsynth::discrete
