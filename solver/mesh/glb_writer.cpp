#include "solver/mesh/glb_writer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

// The idea: tinygltf writes everything whose number does not grow with the model - meshes,
// materials, accessors. Nodes are written here as text and put into its JSON chunk, because
// tinygltf's in-memory node costs about two kilobytes: a city of 200 000 pieces would take
// 400 MB to write 20 MB.

namespace modelsynth {

namespace {

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

Vec3 turned(const Vec3& v, std::uint8_t quarter_turns) {
    switch (quarter_turns % 4) {
        case 1:
            return {v.z, v.y, -v.x};
        case 2:
            return {-v.x, v.y, -v.z};
        case 3:
            return {-v.z, v.y, v.x};
        default:
            return v;
    }
}

Vec3 moved(const Vec3& v, const Vec3& offset) {
    return {v.x + offset.x, v.y + offset.y, v.z + offset.z};
}

// Text of the nodes array.
class NodeWriter {
  public:
    // Starts a node and returns its number.
    std::uint32_t begin() {
        text_ += count_ == 0 ? "{" : ",{";
        first_ = true;
        return count_++;
    }

    void end() { text_ += '}'; }

    void key(const char* name) {
        text_ += first_ ? "\"" : ",\"";
        text_ += name;
        text_ += "\":";
        first_ = false;
    }

    void raw(const char* text) { text_ += text; }

    template <class Number>
    void number(Number value) {
        std::array<char, 32> digits;
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        text_.append(digits.data(), end);
    }

    void vector(const Vec3& v) {
        text_ += '[';
        number(v.x);
        text_ += ',';
        number(v.y);
        text_ += ',';
        number(v.z);
        text_ += ']';
    }

    void string(const std::string& value) { text_ += quoted(value); }

    void rotation(std::uint8_t quarter_turns) {
        static constexpr std::array<const char*, 4> kQuaternions = {
            "[0,0,0,1]",
            "[0,0.70710678,0,0.70710678]",
            "[0,1,0,0]",
            "[0,-0.70710678,0,0.70710678]"};
        key("rotation");
        raw(kQuaternions[quarter_turns % 4]);
    }

    void range(std::uint32_t first, std::uint32_t count) {
        text_ += '[';
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i > 0) {
                text_ += ',';
            }
            number(first + i);
        }
        text_ += ']';
    }

    void list(const std::vector<std::uint32_t>& values) {
        text_ += '[';
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i > 0) {
                text_ += ',';
            }
            number(values[i]);
        }
        text_ += ']';
    }

    [[nodiscard]] std::size_t bytes() const { return text_.size(); }

    [[nodiscard]] std::uint32_t count() const { return count_; }

    [[nodiscard]] std::string take() { return std::move(text_); }

    static std::string quoted(const std::string& value) {
        std::string text = "\"";
        for (const char c : value) {
            const auto byte = static_cast<unsigned char>(c);
            if (c == '"' || c == '\\') {
                text += '\\';
                text += c;
            } else if (byte < 0x20) {
                static constexpr const char* kHex = "0123456789abcdef";
                text += "\\u00";
                text += kHex[byte >> 4];
                text += kHex[byte & 15];
            } else {
                text += c;
            }
        }
        return text + '"';
    }

  private:
    std::string text_;
    std::uint32_t count_ = 0;
    bool first_ = true;
};

