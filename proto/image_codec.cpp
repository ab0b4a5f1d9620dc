#include "proto/image_codec.h"

#include "proto/base64.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace modelsynth::proto {

namespace {

std::string uri_start(ImageFormat format) {
    return "data:" + std::string(mime_type(format)) + ";base64,";
}

std::optional<Image> read_image(const Value& value, const RequestLimits& limits) {
    const auto uri = value.string(limits.json.string_bytes_max);
    if (!uri) {
        return std::nullopt;
    }
    for (const ImageFormat format : {ImageFormat::kPng, ImageFormat::kJpeg}) {
        const std::string start = uri_start(format);
        if (!uri->starts_with(start)) {
            continue;
        }
        const auto bytes = decode_base64(std::string_view(*uri).substr(start.size()));
        if (!bytes) {
            value.fault("the data: URI is not base64");
            return std::nullopt;
        }
        Image image = {format, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}};
        if (find_image_format(image.bytes) != format) {
            value.fault("the bytes are not " + std::string(mime_type(format)));
            return std::nullopt;
        }
        return image;
    }
    value.fault("must be a data: URI of type image/png or image/jpeg in base64");
    return std::nullopt;
}

}  // namespace

std::vector<SharedImage> read_images(const Value& value, const RequestLimits& limits) {
    std::vector<SharedImage> images;
    std::map<std::string_view, SharedImage> by_bytes;
    std::size_t bytes_left = kImageBytesMax;
    const auto uris = value.array(0, continuous::kObjectTypesMax);
    for (std::size_t i = 0; uris && i < uris->size(); ++i) {
        auto image = read_image((*uris)[i], limits);
        if (!image) {
            images.emplace_back();
            continue;
        }
        if (image->bytes.size() > bytes_left) {
            const std::string limit = std::to_string(kImageBytesMax);
            (*uris)[i].fault("the images have more than " + limit + " bytes", true);
            images.emplace_back();
            continue;
        }
        bytes_left -= image->bytes.size();
        auto shared = std::make_shared<const Image>(std::move(*image));
        images.push_back(by_bytes.emplace(shared->bytes, shared).first->second);
    }
    return images;
}

ImageList::ImageList(const continuous::Example& example) {
    for (const Material& material : example.materials) {
        if (material.texture && number_of(*material.texture) == images_.size()) {
            images_.push_back(material.texture->image.get());
        }
    }
}

std::size_t ImageList::number_of(const Texture& texture) const {
    const auto found = std::find(images_.begin(), images_.end(), texture.image.get());
    return static_cast<std::size_t>(found - images_.begin());
}

OrderedJson ImageList::write() const {
    OrderedJson uris = OrderedJson::array();
    for (const Image* image : images_) {
        uris.push_back(uri_start(image->format) + encode_base64(image->bytes));
    }
    return uris;
}

}  // namespace modelsynth::proto
