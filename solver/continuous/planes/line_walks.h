#pragma once

#include "solver/continuous/planes/plane_offsets.h"
#include "solver/continuous/reading/topes.h"
#include "solver/core/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace modelsynth::continuous {

// A vertex's name: the numbers of the planes of its first three independent families, after those
// of the families.
using VertexKey = std::uint64_t;

// The lines in which planes of a model meet, and the vertices on them one after the other, each as
// often as lines pass through it.
struct LineWalks {
    // A line passes through a vertex.
    struct Meeting {
        VertexKey key = 0;
        FamilySet families = 0;
    };

    struct Walk {
        Heading heading = 0;
        std::uint32_t first = 0;  // of its meetings
    };

    std::vector<Meeting> meetings;
    std::vector<Walk> walks;  // and one that begins where the meetings end
};

// Every line of the arrangement once, as far as it lies inside the box. Planes that come so near to
// one point that it cannot be said whether they meet there are refused.
// Fails: kInvalidArgument for these; kTooLarge for more than eight times vertices_max meetings;
// kCancelled when `stop` is requested. Cost: O(meetings log planes).
[[nodiscard]] Result<LineWalks> walk_lines(
    const Topes& topes,
    std::span<const PlaneOffsets> planes,
    const Bounds& box,
    std::size_t vertices_max,
    const std::stop_token& stop
);

// Where a vertex lies.
[[nodiscard]] Point place_of(
    VertexKey key, const Topes& topes, std::span<const PlaneOffsets> planes
);

}  // namespace modelsynth::continuous
