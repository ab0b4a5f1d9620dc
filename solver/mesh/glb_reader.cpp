#include "solver/mesh/glb_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

// The idea: check what tinygltf does not before it sees the file (container lengths, depth of the
// JSON) and after (every index and every range), then copy.

namespace modelsynth {

namespace {

Error invalid(std::string message) {
    return {ErrorCode::kInvalidArgument, "GLB: " + std::move(message), {}};
}

Error too_large(std::string message) {
    return {ErrorCode::kTooLarge, "GLB: " + std::move(message), {}};
}

// A 3x4 matrix: columns for x, y, z and the translation.
struct Transform {
    std::array<std::array<double, 3>, 4> columns = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

    [[nodiscard]] std::array<double, 3> turn(const std::array<double, 3>& v) const {
        std::array<double, 3> result = {};
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                result[row] += columns[column][row] * v[column];
            }
        }
        return result;
    }

    [[nodiscard]] std::array<double, 3> place(const std::array<double, 3>& v) const {
        auto result = turn(v);
        for (std::size_t row = 0; row < 3; ++row) {
            result[row] += columns[3][row];
        }
        return result;
    }

    // First `inner`, then this.
    [[nodiscard]] Transform after(const Transform& inner) const {
        Transform result;
        for (std::size_t column = 0; column < 3; ++column) {
            result.columns[column] = turn(inner.columns[column]);
        }
        result.columns[3] = place(inner.columns[3]);
        return result;
    }

    [[nodiscard]] double determinant() const {
        const auto& [a, b, c, t] = columns;
        return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
               c[0] * (a[1] * b[2] - a[2] * b[1]);
    }
};

Transform local_transform(const tinygltf::Node& node) {
    Transform result;
    if (node.matrix.size() == 16) {
        for (std::size_t column = 0; column < 4; ++column) {
            for (std::size_t row = 0; row < 3; ++row) {
                result.columns[column][row] = node.matrix[column * 4 + row];
            }
        }
        return result;
    }
    if (node.rotation.size() == 4) {
        const double x = node.rotation[0];
        const double y = node.rotation[1];
        const double z = node.rotation[2];
        const double w = node.rotation[3];
        result.columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
        result.columns[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
        result.columns[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    }
    if (node.scale.size() == 3) {
        for (std::size_t column = 0; column < 3; ++column) {
            for (double& part : result.columns[column]) {
                part *= node.scale[column];
            }
        }
    }
    if (node.translation.size() == 3) {
        result.columns[3] = {node.translation[0], node.translation[1], node.translation[2]};
    }
    return result;
}

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) {
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
    }
    return value;
}

