#include "solver/mesh/glb_writer.h"

#include "solver/mesh/gltf_buffer.h"
#include "solver/mesh/gltf_nodes.h"
#include "solver/mesh/meshopt_compression.h"
#include "solver/mesh/turn.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

// The idea: tinygltf writes everything whose number does not grow with the model - meshes,
// materials, accessors. Nodes are written here as text and put into its JSON chunk, because
// tinygltf's in-memory node costs about two kilobytes: a city of 200 000 pieces would take
// 400 MB to write 20 MB.

namespace modelsynth {

namespace {

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

Vec3 moved(const Vec3& v, const Vec3& offset) {
    return {v.x + offset.x, v.y + offset.y, v.z + offset.z};
}

tinygltf::Primitive write_primitive(
    const Primitive& primitive, const Kit& kit, int material, GltfBuffer& buffer
) {
    check(!primitive.indices.empty(), "a part of a mesh without triangles");
    tinygltf::Primitive written;
    written.mode = TINYGLTF_MODE_TRIANGLES;
    written.material = material;
    written.attributes["POSITION"] = buffer.positions(primitive.positions);
    written.attributes["NORMAL"] = buffer.normals(primitive.normals);
    written.attributes["COLOR_0"] =
        buffer.colors(primitive.colors, kit.materials[primitive.material].base_color);
    if (!primitive.texture_coordinates.empty()) {
        written.attributes["TEXCOORD_0"] =
            buffer.texture_coordinates(primitive.texture_coordinates);
    }
    written.indices = buffer.indices(primitive.indices, primitive.positions.size());
    return written;
}

// Puts the materials that are used into the file and tells their numbers there.
class MaterialWriter {
  public:
    MaterialWriter(tinygltf::Model& model, GltfBuffer& buffer, const Kit& kit)
        : model_(model), buffer_(buffer), kit_(kit), written_(kit.materials.size(), -1) {}

    int number(std::uint32_t material) {
        if (written_[material] < 0) {
            written_[material] = static_cast<int>(model_.materials.size());
            model_.materials.push_back(write(kit_.materials[material]));
        }
        return written_[material];
    }

  private:
    // Six decimals are more than a colour needs and keep the text short.
    static std::vector<double> parts(const Color& color) {
        const auto round = [](float part) { return std::round(double{part} * 1e6) / 1e6; };
        return {round(color.r), round(color.g), round(color.b)};
    }

    tinygltf::Material write(const Material& material) {
        tinygltf::Material written;
        written.name = material.name;
        written.pbrMetallicRoughness.baseColorFactor = {1, 1, 1, 1};  // see colors()
        written.pbrMetallicRoughness.metallicFactor = parts({material.metallic, 0, 0})[0];
        written.pbrMetallicRoughness.roughnessFactor = parts({material.roughness, 0, 0})[0];
        written.emissiveFactor = parts(material.emissive);
        written.doubleSided = material.double_sided;
        if (material.texture) {
            written.pbrMetallicRoughness.baseColorTexture.index =
                texture_number(material.texture->image.get());
            // So that a file that is sent back as an example says it again.
            written.extras = tinygltf::Value(tinygltf::Value::Object{
                {"metres", tinygltf::Value(material.texture->repeat_m)}});
        }
        return written;
    }

    // Of an image there is one texture, and all have one sampler.
    int texture_number(const Image* image) {
        const auto found = std::find(images_.begin(), images_.end(), image);
        if (found != images_.end()) {
            return static_cast<int>(found - images_.begin());
        }
        add_sampler();
        tinygltf::Image written;
        written.bufferView = buffer_.image(image->bytes);
        written.mimeType = mime_type(image->format);
        model_.images.push_back(std::move(written));
        tinygltf::Texture texture;
        texture.sampler = 0;
        texture.source = static_cast<int>(images_.size());
        model_.textures.push_back(std::move(texture));
        images_.push_back(image);
        return static_cast<int>(images_.size()) - 1;
    }

