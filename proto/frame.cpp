#include "proto/frame.h"

#include "solver/core/result.h"

#include <array>
#include <utility>

namespace modelsynth::proto {

namespace {

void append(std::string& bytes, std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) {
        bytes += static_cast<char>(value >> (8 * i) & 0xFF);
    }
}

std::uint64_t read(std::string_view bytes, std::size_t offset, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = count; i-- > 0;) {
        value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
    }
    return value;
}

constexpr std::string_view kMagic = "MSYF";
constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kVersionWithId = 2;

// Up to the payload's length; the two bytes at 6 are what the version makes of them.
std::string encode_header(const Frame& frame, std::uint8_t version, std::size_t at_6) {
    std::string bytes;
    bytes.reserve(kFrameHeaderBytes);
    bytes += kMagic;
    append(bytes, version, 1);
    append(bytes, static_cast<std::uint64_t>(frame.kind), 1);
    append(bytes, at_6, 2);
    append(bytes, frame.seq, 8);
    const Box& region = frame.region;
    for (const std::int32_t value :
         {region.min.x, region.min.y, region.min.z, region.max.x, region.max.y, region.max.z}) {
        append(bytes, static_cast<std::uint32_t>(value), 4);
    }
    append(bytes, frame.payload.size(), 4);
    return bytes;
}

// The frame of a version whose payload begins there.
std::optional<Frame> decode(std::string_view bytes, std::uint8_t version, std::size_t payload_at) {
    if (bytes.size() < payload_at || bytes.substr(0, 4) != kMagic || read(bytes, 4, 1) != version ||
        read(bytes, 40, 4) != bytes.size() - payload_at) {
        return std::nullopt;
    }
    const std::uint64_t kind = read(bytes, 5, 1);
    if (kind < 1 || kind > 4) {
        return std::nullopt;
    }
    std::array<std::int32_t, 6> corners = {};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(read(bytes, 16 + 4 * i, 4)));
    }
    return Frame{
        static_cast<FrameKind>(kind),
        read(bytes, 8, 8),
        {{corners[0], corners[1], corners[2]}, {corners[3], corners[4], corners[5]}},
        std::string(bytes.substr(payload_at))};
}

// The bytes that an id takes, with the zeros after it.
std::size_t padded(std::size_t id_bytes) { return (id_bytes + 3) / 4 * 4; }

}  // namespace

std::string encode_frame_head(const Frame& frame) { return encode_header(frame, kVersion, 0); }

std::string encode_frame_head(const Frame& frame, std::string_view job_id) {
    check(job_id.size() <= kFrameJobIdBytesMax, "a job's id too long for a frame");
    std::string bytes = encode_header(frame, kVersionWithId, job_id.size());
    bytes += job_id;
    bytes.append(padded(job_id.size()) - job_id.size(), '\0');
    return bytes;
}

std::string encode_frame(const Frame& frame) { return encode_frame_head(frame) + frame.payload; }

std::optional<Frame> decode_frame(std::string_view bytes) {
    if (bytes.size() < kFrameHeaderBytes || read(bytes, 6, 2) != 0) {
        return std::nullopt;
    }
    return decode(bytes, kVersion, kFrameHeaderBytes);
}

std::optional<NamedFrame> decode_named_frame(std::string_view bytes) {
    if (bytes.size() < kFrameHeaderBytes) {
        return std::nullopt;
    }
    const std::size_t id_bytes = read(bytes, 6, 2);
    const std::size_t payload_at = kFrameHeaderBytes + padded(id_bytes);
    auto frame = decode(bytes, kVersionWithId, payload_at);
    if (!frame || id_bytes > kFrameJobIdBytesMax) {
        return std::nullopt;
    }
    const std::string_view id = bytes.substr(kFrameHeaderBytes, id_bytes);
    const std::string_view zeros =
        bytes.substr(kFrameHeaderBytes + id_bytes, padded(id_bytes) - id_bytes);
    if (zeros.find_first_not_of('\0') != std::string_view::npos) {
        return std::nullopt;
    }
    return NamedFrame{std::string(id), std::move(*frame)};
}

std::string encode_labels(std::span<const Label> labels) {
    std::string payload(labels.size() * 2, '\0');
    // By a pointer of its own: as bytes of the string each write could change where that is.
    char* into = payload.data();
    for (const Label label : labels) {
        into[0] = static_cast<char>(label & 0xFF);
        into[1] = static_cast<char>(label >> 8);
        into += 2;
    }
    return payload;
}

std::optional<std::vector<Label>> decode_labels(std::string_view payload) {
    if (payload.size() % 2 != 0) {
        return std::nullopt;
    }
    std::vector<Label> labels(payload.size() / 2);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        labels[i] = static_cast<Label>(read(payload, 2 * i, 2));
    }
    return labels;
}

}  // namespace modelsynth::proto
