#pragma once

#include <cstddef>
#include <cstdint>

namespace modelsynth::proto {

// What a text from outside may be. Every field is a limit that a request can hit and whose edge
// is tested.
struct JsonLimits {
    std::size_t depth_max = 64;
    std::size_t nodes_max = 1'000'000;
    std::size_t string_bytes_max = std::size_t{32} << 20;
};

// What the image of a mask may be.
struct MaskLimits {
    std::size_t text_bytes_max = std::size_t{1} << 20;  // of the whole data: URI
    std::int32_t side_pixels_max = 1024;
};

// What one request may ask for.
struct RequestLimits {
    JsonLimits json;
    std::int32_t extent_max = 4096;             // cells along one axis
    std::size_t model_cells_max = 4'000'000;    // cells of one model
    std::size_t blocks_max = 200'000;           // blocks of one schedule
    std::int32_t block_extent_max = 64;         // cells along one axis of a block
    std::size_t pieces_max = 4096;              // labels of one example
    std::size_t example_cells_max = 1'000'000;  // cells of one example
    std::size_t name_characters_max = 128;
    std::size_t tags_max = 32;
    std::size_t webhook_url_characters_max = 2048;
    std::size_t constraints_max = 1000;
    std::size_t member_rules_max = 32;  // constraints that take memory for every cell
    std::size_t symmetries_max = 8;     // take memory for every cell, too
    std::size_t masks_max = 16;
    std::int32_t resemblance_window_max = 3;  // cells; its cost goes with the cube
    std::size_t terms_max = 16;               // of one objective
    std::int32_t best_of_max = 64;            // models made for one result
    std::int32_t alternatives_max = 64;       // models of one job, all within model_cells_max
    MaskLimits mask;
    std::size_t voxels_max = 1'000'000;  // values of one constraint
    std::int32_t separation_max = 64;    // steps; its cost goes with the cube
    double deadline_seconds_max = 3600;
    std::size_t glb_bytes_max = std::size_t{64} << 20;
};

// Faults listed in one problem.
inline constexpr std::size_t kFaultsMax = 50;

// Labels listed for one cell of a conflict.
inline constexpr std::size_t kLabelsListedMax = 64;

// Seeds survive JavaScript's numbers.
inline constexpr std::uint64_t kSeedMax = (std::uint64_t{1} << 53) - 1;

}  // namespace modelsynth::proto
