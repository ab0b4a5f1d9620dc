// Times discrete synthesis and prints a table. "first" is the first request for an
// example, a size and a boundary; "median" and "max" are over the seeds after it, which go on from
// what the first one prepared.
//
//   solver_bench [--data DIR] [--seeds N] [--only NAME] [--large yes] [--threads N] [--peer yes]
//
// DIR holds label grids in the example format (castle.json, ...); built-in examples are timed in
// any case. NAME is that of an example as printed in the table.
//
// With --peer, models of 40 by 40 cells are also made by AC-4 with Merrell's schedule (ac4_peer.h),
// warmed up likewise, over the same seeds, or the first few of them where that would take long.
// Its blocks start from our initial models, which cost it nothing. "ratio" is its median over ours
// over those seeds in processor time, which other work on the machine disturbs less; where it found
// no model, the time until it gave up counts. Its "changed" is against those initial models, ours
// 100 % where the initial model was as varied as any.

#include "proto/example_codec.h"
#include "solver/core/block_schedule.h"
#include "solver/discrete/block_solver.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"
#include "tests/bench/ac4_peer.h"
#include "tests/bench/timing.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace discrete = modelsynth::discrete;
using modelsynth::GridSize;
using modelsynth::bench::median;

// Keeps the initial model when there is somebody to keep it for.
class InitialModelKeeper final : public modelsynth::Observer {
  public:
    explicit InitialModelKeeper(bool is_wanted) : is_wanted_(is_wanted) {}

    void on_start(std::uint32_t, std::span<const modelsynth::Label> model) override {
        if (is_wanted_) {
            initial.assign(model.begin(), model.end());
        }
    }

    void on_block(const modelsynth::BlockReport&) override {}

    std::vector<modelsynth::Label> initial;

  private:
    bool is_wanted_;
};

using ExamplePointer = std::shared_ptr<const discrete::Example>;
using Labels = std::vector<modelsynth::Label>;

struct Options {
    std::string data;
    std::string only;
    bool is_large = false;
    int seeds = 20;
    std::uint32_t threads = 1;
    bool has_peer = false;
};

// One row of the table.
struct Row {
    std::string name;
    ExamplePointer example;
    GridSize size;
    bool in_blocks = true;
    int seeds = 1;
};

struct Times {
    double first = 0;
    std::vector<double> milliseconds;            // by seed
    std::vector<double> processor_milliseconds;  // by seed
    std::uint32_t accepted = 0;
    std::uint32_t reverted = 0;
    double changed = 0;
    std::size_t failures = 0;
};

// What a measurement leaves for the peer.
struct Ours {
    Times times;
    std::shared_ptr<discrete::Preparation> preparation;
    std::vector<Labels> initial_models;  // by seed, from -1; empty ones where there are no blocks
};

// Runs `solve` and adds how long it took: to `first` before the first seed.
template <class Solve>
void add_time(Times& times, int seed, Solve solve) {
    const modelsynth::bench::Taken taken = modelsynth::bench::time_of(solve);
    if (seed < 0) {
        times.first = taken.milliseconds;
        return;
    }
    times.milliseconds.push_back(taken.milliseconds);
    times.processor_milliseconds.push_back(taken.processor_milliseconds);
}

// In percent of a model's cells, on average over the models that were made.
double changed_percent(const Times& times) {
    const std::size_t solved = times.milliseconds.size() - times.failures;
    return solved > 0 ? 100 * times.changed / static_cast<double>(solved) : 0.0;
}

Ours measure(const Row& row, std::uint32_t threads, bool has_peer) {
    discrete::Parameters parameters;
    parameters.size = row.size;
    if (!row.in_blocks) {
        parameters.blocks = std::optional<discrete::Blocks>();
    }
    parameters = fill_defaults(parameters, *row.example);
    Ours ours;
    Times& times = ours.times;
    for (int seed = -1; seed < row.seeds; ++seed) {
        InitialModelKeeper keeper(has_peer);
        std::optional<modelsynth::Result<discrete::Synthesis>> model;
        add_time(times, seed, [&] {
            if (ours.preparation == nullptr) {
                ours.preparation = discrete::Preparation::make(row.example, parameters).value();
            }
            model = discrete::synthesise(
                *ours.preparation, static_cast<std::uint64_t>(seed), keeper, {}, nullptr, threads
            );
        });
        ours.initial_models.push_back(std::move(keeper.initial));
        if (seed < 0) {
            continue;
        }
        if (*model) {
            times.accepted += (*model)->stats.blocks.accepted();
            times.reverted += (*model)->stats.blocks.reverted;
            times.changed += (*model)->stats.changed;
        } else {
            ++times.failures;
        }
    }
    return ours;
}

double share_changed(const Labels& labels, const Labels& initial) {
    if (initial.empty()) {
        return 1;
    }
    std::size_t changed = 0;
    for (std::size_t site = 0; site < labels.size(); ++site) {
        changed += std::size_t{labels[site] != initial[site]};
    }
    return static_cast<double>(changed) / static_cast<double>(labels.size());
}

