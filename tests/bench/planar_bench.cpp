// Times synthesis in the plane and prints a table: sets of square tiles on 100 x 100 cells, whole
// by every order and in blocks, and overlapping patterns of small images on 48 x 48.
//
//   planar_bench [--seeds N] [--only NAME] [--how HOW] [--peer no]
//
// NAME and HOW as printed in the table.
//
// "median" and "max" are over the seeds, after a first model that prepares what they have in
// common. "attempts" is the mean at a block, or at the whole; "failed" counts whole models that
// were given up, "rev." blocks.
//
// Beside it AC-4 with weighted entropy that starts anew after every contradiction (ac4_peer.h), at
// most 10 times: the usual way of wave function collapse, on the same problem and seeds. "ratio" is
// its median over ours; where it found no model, the time until it gave up counts.
//
// Rows that take long end after fewer seeds.

#include "solver/discrete/synthesis.h"
#include "tests/bench/ac4_peer.h"
#include "tests/bench/planar_problems.h"
#include "tests/bench/timing.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

namespace discrete = modelsynth::discrete;
namespace bench = modelsynth::bench;
using ExamplePointer = std::shared_ptr<const discrete::Example>;
using modelsynth::Order;
using modelsynth::bench::median;

constexpr double kEnoughMs = 10'000;  // for one row
constexpr std::uint32_t kPeerAttempts = 10;

struct Options {
    std::string only;
    std::string how;
    int seeds = 20;
    bool has_peer = true;
};

struct Row {
    ExamplePointer example;
    std::int32_t side = 0;
    Order order = Order::kScan;
    bool in_blocks = false;
};

struct Times {
    std::vector<double> milliseconds;  // by seed
    double total_ms = 0;
    std::size_t failures = 0;
    // Of all blocks; a whole model is one.
    std::uint64_t blocks = 0;
    std::uint64_t attempts = 0;
    std::uint64_t reverted = 0;
};

class AttemptCounter final : public modelsynth::Observer {
  public:
    explicit AttemptCounter(Times& times) : times_(times) {}

    void on_start(std::uint32_t, std::span<const modelsynth::Label>) override {}

    void on_block(const modelsynth::BlockReport& report) override {
        ++times_.blocks;
        times_.attempts += report.attempts;
        times_.reverted += std::size_t{!report.accepted};
    }

  private:
    Times& times_;
};

std::shared_ptr<discrete::Preparation> prepare(const Row& row) {
    discrete::Parameters parameters;
    parameters.size = modelsynth::GridSize{row.side, 1, row.side};
    parameters.order.order = row.order;
    // Patterns and tiles have weights of their own.
    parameters.weights = discrete::WeightRule::kUniform;
    if (!row.in_blocks) {
        parameters.blocks = std::optional<discrete::Blocks>();
    }
    parameters = fill_defaults(parameters, *row.example);
    return discrete::Preparation::make(row.example, parameters).value();
}

// Calls solve(seed, times), which says whether there was a model, for a first seed that does not
// count and then for the others.
template <class Solve>
Times measure(int seeds, Solve solve) {
    Times times;
    Times unused;
    solve(~std::uint64_t{0}, unused);
    for (int seed = 0; seed < seeds && times.total_ms < kEnoughMs; ++seed) {
        const bench::Taken taken = bench::time_of([&] {
            times.failures += std::size_t{!solve(static_cast<std::uint64_t>(seed), times)};
        });
        times.milliseconds.push_back(taken.processor_milliseconds);
        times.total_ms += taken.processor_milliseconds;
    }
    return times;
}

Times measure_ours(const Row& row, int seeds) {
    const auto preparation = prepare(row);
    return measure(seeds, [&](std::uint64_t seed, Times& times) {
        AttemptCounter counter(times);
        const bool solved = synthesise(*preparation, seed, counter, {}).has_value();
        if (!solved && !row.in_blocks) {
            ++times.blocks;
            times.attempts += discrete::kWholeAttempts;
        }
        return solved;
    });
}

