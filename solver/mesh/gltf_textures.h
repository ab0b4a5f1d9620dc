#pragma once

#include "solver/core/result.h"
#include "solver/mesh/gltf_document.h"
#include "solver/mesh/texture.h"

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace modelsynth {

// Reads the textures of base colours of a parsed file, every index and range checked.
class GltfTextures {
  public:
    GltfTextures(const tinygltf::Model& model, std::size_t image_bytes_max)
        : model_(model), image_bytes_max_(image_bytes_max), bytes_left_(image_bytes_max) {}

    // `place`: names the material in errors. Requires: it has a texture of its base colour.
    Result<Texture> read(const tinygltf::Material& material, const std::string& place) {
        const auto texture = material.pbrMetallicRoughness.baseColorTexture.index;
        if (static_cast<std::size_t>(texture) >= model_.textures.size()) {
            return tl::unexpected(
                invalid_glb(place + ": there is no texture " + std::to_string(texture))
            );
        }
        const int source = model_.textures[static_cast<std::size_t>(texture)].source;
        auto image = image_of(source, place + ": image " + std::to_string(source));
        if (!image) {
            return tl::unexpected(std::move(image.error()));
        }
        auto repeat_m = repeat_of(material.extras, place);
        if (!repeat_m) {
            return tl::unexpected(std::move(repeat_m.error()));
        }
        return Texture{std::move(*image), *repeat_m};
    }

  private:
    using SharedImage = std::shared_ptr<const Image>;

    // Materials may share an image; it is read once.
    Result<SharedImage> image_of(int index, const std::string& place) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.images.size()) {
            return tl::unexpected(invalid_glb(place + " does not exist"));
        }
        if (const auto found = images_.find(index); found != images_.end()) {
            return found->second;
        }
        auto image = read_image(model_.images[static_cast<std::size_t>(index)], place);
        if (image) {
            images_.emplace(index, *image);
        }
        return image;
    }

    Result<SharedImage> read_image(const tinygltf::Image& source, const std::string& place) {
        const auto bytes = bytes_of(source.bufferView, place);
        if (!bytes) {
            return tl::unexpected(bytes.error());
        }
        const auto format = find_image_format(*bytes);
        if (!format) {
            return tl::unexpected(invalid_glb(place + " is neither a PNG nor a JPEG"));
        }
        if (source.mimeType != mime_type(*format)) {
            return tl::unexpected(invalid_glb(
                place + " is " + std::string(mime_type(*format)) +
                ", which is not what its mimeType says"
            ));
        }
        // Copies count too, since finding them takes time.
        if (bytes->size() > bytes_left_) {
            return tl::unexpected(too_large_glb(
                place + " is one more than " + std::to_string(image_bytes_max_) + " bytes of images"
            ));
        }
        bytes_left_ -= bytes->size();
        SharedImage& image = by_bytes_[*bytes];
        if (image == nullptr) {
            image = std::make_shared<const Image>(Image{*format, std::string(*bytes)});
        }
        return image;
    }

    Result<std::string_view> bytes_of(int index, const std::string& place) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size()) {
            return tl::unexpected(invalid_glb(place + " is not embedded in a buffer view"));
        }
        const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
        if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
            return tl::unexpected(invalid_glb(place + " has no buffer"));
        }
        const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
        if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
            return tl::unexpected(invalid_glb(place + " reaches beyond its buffer"));
        }
        return std::string_view(
            reinterpret_cast<const char*>(data.data()) + view.byteOffset, view.byteLength
        );
    }

    static Result<double> repeat_of(const tinygltf::Value& extras, const std::string& place) {
        if (!extras.Has("metres")) {
            return 1;
        }
        const tinygltf::Value& metres = extras.Get("metres");
        const double repeat_m = metres.IsNumber() ? metres.GetNumberAsDouble() : 0;
        if (!(repeat_m >= kRepeatMin && repeat_m <= kRepeatMax)) {
            return tl::unexpected(invalid_glb(
                place + ": extras.metres is not a number of metres from 0.001 to 100000"
            ));
        }
        return repeat_m;
    }

    const tinygltf::Model& model_;
    std::size_t image_bytes_max_;
    std::size_t bytes_left_;
    std::map<int, SharedImage> images_;                 // by the file's numbers
    std::map<std::string_view, SharedImage> by_bytes_;  // which are in the file's buffers
};

}  // namespace modelsynth
