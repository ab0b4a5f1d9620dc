#pragma once

#include "solver/examples/canyon_rock.h"

namespace modelsynth::examples {

// --- water in the valley; a stream as built runs from the south ...

[[nodiscard]] MeshBuilder make_stream(const CanyonPalette& palette);       // ... to the north
[[nodiscard]] MeshBuilder make_stream_bend(const CanyonPalette& palette);  // from the north to east
[[nodiscard]] MeshBuilder make_pool(const CanyonPalette& palette);         // and ends here
// A foot of a cliff, facing east, out of which a stream runs to the east.
[[nodiscard]] MeshBuilder make_spring(const CanyonPalette& palette);

// --- a stair cut into a cliff, up to the west: the foot's part and the rim's

[[nodiscard]] MeshBuilder make_stair(const CanyonPalette& palette, CliffKind foot);
[[nodiscard]] MeshBuilder make_stair_head(const CanyonPalette& palette);

// --- a rope bridge along x at the height of the ground of its level; its head is a rim, facing
// east, from which the bridge runs to the east

[[nodiscard]] MeshBuilder make_bridge(const CanyonPalette& palette);
[[nodiscard]] MeshBuilder make_bridge_head(const CanyonPalette& palette);

}  // namespace modelsynth::examples