// The same problem by the peer.
Times measure_peer(const Ours& ours) {
    constexpr double kEnoughMs = 20'000;
    constexpr std::size_t kSeedsMin = 3;
    const discrete::Problem& problem = ours.preparation->problem();
    const auto& blocks = *ours.preparation->parameters().blocks;
    std::vector<modelsynth::Box> schedule;
    if (blocks) {
        schedule = schedule_blocks(problem.size, blocks->layout, discrete::kBlockCountMax).value();
    }
    modelsynth::bench::Ac4Peer peer(problem);
    Times times;
    double total_ms = 0;
    for (int seed = -1; seed < static_cast<int>(ours.times.milliseconds.size()); ++seed) {
        const Labels& initial = ours.initial_models[static_cast<std::size_t>(seed + 1)];
        const auto number = static_cast<std::uint64_t>(seed);
        std::optional<modelsynth::bench::PeerModel> model;
        if (blocks && initial.empty()) {
            break;  // ours found no initial model, so there are no blocks
        }
        add_time(times, seed, [&] {
            model = blocks ? peer.in_blocks(schedule, initial, number) : peer.at_once(number);
        });
        total_ms += seed < 0 ? times.first : times.milliseconds.back();
        if (seed < 0) {
            continue;
        }
        if (model) {
            times.accepted += model->accepted;
            times.reverted += model->reverted;
            times.changed += share_changed(model->labels, initial);
        } else {
            ++times.failures;
        }
        if (total_ms > kEnoughMs && times.milliseconds.size() >= kSeedsMin) {
            break;
        }
    }
    return times;
}

void print_header(bool has_peer) {
    std::printf(
        "| example          |   k  | cells          | how    | first ms | median ms |   max ms | "
        "acc. / rev.  | changed | failed |%s\n"
        "|------------------|------|----------------|--------|----------|-----------|----------|-"
        "-------------|---------|--------|%s\n",
        has_peer ? " peer ms  | ratio  | acc. / rev.  | changed | failed   |" : "",
        has_peer ? "----------|--------|--------------|---------|----------|" : ""
    );
}

void print_peer(const Times& peer, const Times& ours) {
    const std::size_t seeds = peer.milliseconds.size();
    if (seeds == 0) {
        std::printf("          |        |              |         |          |");
        return;
    }
    const std::span<const double> same_seeds(ours.processor_milliseconds.data(), seeds);
    std::printf(
        " %8.1f | %6.1f | %5u / %-4u | %5.0f %% | %2zu of %2zu |",
        median(peer.milliseconds),
        median(peer.processor_milliseconds) / median(same_seeds),
        peer.accepted,
        peer.reverted,
        changed_percent(peer),
        peer.failures,
        seeds
    );
}

void print(const Row& row, const Options& options) {
    if (!options.only.empty() && options.only != row.name) {
        return;
    }
    const bool has_peer = options.has_peer && row.size.x <= 40;
    const Ours ours = measure(row, options.threads, has_peer);
    const Times& times = ours.times;
    std::printf(
        "| %-16s | %4zu | %3d x %2d x %3d | %-6s | %8.2f | %9.2f | %8.2f | %5u / %-4u | %5.0f %% | "
        "%zu |",
        row.name.c_str(),
        row.example->pieces.size(),
        row.size.x,
        row.size.y,
        row.size.z,
        row.in_blocks ? "blocks" : "whole",
        times.first,
        median(times.milliseconds),
        *std::max_element(times.milliseconds.begin(), times.milliseconds.end()),
        times.accepted,
        times.reverted,
        changed_percent(times),
        times.failures
    );
    std::fflush(stdout);
    if (options.has_peer) {
        print_peer(has_peer ? measure_peer(ours) : Times(), times);
    }
    std::printf("\n");
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
    const auto* grid = std::get_if<ExamplePointer>(&upload->example);
    return grid == nullptr ? nullptr : *grid;
}

Options parse_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        const std::string value = argv[i + 1];
        if (option == "--data") {
            options.data = value;
        } else if (option == "--seeds") {
            options.seeds = std::max(1, std::atoi(argv[i + 1]));
        } else if (option == "--threads") {
            options.threads = static_cast<std::uint32_t>(std::clamp(std::atoi(argv[i + 1]), 1, 64));
        } else if (option == "--large") {
            options.is_large = true;
        } else if (option == "--only") {
            options.only = value;
        } else if (option == "--peer") {
            options.has_peer = value == "yes";
        }
    }
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    modelsynth::bench::keep_freed_memory();
    const Options options = parse_options(argc, argv);
    const int few_seeds = std::min(options.seeds, 5);
    print_header(options.has_peer);
    for (const auto& example : modelsynth::examples::built_in()) {
        const std::int32_t y = example->default_size.y;
        print({example->name, example, {40, y, 40}, true, options.seeds}, options);
        print({example->name, example, {40, y, 40}, false, few_seeds}, options);
        print({example->name, example, {100, y, 100}, true, few_seeds}, options);
    }
    for (const char* name : {"castle", "city", "canyon", "escheresque", "simple"}) {
        const std::string label = std::string(name) + ".json";
        const auto path = std::filesystem::path(options.data) / label;
        if (options.data.empty() || !std::filesystem::exists(path)) {
            continue;
        }
        const auto example = load(path);
        if (!example) {
            return 1;
        }
        print({label, example, {40, 10, 40}, true, options.seeds}, options);
        print({label, example, {40, 10, 40}, false, options.seeds}, options);
        print({label, example, {100, 10, 100}, true, few_seeds}, options);
        if (options.is_large) {
            print({label, example, {1000, 10, 1000}, true, 1}, options);
        }
    }
    return 0;
}