    void add_sampler() {
        if (model_.samplers.empty()) {
            tinygltf::Sampler sampler;
            sampler.wrapS = TINYGLTF_TEXTURE_WRAP_REPEAT;
            sampler.wrapT = TINYGLTF_TEXTURE_WRAP_REPEAT;
            // What is repeated often flickers from afar without mipmaps.
            sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
            sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
            model_.samplers.push_back(std::move(sampler));
        }
    }

    tinygltf::Model& model_;
    GltfBuffer& buffer_;
    const Kit& kit_;
    std::vector<int> written_;
    std::vector<const Image*> images_;  // as they are numbered in the file
};

// The file as it grows.
struct Document {
    explicit Document(const Scene& source)
        : scene(source), buffer(model), materials(model, buffer, *source.kit) {
        model.asset.version = "2.0";
        model.asset.generator = "modelsynth";
    }

    const Scene& scene;
    tinygltf::Model model;
    GltfBuffer buffer;
    MaterialWriter materials;
    GltfNodes nodes;
    std::vector<std::uint32_t> roots;
};

std::vector<bool> used_meshes(const Scene& scene) {
    std::vector<bool> used(scene.kit->meshes.size());
    for (const SceneGroup& group : scene.groups) {
        for (const Instance& instance : group.instances) {
            if (instance.mesh != kNoMesh) {
                used[instance.mesh] = true;
            }
        }
    }
    return used;
}

// Writes the meshes in use; returns their numbers in the file, -1 for the rest.
std::vector<int> write_meshes(Document& document) {
    const Kit& kit = *document.scene.kit;
    const std::vector<bool> used = used_meshes(document.scene);
    std::size_t vertices = 0;
    std::size_t indices = 0;
    for (std::size_t i = 0; i < kit.meshes.size(); ++i) {
        for (const Primitive& primitive : kit.meshes[i].primitives) {
            vertices += used[i] ? primitive.positions.size() : 0;
            indices += used[i] ? primitive.indices.size() : 0;
        }
    }
    document.buffer.expect(vertices, indices);
    std::vector<int> numbers(kit.meshes.size(), -1);
    for (std::size_t i = 0; i < kit.meshes.size(); ++i) {
        if (!used[i]) {
            continue;
        }
        tinygltf::Mesh mesh;
        mesh.name = kit.meshes[i].name;
        for (const Primitive& primitive : kit.meshes[i].primitives) {
            mesh.primitives.push_back(write_primitive(
                primitive, kit, document.materials.number(primitive.material), document.buffer
            ));
        }
        numbers[i] = static_cast<int>(document.model.meshes.size());
        document.model.meshes.push_back(std::move(mesh));
    }
    return numbers;
}

// A parent node for the nodes [first, first + count) that were just written.
void write_group_node(Document& document, const std::string& name, std::uint32_t first) {
    const std::uint32_t count = document.nodes.count() - first;
    if (count == 0) {
        return;
    }
    if (name.empty()) {
        for (std::uint32_t node = first; node < first + count; ++node) {
            document.roots.push_back(node);
        }
        return;
    }
    document.roots.push_back(document.nodes.begin());
    document.nodes.key("name");
    document.nodes.string(name);
    document.nodes.key("children");
    document.nodes.range(first, count);
    document.nodes.end();
}

void write_nodes(Document& document, bool named) {
    const std::vector<int> mesh_numbers = write_meshes(document);
    std::vector<std::string> names;
    for (const std::string& name : document.scene.names) {
        names.push_back(GltfNodes::quoted(name));
    }
    GltfNodes& nodes = document.nodes;
    for (const SceneGroup& group : document.scene.groups) {
        const std::uint32_t first = nodes.count();
        for (const Instance& instance : group.instances) {
            nodes.begin();
            if (named) {
                nodes.key("name");
                nodes.raw(names[instance.name].c_str());
            }
            if (instance.mesh != kNoMesh) {
                nodes.key("mesh");
                nodes.number(mesh_numbers[instance.mesh]);
            }
            nodes.key("translation");
            nodes.vector(instance.position);
            if (instance.quarter_turns % 4 != 0) {
                nodes.rotation(instance.quarter_turns);
            }
            nodes.key("extras");
            nodes.raw("{\"piece\":");
            nodes.raw(names[instance.name].c_str());
            nodes.raw("}");
            nodes.end();
        }
        write_group_node(document, group.name, first);
    }
}

void write_instanced(Document& document) {
    const std::vector<int> mesh_numbers = write_meshes(document);
    // Only translations are instanced. The node carries the turn, so a translation is given in
    // the node's frame, turned back.
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint8_t>;  // name, mesh, turns
    GltfNodes& nodes = document.nodes;
    bool any = false;
    for (const SceneGroup& group : document.scene.groups) {
        std::map<Key, std::vector<Vec3>> translations;
        for (const Instance& instance : group.instances) {
            const auto turns = static_cast<std::uint8_t>(instance.quarter_turns % 4);
            const auto back = static_cast<std::uint8_t>((4 - turns) % 4);
            translations[{instance.name, instance.mesh, turns}].push_back(
                turned(instance.position, back)
            );
        }
        const std::uint32_t first = nodes.count();
        for (const auto& [key, values] : translations) {
            const auto& [name, mesh, turns] = key;
            const int accessor = document.buffer.translations(values);
            any = true;
            nodes.begin();
            nodes.key("name");
            nodes.string(document.scene.names[name]);
            nodes.key("mesh");
            nodes.number(mesh_numbers[mesh]);
            if (turns != 0) {
                nodes.rotation(turns);
            }
            nodes.key("extensions");
            nodes.raw("{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":");
            nodes.number(accessor);
            nodes.raw("}}}");
            nodes.end();
        }
        write_group_node(document, group.name, first);
    }
    if (any) {
        document.model.extensionsUsed.emplace_back("EXT_mesh_gpu_instancing");
        document.model.extensionsRequired.emplace_back("EXT_mesh_gpu_instancing");
    }
}

void append_placed(const Primitive& source, const Instance& instance, Primitive& merged) {
    const auto base = static_cast<std::uint32_t>(merged.positions.size());
    for (const Vec3& position : source.positions) {
        merged.positions.push_back(
            moved(turned(position, instance.quarter_turns), instance.position)
        );
    }
    for (const Vec3& normal : source.normals) {
        merged.normals.push_back(turned(normal, instance.quarter_turns));
    }
    merged.colors.insert(merged.colors.end(), source.colors.begin(), source.colors.end());
    merged.texture_coordinates.insert(
        merged.texture_coordinates.end(),
        source.texture_coordinates.begin(),
        source.texture_coordinates.end()
    );
    for (const std::uint32_t index : source.indices) {
        merged.indices.push_back(base + index);
    }
}

// False when the file has grown over the limit.
bool write_merged(Document& document, std::size_t bytes_max) {
    const Kit& kit = *document.scene.kit;
    for (const SceneGroup& group : document.scene.groups) {
        // A primitive has texture coordinates for all its vertices or for none.
        std::map<std::pair<std::uint32_t, bool>, Primitive> parts;
        for (const Instance& instance : group.instances) {
            for (const Primitive& primitive : kit.meshes[instance.mesh].primitives) {
                const bool is_textured = !primitive.texture_coordinates.empty();
                Primitive& merged = parts[{primitive.material, is_textured}];
                merged.material = primitive.material;
                append_placed(primitive, instance, merged);
            }
        }
        if (parts.empty()) {
            continue;
        }
        tinygltf::Mesh mesh;
        mesh.name = group.name;
        for (const auto& [key, primitive] : parts) {
            mesh.primitives.push_back(write_primitive(
                primitive, kit, document.materials.number(primitive.material), document.buffer
            ));
        }
        document.model.meshes.push_back(std::move(mesh));
        document.roots.push_back(document.nodes.begin());
        document.nodes.key("name");
        document.nodes.string(group.name);
        document.nodes.key("mesh");
        document.nodes.number(document.model.meshes.size() - 1);
        document.nodes.end();
        if (document.buffer.bytes() > bytes_max) {
            return false;
        }
    }
    return true;
}

void append_u32(std::string& text, std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
        text += static_cast<char>(value >> shift & 0xFF);
    }
}

tl::unexpected<Error> too_large(std::size_t bytes_max) {
    return tl::unexpected(Error{
        ErrorCode::kTooLarge,
        "the model would be larger than " + std::to_string(bytes_max) + " bytes",
        {}});
}

// The binary chunk. What the JSON is to tell of it beyond what tinygltf writes goes to `inserted`.
std::vector<unsigned char> make_binary(
    Document& document, GlbCompression compression, std::string& inserted
) {
    tinygltf::Model& model = document.model;
    const auto& parts = document.buffer.finish();
    if (compression == GlbCompression::kMeshopt && !parts.empty()) {
        CompressedBuffers compressed = compress_buffers(model, parts);
        inserted += "\"buffers\":" + compressed.buffers + ",";
        inserted += "\"bufferViews\":" + compressed.buffer_views + ",";
        model.bufferViews.clear();
        model.extensionsUsed.emplace_back(kMeshoptExtension);
        model.extensionsRequired.emplace_back(kMeshoptExtension);
        return std::move(compressed.binary);
    }
    std::vector<unsigned char> binary;
    if (!parts.empty()) {
        binary.reserve(model.bufferViews.back().byteOffset + padded(parts.back().size()));
        for (const auto& part : parts) {
            binary.insert(binary.end(), part.begin(), part.end());
            binary.resize(padded(binary.size()));
        }
        inserted += "\"buffers\":[{\"byteLength\":" + std::to_string(binary.size()) + "}],";
    }
    return binary;
}

// The GLB container around tinygltf's JSON, with our nodes put into it.
Result<std::string> assemble(Document& document, const GlbOptions& options) {
    GltfNodes scenes;
    scenes.begin();
    if (!document.roots.empty()) {
        scenes.key("nodes");
        scenes.list(document.roots);
    }
    scenes.end();
    std::string inserted = "\"scene\":0,\"scenes\":[" + scenes.take() + "],";
    if (document.nodes.count() > 0) {
        inserted += "\"nodes\":[" + document.nodes.take() + "],";
    }
    const std::vector<unsigned char> binary = make_binary(document, options.compression, inserted);
    std::ostringstream stream;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&document.model, stream, false, false);
    std::string json = std::move(stream).str();
    while (!json.empty() && json.back() != '}') {
        json.pop_back();  // a final line break
    }
    // tinygltf's text begins with a brace, after which comes what is ours.
    const std::size_t json_bytes = padded(json.size() + inserted.size());
    std::size_t total = kHeaderBytes + kChunkHeaderBytes + json_bytes;
    total += binary.empty() ? 0 : kChunkHeaderBytes + binary.size();
    if (total > options.bytes_max) {
        return too_large(options.bytes_max);
    }
    std::string glb;
    glb.reserve(total);
    glb += "glTF";
    append_u32(glb, 2);
    append_u32(glb, total);
    append_u32(glb, json_bytes);
    glb += "JSON{";
    glb += inserted;
    glb.append(json, 1);
    glb.append(json_bytes - json.size() - inserted.size(), ' ');
    if (!binary.empty()) {
        append_u32(glb, binary.size());
        glb.append("BIN\0", 4);
        glb.append(reinterpret_cast<const char*>(binary.data()), binary.size());
    }
    return glb;
}

}  // namespace

Result<std::string> write_glb(const Scene& scene, const GlbOptions& options) {
    Document document(scene);
    bool fits = true;
    switch (options.profile) {
        case GlbProfile::kNodes:
            write_nodes(document, options.named_nodes);
            break;
        case GlbProfile::kInstanced:
            write_instanced(document);
            break;
        case GlbProfile::kMerged:
            fits = write_merged(document, options.bytes_max);
            break;
    }
    if (!fits || document.nodes.bytes() > options.bytes_max) {
        return too_large(options.bytes_max);
    }
    return assemble(document, options);
}

}  // namespace modelsynth
