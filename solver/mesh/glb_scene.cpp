#include "solver/mesh/glb_scene.h"

#include "solver/mesh/gltf_document.h"
#include "solver/mesh/gltf_meshes.h"
#include "solver/mesh/gltf_transform.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace modelsynth {

namespace {

// Nests no deeper than the document, which was checked.
Extra extra_of(const nlohmann::json& source) {
    if (source.is_boolean()) {
        return {source.get<bool>()};
    }
    if (source.is_number()) {
        return {source.get<double>()};
    }
    if (source.is_string()) {
        return {source.get<std::string>()};
    }
    if (source.is_array()) {
        Extra::List items;
        for (const nlohmann::json& item : source) {
            items.push_back(extra_of(item));
        }
        return {std::move(items)};
    }
    if (source.is_object()) {
        Extra::Members members;
        for (const auto& [name, member] : source.items()) {
            members.push_back({name, extra_of(member)});
        }
        return {std::move(members)};
    }
    return {};
}

// Of the text, since tinygltf makes 32 bits of integers and nothing of what is empty.
template <class Element>
Extra extras_of(const Element& element) {
    return extra_of(nlohmann::json::parse(element.extras_json_string, nullptr, false));
}

class SceneReader {
  public:
    SceneReader(const tinygltf::Model& model, const GlbReadLimits& limits)
        : model_(model),
          meshes_(model, limits, Textures::kTaken),
          visited_(model.nodes.size()),
          kit_meshes_(model.meshes.size()) {}

    Result<GlbScene> read() {
        if (auto fine = meshes_.read_materials(); !fine) {
            return tl::unexpected(std::move(fine.error()));
        }
        const std::vector<int> roots = find_roots();
        for (const int root : roots) {
            if (auto fine = read_tree(root); !fine) {
                return tl::unexpected(std::move(fine.error()));
            }
        }
        scene_.asset_extras = extras_of(model_.asset);
        scene_.kit.materials = meshes_.take_materials();
        for (const tinygltf::Material& material : model_.materials) {
            scene_.material_extras.push_back(extras_of(material));
        }
        scene_.material_extras.resize(scene_.kit.materials.size());
        return std::move(scene_);
    }

  private:
    [[nodiscard]] bool is_node(int number) const {
        return number >= 0 && static_cast<std::size_t>(number) < model_.nodes.size();
    }

    std::vector<int> find_roots() {
        if (!model_.scenes.empty()) {
            const auto chosen = static_cast<std::size_t>(std::max(model_.defaultScene, 0));
            scene_.number = chosen < model_.scenes.size() ? chosen : 0;
            const tinygltf::Scene& scene = model_.scenes[scene_.number];
            scene_.extras = extras_of(scene);
            return scene.nodes;
        }
        std::vector<bool> is_child(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes) {
            for (const int child : node.children) {
                if (is_node(child)) {
                    is_child[static_cast<std::size_t>(child)] = true;
                }
            }
        }
        std::vector<int> roots;
        for (std::size_t node = 0; node < is_child.size(); ++node) {
            if (!is_child[node]) {
                roots.push_back(static_cast<int>(node));
            }
        }
        return roots;
    }

    Result<void> read_tree(int root) {
        struct Step {
            int node;
            Transform frame;
        };

        std::vector<Step> steps = {{root, {}}};
        while (!steps.empty()) {
            const Step step = steps.back();
            steps.pop_back();
            if (!is_node(step.node)) {
                return tl::unexpected(invalid_glb("names a node that does not exist"));
            }
            const auto number = static_cast<std::size_t>(step.node);
            if (visited_[number]) {
                return tl::unexpected(invalid_glb("a node is the child of two others"));
            }
            visited_[number] = true;
            const tinygltf::Node& node = model_.nodes[number];
            const Transform frame = step.frame.after(local_transform(node));
            if (node.mesh >= 0) {
                if (auto fine = add_node(number, frame); !fine) {
                    return fine;
                }
            }
            // The last one in is the first one out.
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                steps.push_back({*child, frame});
            }
        }
        return {};
    }

    Result<void> add_node(std::size_t number, const Transform& frame) {
        const tinygltf::Node& node = model_.nodes[number];
        auto mesh = mesh_of(node.mesh);
        if (!mesh) {
            return tl::unexpected(std::move(mesh.error()));
        }
        scene_.nodes.push_back({number, node.name, *mesh, frame.columns, extras_of(node)});
        return {};
    }

    // Nodes may share a mesh; it is read once.
    Result<std::uint32_t> mesh_of(int index) {
        const auto number = static_cast<std::size_t>(index);
        if (number < kit_meshes_.size() && kit_meshes_[number]) {
            return *kit_meshes_[number];
        }
        auto primitives = meshes_.read_mesh(index, {});
        if (!primitives) {
            return tl::unexpected(std::move(primitives.error()));
        }
        const auto mesh = static_cast<std::uint32_t>(scene_.kit.meshes.size());
        scene_.kit.meshes.push_back({model_.meshes[number].name, std::move(*primitives)});
        kit_meshes_[number] = mesh;
        return mesh;
    }

    const tinygltf::Model& model_;
    GltfMeshes meshes_;
    std::vector<bool> visited_;
    std::vector<std::optional<std::uint32_t>> kit_meshes_;  // by the file's
    GlbScene scene_;
};

}  // namespace

// Not defaulted, which clang does where Extra is still incomplete.
bool operator==(const Extra& a, const Extra& b) { return a.value == b.value; }

const Extra* Extra::find(std::string_view name) const {
    const auto* members = std::get_if<Members>(&value);
    if (members == nullptr) {
        return nullptr;
    }
    const auto found = std::find_if(members->begin(), members->end(), [&](const auto& member) {
        return member.name == name;
    });
    return found == members->end() ? nullptr : &found->extra;
}

Result<GlbScene> read_glb_scene(std::span<const std::byte> bytes, const GlbReadLimits& limits) {
    auto model = parse_glb(bytes, limits);
    if (!model) {
        return tl::unexpected(std::move(model.error()));
    }
    return SceneReader(*model, limits).read();
}

}  // namespace modelsynth
