#include "solver/mesh/texture.h"

namespace modelsynth {

std::optional<ImageFormat> find_image_format(std::string_view bytes) {
    if (bytes.starts_with("\x89PNG\r\n\x1A\n")) {
        return ImageFormat::kPng;
    }
    if (bytes.starts_with("\xFF\xD8\xFF")) {
        return ImageFormat::kJpeg;
    }
    return std::nullopt;
}

std::string_view mime_type(ImageFormat format) {
    switch (format) {
        case ImageFormat::kPng:
            return "image/png";
        case ImageFormat::kJpeg:
            return "image/jpeg";
    }
    return "";
}

}  // namespace modelsynth