Times measure_peer(const Row& row, int seeds) {
    const auto preparation = prepare(row);
    bench::Ac4Peer peer(preparation->problem(), {Order::kMinEntropy, kPeerAttempts});
    return measure(seeds, [&](std::uint64_t seed, Times& times) {
        const auto model = peer.at_once(seed);
        ++times.blocks;
        times.attempts += model ? model->attempts : kPeerAttempts;
        return model.has_value();
    });
}

void print_header(bool has_peer) {
    std::printf(
        "| problem    |   k  | cells     | how         | median ms |   max ms | attempts | rev. | "
        "failed   |%s\n"
        "|------------|------|-----------|-------------|-----------|----------|----------|------|-"
        "---------|%s\n",
        has_peer ? " peer ms  | ratio  | attempts | failed   |" : "",
        has_peer ? "----------|--------|----------|----------|" : ""
    );
}

double mean_attempts(const Times& times) {
    return static_cast<double>(times.attempts) /
           static_cast<double>(std::max<std::uint64_t>(1, times.blocks));
}

const char* name_of(const Row& row) {
    if (row.in_blocks) {
        return "blocks";
    }
    switch (row.order) {
        case Order::kScan:
            return "scan";
        case Order::kMinEntropy:
            return "min_entropy";
        case Order::kRandom:
            return "random";
        case Order::kFewestLabels:
            return "fewest_labels";
        case Order::kGrowth:
            return "growth";
    }
    return "";
}

void print(const Row& row, const Times& times, const std::optional<Times>& peer) {
    std::printf(
        "| %-10s | %4zu | %3d x %3d | %-11s | %9.2f | %8.2f | %8.2f | %4zu | %2zu of %2zu |",
        row.example->name.c_str(),
        row.example->pieces.size(),
        row.side,
        row.side,
        name_of(row),
        median(times.milliseconds),
        *std::max_element(times.milliseconds.begin(), times.milliseconds.end()),
        mean_attempts(times),
        static_cast<std::size_t>(times.reverted),
        times.failures,
        times.milliseconds.size()
    );
    if (peer) {
        std::printf(
            " %8.1f | %6.1f | %8.2f | %2zu of %2zu |",
            median(peer->milliseconds),
            median(peer->milliseconds) / median(times.milliseconds),
            mean_attempts(*peer),
            peer->failures,
            peer->milliseconds.size()
        );
    }
    std::printf("\n");
    std::fflush(stdout);
}

// The rows of one problem, which have the peer in common.
void measure_and_print(const std::vector<Row>& rows, const Options& options) {
    if (!options.only.empty() && options.only != rows.front().example->name) {
        return;
    }
    std::optional<Times> peer;
    if (options.has_peer) {
        peer = measure_peer(rows.front(), options.seeds);
    }
    for (const Row& row : rows) {
        if (options.how.empty() || options.how == name_of(row)) {
            print(row, measure_ours(row, options.seeds), peer);
        }
    }
}

Options parse_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        const std::string value = argv[i + 1];
        if (option == "--seeds") {
            options.seeds = std::max(1, std::atoi(argv[i + 1]));
        } else if (option == "--only") {
            options.only = value;
        } else if (option == "--how") {
            options.how = value;
        } else if (option == "--peer") {
            options.has_peer = value != "no";
        }
    }
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    modelsynth::bench::keep_freed_memory();
    constexpr std::int32_t kTilesSide = 100;
    constexpr std::int32_t kPatternsSide = 48;
    const Options options = parse_options(argc, argv);
    print_header(options.has_peer);
    for (const auto& example : bench::make_planar_tilesets()) {
        measure_and_print(
            {{example, kTilesSide, Order::kScan},
             {example, kTilesSide, Order::kMinEntropy},
             {example, kTilesSide, Order::kRandom},
             {example, kTilesSide, Order::kScan, true}},
            options
        );
    }
    for (const bench::PlanarSample& sample : bench::make_planar_samples()) {
        const auto example = std::make_shared<const discrete::Example>(
            make_pattern_example(sample.name, find_patterns(sample.image, sample.options))
        );
        measure_and_print(
            {{example, kPatternsSide, Order::kMinEntropy}, {example, kPatternsSide, Order::kScan}},
            options
        );
    }
    return 0;
}