// How deep the brackets of a JSON text nest, strings left out.
std::size_t nesting_depth(std::span<const std::byte> json) {
    std::size_t depth = 0;
    std::size_t deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = static_cast<char>(json[i]);
        if (in_string) {
            i += c == '\\' ? 1U : 0U;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if ((c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

Result<void> check_container(std::span<const std::byte> bytes, const GlbReadLimits& limits) {
    if (bytes.size() > limits.bytes_max) {
        return tl::unexpected(
            too_large("larger than " + std::to_string(limits.bytes_max) + " bytes")
        );
    }
    if (bytes.size() < 20 || std::memcmp(bytes.data(), "glTF", 4) != 0) {
        return tl::unexpected(invalid("does not begin with a binary glTF header"));
    }
    if (read_u32(bytes, 4) != 2) {
        return tl::unexpected(invalid("is not of version 2"));
    }
    if (read_u32(bytes, 8) != bytes.size()) {
        return tl::unexpected(invalid(
            "says it has " + std::to_string(read_u32(bytes, 8)) + " bytes and has " +
            std::to_string(bytes.size())
        ));
    }
    const std::size_t json_size = read_u32(bytes, 12);
    if (json_size > bytes.size() - 20 || std::memcmp(bytes.data() + 16, "JSON", 4) != 0) {
        return tl::unexpected(invalid("has no whole JSON chunk"));
    }
    if (nesting_depth(bytes.subspan(20, json_size)) > limits.json_depth_max) {
        return tl::unexpected(
            invalid("its JSON nests deeper than " + std::to_string(limits.json_depth_max))
        );
    }
    const std::size_t binary_at = 20 + json_size;
    if (binary_at == bytes.size()) {
        return {};
    }
    if (bytes.size() - binary_at < 8 || read_u32(bytes, binary_at) > bytes.size() - binary_at - 8) {
        return tl::unexpected(invalid("has no whole binary chunk"));
    }
    return {};
}

Result<tinygltf::Model> parse(std::span<const std::byte> bytes) {
    tinygltf::TinyGLTF loader;
    tinygltf::FsCallbacks no_files = {};
    no_files.FileExists = [](const std::string&, void*) { return false; };
    no_files.ExpandFilePath = [](const std::string&, void*) { return std::string(); };
    no_files.ReadWholeFile =
        [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; };
    no_files.WriteWholeFile =
        [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
            return false;
        };
    loader.SetFsCallbacks(no_files);
    loader.SetImageLoader(
        [](tinygltf::Image*,
           int,
           std::string*,
           std::string*,
           int,
           int,
           const unsigned char*,
           int,
           void*) { return true; },
        nullptr
    );
    tinygltf::Model model;
    std::string errors;
    std::string warnings;
    const bool loaded = loader.LoadBinaryFromMemory(
        &model,
        &errors,
        &warnings,
        reinterpret_cast<const unsigned char*>(bytes.data()),
        static_cast<unsigned int>(bytes.size())
    );
    if (!loaded) {
        if (errors.find("json.exception") != std::string::npos) {
            return tl::unexpected(invalid("its JSON is malformed"));
        }
        const std::string first_line = errors.substr(0, errors.find('\n'));
        return tl::unexpected(invalid("cannot be read: " + first_line.substr(0, 200)));
    }
    return model;
}

// Reads numbers out of accessors, each access within its buffer.
class AccessorReader {
  public:
    AccessorReader(const tinygltf::Model& model, std::size_t vertices_max)
        : model_(model), vertices_left_(vertices_max) {}

    // The rows of an accessor as doubles, normalised integers as fractions.
    Result<std::vector<std::array<double, 4>>> rows(int index, const std::string& what) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) {
            return tl::unexpected(invalid(what + " has no accessor"));
        }
        const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
        const std::string name = what + " (accessor " + std::to_string(index) + ")";
        if (accessor.sparse.isSparse) {
            return tl::unexpected(invalid(name + " is sparse"));
        }
        const auto views = model_.bufferViews.size();
        if (accessor.bufferView < 0 || static_cast<std::size_t>(accessor.bufferView) >= views) {
            return tl::unexpected(invalid(name + " has no buffer view"));
        }
        const tinygltf::BufferView& view =
            model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
            return tl::unexpected(invalid(name + " has no buffer"));
        }
        const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
        const int component_bytes =
            tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
        const int components =
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
        if (component_bytes <= 0 || components <= 0 || components > 4) {
            return tl::unexpected(invalid(name + " has an unknown type"));
        }
        const auto row_bytes = static_cast<std::size_t>(component_bytes * components);
        const std::size_t stride = view.byteStride == 0 ? row_bytes : view.byteStride;
        if (accessor.count > vertices_left_) {
            return tl::unexpected(too_large("has more vertices than are taken"));
        }
        vertices_left_ -= accessor.count;
        const bool view_fits =
            view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset;
        const bool rows_fit =
            view_fits && accessor.byteOffset <= view.byteLength && stride >= row_bytes &&
            accessor.count > 0 && row_bytes <= view.byteLength - accessor.byteOffset &&
            (accessor.count - 1) <= (view.byteLength - accessor.byteOffset - row_bytes) / stride;
        if (!rows_fit) {
            return tl::unexpected(invalid(name + " reaches beyond its buffer"));
        }
        std::vector<std::array<double, 4>> result(accessor.count);
        const unsigned char* from = data.data() + view.byteOffset + accessor.byteOffset;
        for (std::size_t row = 0; row < accessor.count; ++row) {
            for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) {
                result[row][c] = number(
                    from + row * stride + c * static_cast<std::size_t>(component_bytes),
                    accessor.componentType,
                    accessor.normalized
                );
                if (!std::isfinite(result[row][c]) || std::fabs(result[row][c]) > 1e9) {
                    return tl::unexpected(invalid(name + " has a number that is not usable"));
                }
            }
        }
        return result;
    }

  private:
    template <class T>
    static double read(const unsigned char* from, bool normalised) {
        T value;
        std::memcpy(&value, from, sizeof value);
        const auto number = static_cast<double>(value);
        return normalised ? number / static_cast<double>(std::numeric_limits<T>::max()) : number;
    }

    static double number(const unsigned char* from, int type, bool normalised) {
        switch (type) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return read<std::int8_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return read<std::uint8_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return read<std::int16_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return read<std::uint16_t>(from, normalised);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                return read<std::uint32_t>(from, false);
            case TINYGLTF_COMPONENT_TYPE_FLOAT:
                return read<float>(from, false);
            default:
                return std::nan("");
        }
    }

    const tinygltf::Model& model_;
    std::size_t vertices_left_;
};

