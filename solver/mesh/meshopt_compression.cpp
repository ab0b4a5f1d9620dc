#include "solver/mesh/meshopt_compression.h"

#include "solver/core/result.h"
#include "solver/mesh/gltf_buffer.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace modelsynth {

namespace {

using Bytes = std::vector<unsigned char>;

// The format that the extension prescribes, whatever a version of the library likes best. Set once:
// the library keeps it in variables without a lock.
void choose_format() {
    [[maybe_unused]] static const bool chosen = [] {
        meshopt_encodeVertexVersion(0);
        meshopt_encodeIndexVersion(1);
        return true;
    }();
}

// What one view holds.
struct Content {
    const unsigned char* bytes;
    std::size_t stride;
    std::size_t count;
};

Bytes encode_attributes(const Content& content) {
    check(content.stride % 4 == 0 && content.stride <= 256, "attributes are of whole words");
    Bytes encoded(meshopt_encodeVertexBufferBound(content.count, content.stride));
    encoded.resize(meshopt_encodeVertexBuffer(
        encoded.data(), encoded.size(), content.bytes, content.count, content.stride
    ));
    return encoded;
}

template <class Index>
std::vector<unsigned int> widened(const Content& content) {
    std::vector<Index> indices(content.count);
    std::memcpy(indices.data(), content.bytes, content.count * sizeof(Index));
    return {indices.begin(), indices.end()};
}

// As a sequence and not as triangles, since those would come back with their corners turned.
Bytes encode_indices(const Content& content) {
    check(content.stride == 2 || content.stride == 4, "indices have two or four bytes");
    const std::vector<unsigned int> indices =
        content.stride == 2 ? widened<std::uint16_t>(content) : widened<std::uint32_t>(content);
    const std::size_t vertices = std::size_t{*std::max_element(indices.begin(), indices.end())} + 1;
    Bytes encoded(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    encoded.resize(
        meshopt_encodeIndexSequence(encoded.data(), encoded.size(), indices.data(), indices.size())
    );
    return encoded;
}

class Compression {
  public:
    Compression(const tinygltf::Model& model, const std::vector<Bytes>& parts)
        : model_(model), parts_(parts), strides_(model.bufferViews.size()) {
        choose_format();
        for (const tinygltf::Accessor& accessor : model.accessors) {
            const int size =
                tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)
                ) *
                tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
            std::size_t& stride = strides_[static_cast<std::size_t>(accessor.bufferView)];
            check(stride == 0 || stride == static_cast<std::size_t>(size), "views hold one type");
            stride = static_cast<std::size_t>(size);
        }
    }

    CompressedBuffers run() {
        for (std::size_t i = 0; i < model_.bufferViews.size(); ++i) {
            views_ += i == 0 ? "[" : ",";
            if (strides_[i] == 0) {
                copy(parts_[i]);
            } else {
                compress(model_.bufferViews[i], parts_[i], strides_[i]);
            }
        }
        const std::string buffers = "[{\"byteLength\":" + std::to_string(binary_.size()) +
                                    "},{\"byteLength\":" + std::to_string(fallback_bytes_) +
                                    ",\"extensions\":{\"" + kMeshoptExtension +
                                    "\":{\"fallback\":true}}}]";
        return {std::move(binary_), buffers, views_ + "]"};
    }

  private:
    // Where the bytes stand in the binary chunk.
    std::size_t append(const Bytes& bytes) {
        const std::size_t at = binary_.size();
        binary_.insert(binary_.end(), bytes.begin(), bytes.end());
        binary_.resize(padded(binary_.size()));
        return at;
    }

    void field(const char* name, std::size_t value) {
        views_ += std::string("\"") + name + "\":" + std::to_string(value);
    }

    void place(std::size_t buffer, std::size_t at, std::size_t length) {
        field("buffer", buffer);
        views_ += ',';
        field("byteOffset", at);
        views_ += ',';
        field("byteLength", length);
    }

    void copy(const Bytes& part) {
        views_ += '{';
        place(0, append(part), part.size());
        views_ += '}';
    }

    void compress(const tinygltf::BufferView& view, const Bytes& part, std::size_t stride) {
        check(!part.empty() && part.size() % stride == 0, "views are full and tightly packed");
        const Content content = {part.data(), stride, part.size() / stride};
        const bool is_indices = view.target == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
        const Bytes encoded = is_indices ? encode_indices(content) : encode_attributes(content);
        check(!encoded.empty(), "a bound of meshoptimizer's was too small");
        views_ += '{';
        place(1, fallback_bytes_, part.size());
        fallback_bytes_ = padded(fallback_bytes_ + part.size());
        if (view.byteStride != 0) {
            views_ += ',';
            field("byteStride", view.byteStride);
        }
        if (view.target != 0) {
            views_ += ',';
            field("target", static_cast<std::size_t>(view.target));
        }
        views_ += std::string(",\"extensions\":{\"") + kMeshoptExtension + "\":{";
        place(0, append(encoded), encoded.size());
        views_ += ',';
        field("byteStride", stride);
        views_ += std::string(",\"mode\":\"") + (is_indices ? "INDICES" : "ATTRIBUTES") + "\",";
        field("count", content.count);
        views_ += "}}}";
    }

    const tinygltf::Model& model_;
    const std::vector<Bytes>& parts_;
    std::vector<std::size_t> strides_;  // of what stands in each view; 0: no accessor reads it
    Bytes binary_;
    std::size_t fallback_bytes_ = 0;
    std::string views_;
};

}  // namespace

CompressedBuffers compress_buffers(const tinygltf::Model& model, const std::vector<Bytes>& parts) {
    return Compression(model, parts).run();
}

}  // namespace modelsynth
