#pragma once

#include "solver/core/result.h"
#include "solver/mesh/gltf_accessors.h"
#include "solver/mesh/gltf_document.h"
#include "solver/mesh/gltf_textures.h"
#include "solver/mesh/gltf_transform.h"
#include "solver/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {

// Whether materials may have a texture of their base colour; others are never taken.
enum class Textures : std::uint8_t { kRefused, kTaken };

// Reads the materials and meshes of a parsed file, every index checked.
class GltfMeshes {
  public:
    GltfMeshes(const tinygltf::Model& model, const GlbReadLimits& limits, Textures textures)
        : model_(model),
          accessors_(model, limits.vertices_max),
          textures_(model, limits.image_bytes_max),
          takes_textures_(textures == Textures::kTaken) {}

    Result<void> read_materials() {
        for (const tinygltf::Material& source : model_.materials) {
            const auto& surface = source.pbrMetallicRoughness;
            auto texture = read_texture(source);
            if (!texture) {
                return tl::unexpected(std::move(texture.error()));
            }
            const auto color = [](const std::vector<double>& parts, float otherwise) {
                const auto part = [&](std::size_t i) {
                    return i < parts.size() ? std::clamp(static_cast<float>(parts[i]), 0.0F, 1.0F)
                                            : otherwise;
                };
                return Color{part(0), part(1), part(2)};
            };
            materials_.push_back(
                {source.name,
                 color(surface.baseColorFactor, 1),
                 std::clamp(static_cast<float>(surface.metallicFactor), 0.0F, 1.0F),
                 std::clamp(static_cast<float>(surface.roughnessFactor), 0.0F, 1.0F),
                 color(source.emissiveFactor, 0),
                 source.doubleSided,
                 std::move(*texture)}
            );
        }
        return {};
    }

    // The primitives of a mesh, transformed.
    Result<std::vector<Primitive>> read_mesh(int index, const Transform& transform) {
        if (index < 0 || static_cast<std::size_t>(index) >= model_.meshes.size()) {
            return tl::unexpected(invalid_glb("a node has a mesh that does not exist"));
        }
        std::vector<Primitive> primitives;
        for (const auto& source : model_.meshes[static_cast<std::size_t>(index)].primitives) {
            auto primitive = read_primitive(source, transform);
            if (!primitive) {
                return tl::unexpected(std::move(primitive.error()));
            }
            primitives.push_back(std::move(*primitive));
        }
        return primitives;
    }

    // Those that were read, and one for the primitives that have none.
    std::vector<Material> take_materials() { return std::move(materials_); }

  private:
    Result<std::optional<Texture>> read_texture(const tinygltf::Material& source) {
        const auto& surface = source.pbrMetallicRoughness;
        const bool has_base_color = surface.baseColorTexture.index >= 0;
        const std::string place = "material \"" + source.name + "\"";
        if (has_base_color && !takes_textures_) {
            return tl::unexpected(
                invalid_glb(place + " has a texture; only plain colours are taken")
            );
        }
        if (surface.metallicRoughnessTexture.index >= 0 || source.normalTexture.index >= 0 ||
            source.emissiveTexture.index >= 0 || source.occlusionTexture.index >= 0) {
            return tl::unexpected(invalid_glb(
                place + (takes_textures_ ? " has a texture of another kind than base colours"
                                         : " has a texture; only plain colours are taken")
            ));
        }
        if (!has_base_color) {
            return std::nullopt;
        }
        return textures_.read(source, place);
    }

    std::uint32_t default_material() {
        if (default_material_ < 0) {
            default_material_ = static_cast<int>(materials_.size());
            materials_.push_back({"default", {0.8F, 0.8F, 0.8F}});
        }
        return static_cast<std::uint32_t>(default_material_);
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
    GltfTextures textures_;
    bool takes_textures_;
    std::vector<Material> materials_;
    int default_material_ = -1;
};

}  // namespace modelsynth