// Turns the nodes of a parsed file into a kit.
class KitReader {
  public:
    KitReader(const tinygltf::Model& model, const GlbReadLimits& limits)
        : model_(model), accessors_(model, limits.vertices_max), visited_(model.nodes.size()) {}

    Result<Kit> read() {
        if (auto fine = read_materials(); !fine) {
            return tl::unexpected(std::move(fine.error()));
        }
        std::vector<bool> is_child(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes) {
            for (const int child : node.children) {
                if (child < 0 || static_cast<std::size_t>(child) >= model_.nodes.size()) {
                    return tl::unexpected(invalid("a node has a child that does not exist"));
                }
                is_child[static_cast<std::size_t>(child)] = true;
            }
        }
        for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
            if (is_child[node]) {
                continue;
            }
            if (auto fine = read_tree(node); !fine) {
                return tl::unexpected(std::move(fine.error()));
            }
        }
        if (std::find(visited_.begin(), visited_.end(), false) != visited_.end()) {
            return tl::unexpected(invalid("its nodes form a cycle"));
        }
        return std::move(kit_);
    }

  private:
    Result<void> read_materials() {
        for (const tinygltf::Material& source : model_.materials) {
            const auto& surface = source.pbrMetallicRoughness;
            if (surface.baseColorTexture.index >= 0 ||
                surface.metallicRoughnessTexture.index >= 0 || source.normalTexture.index >= 0 ||
                source.emissiveTexture.index >= 0 || source.occlusionTexture.index >= 0) {
                return tl::unexpected(invalid(
                    "material \"" + source.name + "\" has a texture; only plain colours are taken"
                ));
            }
            const auto color = [](const std::vector<double>& parts, float otherwise) {
                const auto part = [&](std::size_t i) {
                    return i < parts.size() ? std::clamp(static_cast<float>(parts[i]), 0.0F, 1.0F)
                                            : otherwise;
                };
                return Color{part(0), part(1), part(2)};
            };
            kit_.materials.push_back(
                {source.name,
                 color(surface.baseColorFactor, 1),
                 std::clamp(static_cast<float>(surface.metallicFactor), 0.0F, 1.0F),
                 std::clamp(static_cast<float>(surface.roughnessFactor), 0.0F, 1.0F),
                 color(source.emissiveFactor, 0),
                 source.doubleSided}
            );
        }
        return {};
    }

    std::uint32_t default_material() {
        if (default_material_ < 0) {
            default_material_ = static_cast<int>(kit_.materials.size());
            kit_.materials.push_back({"default", {0.8F, 0.8F, 0.8F}});
        }
        return static_cast<std::uint32_t>(default_material_);
    }

    // The tree below a root: each named node with a mesh somewhere under it becomes a mesh, the
    // outermost name with geometry of its own or under nameless nodes wins.
    Result<void> read_tree(std::size_t root) {
        struct Step {
            std::size_t node;
            Transform transform;
            // The mesh of the kit under which geometry is gathered; -1: none yet.
            int target;
            // Of the nearest named node above that has no geometry of its own.
            std::string name;
        };

        std::vector<Step> steps = {{root, {}, -1, ""}};
        while (!steps.empty()) {
            const Step step = steps.back();
            steps.pop_back();
            if (visited_[step.node]) {
                return tl::unexpected(invalid("a node is the child of two others"));
            }
            visited_[step.node] = true;
            const tinygltf::Node& node = model_.nodes[step.node];
            Transform transform = step.transform.after(local_transform(node));
            int target = step.target;
            std::string name = step.name;
            if (target < 0 && node.mesh < 0 && !node.name.empty()) {
                name = node.name;  // perhaps its geometry is in nodes below without a name
                transform = local_transform(node);
                transform.columns[3] = {0, 0, 0};
            }
            if (target < 0 && node.mesh >= 0 && node.name.empty() && !step.name.empty()) {
                target = mesh_named(step.name);
            } else if (target < 0 && node.mesh >= 0) {
                if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
                    return tl::unexpected(invalid("a node has a mesh that does not exist"));
                }
                const std::string& mesh_name =
                    model_.meshes[static_cast<std::size_t>(node.mesh)].name;
                target = static_cast<int>(kit_.meshes.size());
                kit_.meshes.push_back({node.name.empty() ? mesh_name : node.name, {}});
                transform = local_transform(node);
                transform.columns[3] = {0, 0, 0};
            }
            if (node.mesh >= 0) {
                if (auto fine = read_mesh(node.mesh, transform, target); !fine) {
                    return fine;
                }
            }
            for (const int child : node.children) {
                steps.push_back({static_cast<std::size_t>(child), transform, target, name});
            }
        }
        return {};
    }

    // The last mesh when it has the name, or a new one: the parts of one node follow each other.
    int mesh_named(const std::string& name) {
        if (kit_.meshes.empty() || kit_.meshes.back().name != name) {
            kit_.meshes.push_back({name, {}});
        }
        return static_cast<int>(kit_.meshes.size()) - 1;
    }

    Result<void> read_mesh(int index, const Transform& transform, int target) {
        if (static_cast<std::size_t>(index) >= model_.meshes.size()) {
            return tl::unexpected(invalid("a node has a mesh that does not exist"));
        }
        for (const auto& source : model_.meshes[static_cast<std::size_t>(index)].primitives) {
            auto primitive = read_primitive(source, transform);
            if (!primitive) {
                return tl::unexpected(std::move(primitive.error()));
            }
            kit_.meshes[static_cast<std::size_t>(target)].primitives.push_back(std::move(*primitive)
            );
        }
        return {};
    }

    Result<Primitive> read_primitive(
        const tinygltf::Primitive& source, const Transform& transform
    ) {
        if (source.mode != TINYGLTF_MODE_TRIANGLES && source.mode != -1) {
            return tl::unexpected(invalid("a primitive is not made of triangles"));
        }
        const auto attribute = [&source](const char* name) {
            const auto found = source.attributes.find(name);
            return found == source.attributes.end() ? -1 : found->second;
        };
        auto positions = accessors_.rows(attribute("POSITION"), "POSITION");
        if (!positions) {
            return tl::unexpected(std::move(positions.error()));
        }
        Primitive primitive;
        if (source.material >= static_cast<int>(model_.materials.size())) {
            return tl::unexpected(invalid("a primitive has a material that does not exist"));
        }
        primitive.material =
            source.material < 0 ? default_material() : static_cast<std::uint32_t>(source.material);
        std::vector<std::uint32_t> indices(positions->size());
        for (std::size_t i = 0; i < indices.size(); ++i) {
            indices[i] = static_cast<std::uint32_t>(i);
        }
        if (source.indices >= 0) {
            auto rows = accessors_.rows(source.indices, "indices");
            if (!rows) {
                return tl::unexpected(std::move(rows.error()));
            }
            indices.clear();
            for (const auto& row : *rows) {
                if (row[0] < 0 || row[0] >= static_cast<double>(positions->size())) {
                    return tl::unexpected(invalid("an index is beyond the last vertex"));
                }
                indices.push_back(static_cast<std::uint32_t>(row[0]));
            }
        }
        if (indices.size() % 3 != 0 || indices.empty()) {
            return tl::unexpected(invalid("the corners of a primitive are no whole triangles"));
        }
        if (transform.determinant() < 0) {
            for (std::size_t i = 0; i < indices.size(); i += 3) {
                std::swap(indices[i + 1], indices[i + 2]);
            }
        }
        return finish(source, *positions, std::move(indices), transform, std::move(primitive));
    }

    Result<Primitive> finish(
        const tinygltf::Primitive& source,
        const std::vector<std::array<double, 4>>& positions,
        std::vector<std::uint32_t> indices,
        const Transform& transform,
        Primitive primitive
    ) {
        const auto to_vec3 = [](const std::array<double, 3>& v) {
            return Vec3{
                static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
        };
        for (const auto& row : positions) {
            primitive.positions.push_back(to_vec3(transform.place({row[0], row[1], row[2]})));
        }
        primitive.colors.assign(positions.size(), {255, 255, 255});
        if (const auto found = source.attributes.find("COLOR_0");
            found != source.attributes.end()) {
            auto colors = accessors_.rows(found->second, "COLOR_0");
            if (!colors || colors->size() != positions.size()) {
                return tl::unexpected(
                    colors ? invalid("COLOR_0 has another length than POSITION")
                           : std::move(colors.error())
                );
            }
            for (std::size_t i = 0; i < positions.size(); ++i) {
                for (std::size_t c = 0; c < 3; ++c) {
                    primitive.colors[i][c] = static_cast<std::uint8_t>(
                        std::lround(std::clamp((*colors)[i][c], 0.0, 1.0) * 255)
                    );
                }
            }
        }
        const auto found = source.attributes.find("NORMAL");
        if (found == source.attributes.end()) {
            return flat(primitive, indices);
        }
        auto normals = accessors_.rows(found->second, "NORMAL");
        if (!normals || normals->size() != positions.size()) {
            return tl::unexpected(
                normals ? invalid("NORMAL has another length than POSITION")
                        : std::move(normals.error())
            );
        }
        for (const auto& row : *normals) {
            const auto turned = transform.turn({row[0], row[1], row[2]});
            const double size = std::hypot(turned[0], turned[1], turned[2]);
            primitive.normals.push_back(
                size > 1e-9 ? to_vec3({turned[0] / size, turned[1] / size, turned[2] / size})
                            : Vec3{0, 1, 0}
            );
        }
        primitive.indices = std::move(indices);
        return primitive;
    }

    // Three vertices of its own and a flat normal for every triangle.
    static Primitive flat(const Primitive& source, const std::vector<std::uint32_t>& indices) {
        Primitive primitive;
        primitive.material = source.material;
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const Vec3& a = source.positions[indices[i]];
            const Vec3& b = source.positions[indices[i + 1]];
            const Vec3& c = source.positions[indices[i + 2]];
            const Vec3 u = {b.x - a.x, b.y - a.y, b.z - a.z};
            const Vec3 v = {c.x - a.x, c.y - a.y, c.z - a.z};
            Vec3 normal = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
            const float size =
                std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
            normal =
                size > 0 ? Vec3{normal.x / size, normal.y / size, normal.z / size} : Vec3{0, 1, 0};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                primitive.indices.push_back(static_cast<std::uint32_t>(i + corner));
                primitive.positions.push_back(source.positions[indices[i + corner]]);
                primitive.colors.push_back(source.colors[indices[i + corner]]);
                primitive.normals.push_back(normal);
            }
        }
        return primitive;
    }

    const tinygltf::Model& model_;
    AccessorReader accessors_;
    std::vector<bool> visited_;
    Kit kit_;
    int default_material_ = -1;
};

}  // namespace

Result<Kit> read_glb(std::span<const std::byte> bytes, const GlbReadLimits& limits) {
    if (auto fine = check_container(bytes, limits); !fine) {
        return tl::unexpected(std::move(fine.error()));
    }
    auto model = parse(bytes);
    if (!model) {
        return tl::unexpected(std::move(model.error()));
    }
    if (!model->extensionsRequired.empty()) {
        return tl::unexpected(invalid(
            "requires the extension " + model->extensionsRequired.front() + ", which is not taken"
        ));
    }
    if (model->nodes.size() > limits.nodes_max) {
        return tl::unexpected(
            too_large("has more than " + std::to_string(limits.nodes_max) + " nodes")
        );
    }
    return KitReader(*model, limits).read();
}

}  // namespace modelsynth
