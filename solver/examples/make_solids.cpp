#include "solver/examples/make_solids.h"

#include "solver/continuous/scene.h"
#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/mesh/glb_writer.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>

namespace modelsynth::examples {

namespace {

using continuous::ExampleReading;

class Silent final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport&) override {}
};

void write_file(const std::string& path, const Scene& scene) {
    const auto glb = write_glb(scene, {GlbProfile::kMerged});
    if (!glb) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), glb.error().message.c_str());
        std::exit(1);
    }
    std::ofstream(path, std::ios::binary) << *glb;
    std::printf("%s: %zu bytes\n", path.c_str(), glb->size());
}

void describe(const ExampleReading& reading) {
    std::size_t faces = 0;
    for (const continuous::Polyhedron& solid : reading.example().polyhedra) {
        faces += solid.faces.size();
    }
    std::printf(
        "%s: %zu polygons, %zu families, %zu figures\n",
        reading.example().name.c_str(),
        faces,
        reading.topes().family_count(),
        reading.figures().count()
    );
}

void describe(const continuous::Problem& problem) {
    std::printf("%zu vertices; spacings", problem.arrangement.vertex_count());
    for (const double spacing : problem.spacings.of_family) {
        std::printf(" %.4f", spacing);
    }
    std::printf("; %zu figures have no place\n", problem.homeless.size());
    for (const std::string& conflict : problem.spacings.conflicts) {
        std::printf("conflict: %s\n", conflict.c_str());
    }
}

void synthesise(
    const ExampleReading& reading,
    const continuous::Problem& problem,
    const continuous::Parameters& parameters,
    std::uint64_t seed,
    const std::string& directory
) {
    Silent observer;
    const std::clock_t begun = std::clock();
    const auto made = continuous::synthesise(problem, parameters, seed, observer, {});
    if (!made) {
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
        std::exit(1);
    }
    const double took = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    const continuous::Surface surface = make_surface(problem, made->labels);
    std::printf(
        "seed %llu: %zu polygons in %.3f s, %u blocks accepted, %u reverted, %.0f %% changed\n",
        static_cast<unsigned long long>(seed),
        surface.polygons.size(),
        took,
        made->stats.blocks.accepted(),
        made->stats.blocks.reverted,
        100 * made->stats.changed
    );
    write_file(
        directory + "/" + reading.example().name + "." + std::to_string(seed) + ".glb",
        make_scene(reading, surface)
    );
}

}  // namespace

void show_solids(
    const std::string& directory, const std::string& name, const std::string& size, int seeds
) {
    for (const auto& reading : built_in_solids()) {
        const continuous::Example& example = reading->example();
        if (!name.empty() && example.name != name) {
            continue;
        }
        describe(*reading);
        write_file(directory + "/" + example.name + ".glb", make_example_scene(*reading));
        std::array<double, 3> metres = {};
        if (std::sscanf(size.c_str(), "%lfx%lfx%lf", metres.data(), &metres[1], &metres[2]) != 3) {
            continue;
        }
        continuous::Parameters asked_for;
        asked_for.size = metres;
        const continuous::Parameters parameters = fill_defaults(asked_for, example);
        const auto problem = continuous::make_problem(reading, parameters);
        if (!problem) {
            std::fprintf(stderr, "%s\n", problem.error().message.c_str());
            std::exit(1);
        }
        describe(*problem);
        for (int seed = 1; seed <= seeds; ++seed) {
            synthesise(*reading, *problem, parameters, static_cast<std::uint64_t>(seed), directory);
        }
    }
}

}  // namespace modelsynth::examples
