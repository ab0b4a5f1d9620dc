#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace modelsynth {

enum class ImageFormat : std::uint8_t { kPng, kJpeg };

// A picture as a file. Its bytes are kept and given out as they came, and never unpacked.
struct Image {
    ImageFormat format = ImageFormat::kPng;
    std::string bytes;
};

// Of all images of one example together: every file of a model has those that it shows.
inline constexpr std::size_t kImageBytesMax = std::size_t{16} << 20;

// What a file is by its first bytes; nothing when it is neither.
[[nodiscard]] std::optional<ImageFormat> find_image_format(std::string_view bytes);

// "image/png" or "image/jpeg".
[[nodiscard]] std::string_view mime_type(ImageFormat format);

inline constexpr double kRepeatMin = 1e-3;  // metres
inline constexpr double kRepeatMax = 1e5;

// A picture that is repeated for ever, right and left, up and down.
struct Texture {
    std::shared_ptr<const Image> image;  // never null
    double repeat_m = 1;                 // as wide and as high is the picture

    // Of the same image, not of a copy: images are large, and whoever reads a file makes equal ones
    // the same.
    friend bool operator==(const Texture&, const Texture&) = default;
};

}  // namespace modelsynth
