// Times discrete synthesis and prints a table. "first" is the first request for an
// example, a size and a boundary; "median" and "max" are over the seeds after it, which go on from
// what the first one prepared.
//
//   solver_bench [--data DIR] [--seeds N] [--only NAME] [--large yes] [--threads N]
//
// DIR holds label grids in the example format (castle.json, ...); built-in examples are timed in
// any case. NAME is that of an example as printed in the table.

#include "proto/example_codec.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

namespace discrete = modelsynth::discrete;
using modelsynth::GridSize;

class Silent final : public modelsynth::Observer {
  public:
    void on_start(std::uint32_t, std::span<const modelsynth::Label>) override {}

    void on_block(const modelsynth::BlockReport&) override {}
};

std::uint32_t threads = 1;

struct Times {
    double first = 0;
    std::vector<double> milliseconds;
    std::uint32_t accepted = 0;
    std::uint32_t reverted = 0;
    double changed = 0;
    std::size_t failures = 0;
};

using ExamplePointer = std::shared_ptr<const discrete::Example>;

Times measure(const ExamplePointer& example, const GridSize& size, bool in_blocks, int seeds) {
    discrete::Parameters parameters;
    parameters.size = size;
    if (!in_blocks) {
        parameters.blocks = std::optional<discrete::Blocks>();
    }
    parameters = fill_defaults(parameters, *example);
    Times times;
    std::shared_ptr<discrete::Preparation> preparation;
    for (int seed = -1; seed < seeds; ++seed) {
        Silent observer;
        const auto begun = std::chrono::steady_clock::now();
        if (preparation == nullptr) {
            preparation = discrete::Preparation::make(example, parameters).value();
        }
        const auto model = discrete::synthesise(
            *preparation, static_cast<std::uint64_t>(seed), observer, {}, nullptr, threads
        );
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - begun;
        if (seed < 0) {
            times.first = taken.count();
            continue;
        }
        times.milliseconds.push_back(taken.count());
        if (model) {
            times.accepted += model->stats.blocks.accepted();
            times.reverted += model->stats.blocks.reverted;
            times.changed += model->stats.changed;
        } else {
            ++times.failures;
        }
    }
    std::sort(times.milliseconds.begin(), times.milliseconds.end());
    return times;
}

void print(
    const char* name, const ExamplePointer& example, const GridSize& size, bool in_blocks, int seeds
) {
    const Times times = measure(example, size, in_blocks, seeds);
    const double solved = static_cast<double>(static_cast<std::size_t>(seeds) - times.failures);
    std::printf(
        "| %-16s | %4zu | %3d x %2d x %3d | %-6s | %8.2f | %9.2f | %8.2f | %5u / %-4u | %5.0f %% | "
        "%zu |\n",
        name,
        example->pieces.size(),
        size.x,
        size.y,
        size.z,
        in_blocks ? "blocks" : "whole",
        times.first,
        times.milliseconds[times.milliseconds.size() / 2],
        times.milliseconds.back(),
        times.accepted,
        times.reverted,
        solved > 0 ? 100 * times.changed / solved : 0.0,
        times.failures
    );
    std::fflush(stdout);
}

ExamplePointer load(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const auto upload = modelsynth::proto::parse_example(text, {});
    if (!upload) {
        std::fprintf(stderr, "%s: %s\n", path.c_str(), upload.error().detail.c_str());
        return nullptr;
    }
    return upload->example;
}

}  // namespace

int main(int argc, char** argv) {
    std::string data;
    std::string only;
    bool is_large = false;
    int seeds = 20;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        if (option == "--data") {
            data = argv[i + 1];
        } else if (option == "--seeds") {
            seeds = std::max(1, std::atoi(argv[i + 1]));
        } else if (option == "--threads") {
            threads = static_cast<std::uint32_t>(std::clamp(std::atoi(argv[i + 1]), 1, 64));
        } else if (option == "--large") {
            is_large = true;
        } else if (option == "--only") {
            only = argv[i + 1];
        }
    }
    std::printf(
        "| example          |   k  | cells          | how    | first ms | median ms |   max ms | "
        "acc. / rev.  | changed | failed |\n"
        "|------------------|------|----------------|--------|----------|-----------|----------|-"
        "-------------|---------|--------|\n"
    );
    for (const auto& example : modelsynth::examples::built_in()) {
        if (!only.empty() && only != example->name) {
            continue;
        }
        const std::int32_t y = example->default_size.y;
        print(example->name.c_str(), example, {40, y, 40}, true, seeds);
        print(example->name.c_str(), example, {40, y, 40}, false, std::min(seeds, 5));
        print(example->name.c_str(), example, {100, y, 100}, true, std::min(seeds, 5));
    }
    for (const char* name : {"castle", "city", "canyon", "escheresque", "simple"}) {
        const auto path = std::filesystem::path(data) / (std::string(name) + ".json");
        const std::string label = std::string(name) + ".json";
        if (data.empty() || !std::filesystem::exists(path) || (!only.empty() && only != label)) {
            continue;
        }
        const auto example = load(path);
        if (!example) {
            return 1;
        }
        print(label.c_str(), example, {40, 10, 40}, true, seeds);
        print(label.c_str(), example, {40, 10, 40}, false, seeds);
        print(label.c_str(), example, {100, 10, 100}, true, std::min(seeds, 5));
        if (is_large) {
            print(label.c_str(), example, {1000, 10, 1000}, true, 1);
        }
    }
    return 0;
}