// Bytes of the binary chunk and the tinygltf views and accessors over them.
class BufferWriter {
  public:
    explicit BufferWriter(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

    int positions(const std::vector<Vec3>& values) {
        const int accessor =
            add(values.data(), values.size(), sizeof(Vec3), TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        set_bounds(accessor, values);
        return accessor;
    }

    int normals(const std::vector<Vec3>& values) {
        const int accessor =
            add(values.data(), values.size(), sizeof(Vec3), TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        return accessor;
    }

    // Vertex colours times the material's colour, RGB as RGBA in 16 bits each: some readers (VTK)
    // take vertex colours in place of the material's instead of multiplying them, and eight
    // linear bits are too few for dark colours.
    int colors(const std::vector<std::array<std::uint8_t, 3>>& values, const Color& base) {
        const auto part = [](std::uint8_t value, float factor) {
            return static_cast<std::uint16_t>(std::lround(double{factor} * value * 257.0));
        };
        std::vector<std::uint16_t> parts;
        parts.reserve(values.size() * 4);
        for (const auto& color : values) {
            parts.insert(
                parts.end(),
                {part(color[0], base.r), part(color[1], base.g), part(color[2], base.b), 65535}
            );
        }
        const int accessor = add(parts.data(), values.size(), 8, TINYGLTF_TARGET_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
        model_.accessors.back().normalized = true;
        return accessor;
    }

    int indices(const std::vector<std::uint32_t>& values, std::size_t vertex_count) {
        if (vertex_count > 65535) {
            const int accessor =
                add(values.data(),
                    values.size(),
                    sizeof(std::uint32_t),
                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
            describe(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
            return accessor;
        }
        const std::vector<std::uint16_t> narrow(values.begin(), values.end());
        const int accessor =
            add(narrow.data(),
                narrow.size(),
                sizeof(std::uint16_t),
                TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        describe(accessor, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR);
        return accessor;
    }

    // Instance attributes: one view for all, without a target, since a view and bounds for each
    // would weigh more than the numbers themselves. Call it last, and add nothing after it.
    int translations(const std::vector<Vec3>& values) {
        if (translations_view_ < 0) {
            translations_view_ = static_cast<int>(model_.bufferViews.size());
            tinygltf::BufferView view;
            view.buffer = 0;
            view.byteOffset = data().size();
            model_.bufferViews.push_back(std::move(view));
        }
        auto& view = model_.bufferViews[static_cast<std::size_t>(translations_view_)];
        tinygltf::Accessor accessor;
        accessor.bufferView = translations_view_;
        accessor.byteOffset = view.byteLength;
        accessor.count = values.size();
        accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
        accessor.type = TINYGLTF_TYPE_VEC3;
        model_.accessors.push_back(std::move(accessor));
        const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
        data().insert(data().end(), bytes, bytes + values.size() * sizeof(Vec3));
        view.byteLength += values.size() * sizeof(Vec3);
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    [[nodiscard]] std::size_t bytes() const { return data().size(); }

  private:
    int add(const void* values, std::size_t count, std::size_t stride, int target) {
        const std::size_t offset = data().size();
        const auto* bytes = static_cast<const unsigned char*>(values);
        data().insert(data().end(), bytes, bytes + count * stride);
        data().resize((data().size() + 3) / 4 * 4);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = offset;
        view.byteLength = count * stride;
        view.target = target;
        model_.bufferViews.push_back(std::move(view));
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
        accessor.count = count;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    void describe(int accessor, int component_type, int type) {
        auto& described = model_.accessors[static_cast<std::size_t>(accessor)];
        described.componentType = component_type;
        described.type = type;
    }

    void set_bounds(int accessor, const std::vector<Vec3>& values) {
        Vec3 low = values.front();
        Vec3 high = low;
        for (const Vec3& v : values) {
            low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
            high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
        }
        const auto widen = [](const Vec3& v) {
            return std::vector<double>{double{v.x}, double{v.y}, double{v.z}};
        };
        auto& described = model_.accessors[static_cast<std::size_t>(accessor)];
        described.minValues = widen(low);
        described.maxValues = widen(high);
    }

    [[nodiscard]] std::vector<unsigned char>& data() { return model_.buffers[0].data; }

    [[nodiscard]] const std::vector<unsigned char>& data() const { return model_.buffers[0].data; }

    tinygltf::Model& model_;
    int translations_view_ = -1;
};

tinygltf::Primitive write_primitive(
    const Primitive& primitive, const Kit& kit, int material, BufferWriter& buffer
) {
    tinygltf::Primitive written;
    written.mode = TINYGLTF_MODE_TRIANGLES;
    written.material = material;
    written.attributes["POSITION"] = buffer.positions(primitive.positions);
    written.attributes["NORMAL"] = buffer.normals(primitive.normals);
    written.attributes["COLOR_0"] =
        buffer.colors(primitive.colors, kit.materials[primitive.material].base_color);
    written.indices = buffer.indices(primitive.indices, primitive.positions.size());
    return written;
}

// Puts the materials that are used into the file and tells their numbers there.
class MaterialWriter {
  public:
    MaterialWriter(tinygltf::Model& model, const Kit& kit)
        : model_(model), kit_(kit), written_(kit.materials.size(), -1) {}

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

    static tinygltf::Material write(const Material& material) {
        tinygltf::Material written;
        written.name = material.name;
        written.pbrMetallicRoughness.baseColorFactor = {1, 1, 1, 1};  // see colors()
        written.pbrMetallicRoughness.metallicFactor = parts({material.metallic, 0, 0})[0];
        written.pbrMetallicRoughness.roughnessFactor = parts({material.roughness, 0, 0})[0];
        written.emissiveFactor = parts(material.emissive);
        written.doubleSided = material.double_sided;
        return written;
    }

    tinygltf::Model& model_;
    const Kit& kit_;
    std::vector<int> written_;
};

// The file as it grows.
struct Document {
    explicit Document(const Scene& source)
        : scene(source), buffer(model), materials(model, *source.kit) {
        model.asset.version = "2.0";
        model.asset.generator = "modelsynth";
    }

    const Scene& scene;
    tinygltf::Model model;
    BufferWriter buffer;
    MaterialWriter materials;
    NodeWriter nodes;
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
        names.push_back(NodeWriter::quoted(name));
    }
    NodeWriter& nodes = document.nodes;
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
    NodeWriter& nodes = document.nodes;
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
    for (const std::uint32_t index : source.indices) {
        merged.indices.push_back(base + index);
    }
}

// False when the file has grown over the limit.
bool write_merged(Document& document, std::size_t bytes_max) {
    const Kit& kit = *document.scene.kit;
    for (const SceneGroup& group : document.scene.groups) {
        std::map<std::uint32_t, Primitive> by_material;
        for (const Instance& instance : group.instances) {
            for (const Primitive& primitive : kit.meshes[instance.mesh].primitives) {
                Primitive& merged = by_material[primitive.material];
                merged.material = primitive.material;
                append_placed(primitive, instance, merged);
            }
        }
        if (by_material.empty()) {
            continue;
        }
        tinygltf::Mesh mesh;
        mesh.name = group.name;
        for (const auto& [material, primitive] : by_material) {
            mesh.primitives.push_back(write_primitive(
                primitive, kit, document.materials.number(material), document.buffer
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

// The GLB container around tinygltf's JSON, with our nodes put into it.
Result<std::string> assemble(Document& document, std::size_t bytes_max) {
    const auto too_large = [bytes_max] {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "the model would be larger than " + std::to_string(bytes_max) + " bytes",
            {}});
    };
    NodeWriter scenes;
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
    const std::vector<unsigned char> binary = std::move(document.model.buffers[0].data);
    document.model.buffers.clear();
    std::ostringstream stream;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&document.model, stream, false, false);
    std::string json = std::move(stream).str();
    while (!json.empty() && json.back() != '}') {
        json.pop_back();  // a final line break
    }
    if (!binary.empty()) {
        inserted += "\"buffers\":[{\"byteLength\":" + std::to_string(binary.size()) + "}],";
    }
    json.insert(1, inserted);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::size_t total = kHeaderBytes + kChunkHeaderBytes + json.size();
    total += binary.empty() ? 0 : kChunkHeaderBytes + binary.size();
    if (total > bytes_max) {
        return too_large();
    }
    std::string glb;
    glb.reserve(total);
    glb += "glTF";
    append_u32(glb, 2);
    append_u32(glb, total);
    append_u32(glb, json.size());
    glb += "JSON";
    glb += json;
    if (!binary.empty()) {
        append_u32(glb, binary.size());
        glb.append("BIN\0", 4);
        glb.append(binary.begin(), binary.end());
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
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "the model would be larger than " + std::to_string(options.bytes_max) + " bytes",
            {}});
    }
    return assemble(document, options.bytes_max);
}

}  // namespace modelsynth
