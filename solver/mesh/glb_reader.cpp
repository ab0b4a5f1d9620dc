#include "solver/mesh/glb_reader.h"

#include "solver/mesh/gltf_document.h"
#include "solver/mesh/gltf_meshes.h"
#include "solver/mesh/gltf_transform.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

// The idea: check what tinygltf does not before it sees the file (container lengths, depth of the
// JSON) and after (every index and every range), then copy.

namespace modelsynth {

namespace {

// Turns the nodes of a parsed file into a kit.
class KitReader {
  public:
    KitReader(const tinygltf::Model& model, const GlbReadLimits& limits)
        : model_(model), meshes_(model, limits, Textures::kRefused), visited_(model.nodes.size()) {}

    Result<Kit> read() {
        if (auto fine = meshes_.read_materials(); !fine) {
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
        kit_.materials = meshes_.take_materials();
        return std::move(kit_);
    }

  private:
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
        auto primitives = meshes_.read_mesh(index, transform);
        if (!primitives) {
            return tl::unexpected(std::move(primitives.error()));
        }
        auto& all = kit_.meshes[static_cast<std::size_t>(target)].primitives;
        std::move(primitives->begin(), primitives->end(), std::back_inserter(all));
        return {};
    }

    const tinygltf::Model& model_;
    GltfMeshes meshes_;
    std::vector<bool> visited_;
    Kit kit_;
};

}  // namespace

Result<Kit> read_glb(std::span<const std::byte> bytes, const GlbReadLimits& limits) {
    auto model = parse_glb(bytes, limits);
    if (!model) {
        return tl::unexpected(std::move(model.error()));
    }
    return KitReader(*model, limits).read();
}

}  // namespace modelsynth
