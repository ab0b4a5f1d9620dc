// Writes each built-in example to files to look at: NAME.glb (the example), NAME.pieces.glb (its
// kit as a sheet, where it has one) and, when a size is given, NAME.SEED.glb (a synthesis), with a
// count of labels. Sizes are in cells or, for examples made of solids, metres.
//
//   modelsynth-examples DIR [NAME [XxYxZ [SEEDS]]]

#include "solver/discrete/scene.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "solver/examples/make_solids.h"
#include "solver/mesh/glb_writer.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using modelsynth::Box;
using modelsynth::GridSize;
using modelsynth::Label;
using modelsynth::discrete::Example;

class Silent final : public modelsynth::Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const modelsynth::BlockReport&) override {}
};

void write_file(const std::string& path, const modelsynth::Scene& scene, bool named_nodes = false) {
    modelsynth::GlbOptions options;
    options.named_nodes = named_nodes;
    const auto glb = modelsynth::write_glb(scene, options);
    if (!glb) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), glb.error().message.c_str());
        std::exit(1);
    }
    std::ofstream(path, std::ios::binary) << *glb;
    std::printf("%s: %zu bytes\n", path.c_str(), glb->size());
}

// How well the example teaches: labels that stand once, and triangles of the kit.
void describe(const Example& example) {
    std::map<Label, std::size_t> counts;
    for (const Label label : example.cells) {
        ++counts[label];
    }
    std::size_t singles = 0;
    std::string unused;
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        const std::size_t count = counts[static_cast<Label>(label)];
        singles += std::size_t{count == 1};
        unused += count == 0 ? " " + example.pieces[label].name : "";
    }
    std::size_t triangles = 0;
    for (const auto& mesh : example.kit->meshes) {
        for (const auto& primitive : mesh.primitives) {
            triangles += primitive.indices.size() / 3;
        }
    }
    std::printf(
        "%s: %zu labels, %zu stand once, %zu triangles, %d x %d x %d cells; unused:%s\n",
        example.name.c_str(),
        example.pieces.size(),
        singles,
        triangles,
        example.size.x,
        example.size.y,
        example.size.z,
        unused.empty() ? " none" : unused.c_str()
    );
}

void synthesise(
    const Example& example, const GridSize& size, std::uint64_t seed, const std::string& directory
) {
    modelsynth::discrete::Parameters parameters;
    parameters.size = size;
    Silent observer;
    const auto model = modelsynth::discrete::synthesise(
        example, fill_defaults(parameters, example), seed, observer, {}
    );
    if (!model) {
        std::fprintf(stderr, "%s\n", model.error().message.c_str());
        std::exit(1);
    }
    std::set<Label> present(model->labels.begin(), model->labels.end());
    std::size_t air = 0;
    for (const Label label : model->labels) {
        air += std::size_t{example.empty == label};
    }
    std::printf(
        "seed %llu: %u blocks accepted, %u reverted, %.0f %% changed, %zu of %zu labels, %.0f %% "
        "air\n",
        static_cast<unsigned long long>(seed),
        model->stats.blocks.accepted(),
        model->stats.blocks.reverted,
        100 * model->stats.changed,
        present.size(),
        example.pieces.size(),
        100.0 * static_cast<double>(air) / static_cast<double>(model->labels.size())
    );
    write_file(
        directory + "/" + example.name + "." + std::to_string(seed) + ".glb",
        make_scene(example, size, model->labels, Box::whole(size))
    );
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') {
        std::fprintf(stderr, "usage: modelsynth-examples DIR [NAME [XxYxZ [SEEDS]]]\n");
        return 2;
    }
    const std::string directory = argv[1];
    for (const auto& example : modelsynth::examples::built_in()) {
        if (argc > 2 && example->name != argv[2]) {
            continue;
        }
        describe(*example);
        write_file(
            directory + "/" + example->name + ".glb",
            make_scene(*example, example->size, example->cells, Box::whole(example->size))
        );
        write_file(
            directory + "/" + example->name + ".pieces.glb", make_piece_sheet(*example), true
        );
        GridSize size;
        if (argc > 3 && std::sscanf(argv[3], "%dx%dx%d", &size.x, &size.y, &size.z) == 3) {
            const int seeds = argc > 4 ? std::atoi(argv[4]) : 1;
            for (int seed = 1; seed <= seeds; ++seed) {
                synthesise(*example, size, static_cast<std::uint64_t>(seed), directory);
            }
        }
    }
    modelsynth::examples::show_solids(
        directory,
        argc > 2 ? argv[2] : "",
        argc > 3 ? argv[3] : "",
        argc > 4 ? std::atoi(argv[4]) : 1
    );
    return 0;
}
