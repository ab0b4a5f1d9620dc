#include "solver/mesh/glb_reader.h"

#include "solver/mesh/gltf_accessors.h"
#include "solver/mesh/gltf_document.h"
#include "solver/mesh/gltf_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

// The idea: check what tinygltf does not before it sees the file (container lengths, depth of the
// JSON) and after (every index and every range), then copy.

namespace modelsynth {

namespace {

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
                    return tl::unexpected(invalid_glb("a node has a child that does not exist"));
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
            return tl::unexpected(invalid_glb("its nodes form a cycle"));
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
                return tl::unexpected(invalid_glb(
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
                return tl::unexpected(invalid_glb("a node is the child of two others"));
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
                    return tl::unexpected(invalid_glb("a node has a mesh that does not exist"));
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
            return tl::unexpected(invalid_glb("a node has a mesh that does not exist"));
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
            return tl::unexpected(invalid_glb("a primitive is not made of triangles"));
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
            return tl::unexpected(invalid_glb("a primitive has a material that does not exist"));
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
                    return tl::unexpected(invalid_glb("an index is beyond the last vertex"));
                }
                indices.push_back(static_cast<std::uint32_t>(row[0]));
            }
        }
        if (indices.size() % 3 != 0 || indices.empty()) {
            return tl::unexpected(invalid_glb("the corners of a primitive are no whole triangles"));
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
                    colors ? invalid_glb("COLOR_0 has another length than POSITION")
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
                normals ? invalid_glb("NORMAL has another length than POSITION")
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
    auto model = parse_glb(bytes, limits);
    if (!model) {
        return tl::unexpected(std::move(model.error()));
    }
    if (!model->extensionsRequired.empty()) {
        return tl::unexpected(invalid_glb(
            "requires the extension " + model->extensionsRequired.front() + ", which is not taken"
        ));
    }
    if (model->nodes.size() > limits.nodes_max) {
        return tl::unexpected(
            too_large_glb("has more than " + std::to_string(limits.nodes_max) + " nodes")
        );
    }
    return KitReader(*model, limits).read();
}

}  // namespace modelsynth
