#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

// The binary frames of the WebSocket (subprotocol modelsynth.v1), little-endian:
//
//   offset  size  what
//   0       4     "MSYF"
//   4       1     version of this layout, 1
//   5       1     kind: 1 labels of a region, 2 labels of the whole model,
//                       3 GLB of a region, 4 GLB of the whole model
//   6       2     0
//   8       8     seq of the event that the frame belongs to; for kinds 2 and 4 the seq up to
//                 which the state includes everything
//   16      12    region min x, y, z, int32
//   28      12    region max x, y, z, int32, exclusive
//   40      4     bytes of payload
//   44            payload: for labels a uint16 per cell of the region, x fastest, then z, then y,
//                 65535 for a cell that is not made yet; for GLB a whole binary glTF file in the
//                 frame of the whole model
//
// Where one WebSocket carries several jobs, frames have layout version 2, which says the job's id:
//
//   4       1     2
//   6       2     bytes of the id, N
//   44      N     the id, ASCII, then zeros up to a multiple of 4 bytes, then the payload
//
// and everything else as above.
enum class FrameKind : std::uint8_t {
    kLabels = 1,
    kLabelsWhole = 2,
    kGlb = 3,
    kGlbWhole = 4,
};

inline constexpr std::size_t kFrameHeaderBytes = 44;
inline constexpr std::size_t kFrameJobIdBytesMax = 1024;

struct Frame {
    FrameKind kind = FrameKind::kLabels;
    std::uint64_t seq = 0;
    Box region;
    std::string payload;
};

// What stands before the payload; with an id in version 2.
// Requires: an id of at most kFrameJobIdBytesMax (checked).
[[nodiscard]] std::string encode_frame_head(const Frame& frame);
[[nodiscard]] std::string encode_frame_head(const Frame& frame, std::string_view job_id);

[[nodiscard]] std::string encode_frame(const Frame& frame);

// Nothing when the bytes are no whole frame of version 1.
[[nodiscard]] std::optional<Frame> decode_frame(std::string_view bytes);

struct NamedFrame {
    std::string job_id;
    Frame frame;
};

// The same for version 2.
[[nodiscard]] std::optional<NamedFrame> decode_named_frame(std::string_view bytes);

// Labels as a payload and back; nothing when the length is odd.
[[nodiscard]] std::string encode_labels(std::span<const Label> labels);
[[nodiscard]] std::optional<std::vector<Label>> decode_labels(std::string_view payload);

}  // namespace modelsynth::proto
