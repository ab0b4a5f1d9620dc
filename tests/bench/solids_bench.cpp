// Continuous synthesis of the built-in examples at about the output sizes of the thesis's
// Table 4.1, on one thread:
//
//   solids_bench [--seeds N] [NAME ...]
//
// Columns: reading the example and preparing the problem, once; then medians over seeds of the time
// to the first block and to the whole model, and of the surface read from it.

#include "solver/continuous/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace modelsynth {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begun) {
    return std::chrono::duration<double>(Clock::now() - begun).count();
}

struct Work {
    const char* name;
    std::array<double, 3> size;  // metres
    const char* thesis;          // polygons and minutes of Table 4.1
};

constexpr std::array kWork = {
    Work{"skyscrapers", {74, 8, 74}, "9 542, 1.8 min"},
    Work{"terrain", {52, 8, 52}, "922, 0.5 min"},
    Work{"fractals", {40, 14, 40}, "5 743, 0.2 min"},
    Work{"arches", {35, 7, 35}, "1 002, 0.5 min"},
    Work{"houses", {30, 8, 30}, "1 908, 1.3 min"},
    Work{"stairs", {40, 12, 40}, ""},
    Work{"pentagons", {38, 5, 38}, "2 004, 1.1 min"},
    Work{"oil_platform", {34, 12, 34}, "1 377, 0.5 min"},
    Work{"domes", {20, 9, 20}, "324, 0.1 min"},
    Work{"buildings", {40, 8, 40}, "2 230, 1.4 min"},
    Work{"spaceships", {46, 12, 46}, "4 164, 0.6 min"},
    Work{"roads", {150, 6, 150}, "6 888, 0.2 min"},
    Work{"plumbing", {32, 14, 32}, "7 422, 0.8 min"},
    Work{"roller_coaster", {30, 12, 30}, "1 376, 1.8 min"},
};

class FirstBlock final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport& report) override {
        if (report.index == 0) {
            after = seconds_since(begun_);
        }
    }

    double after = 0;

  private:
    Clock::time_point begun_ = Clock::now();
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void run(const Work& work, std::uint64_t seeds) {
    auto begun = Clock::now();
    const auto reading = examples::find_solids(work.name);
    const double read = seconds_since(begun);
    continuous::Parameters parameters;
    parameters.size = work.size;
    parameters = fill_defaults(parameters, reading->example());
    begun = Clock::now();
    const auto problem = continuous::make_problem(reading, parameters);
    const double prepared = seconds_since(begun);
    if (!problem) {
        std::fprintf(stderr, "%s: %s\n", work.name, problem.error().message.c_str());
        return;
    }
    std::vector<double> polygons;
    std::vector<double> first;
    std::vector<double> solved;
    std::vector<double> surfaced;
    std::uint32_t accepted = 0;
    std::uint32_t reverted = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        FirstBlock observer;
        begun = Clock::now();
        const auto made = continuous::synthesise(*problem, parameters, seed, observer, {});
        if (!made) {
            std::fprintf(stderr, "%s: %s\n", work.name, made.error().message.c_str());
            return;
        }
        solved.push_back(seconds_since(begun));
        first.push_back(observer.after);
        accepted += made->stats.blocks.accepted();
        reverted += made->stats.blocks.reverted;
        begun = Clock::now();
        const continuous::Surface surface = make_surface(*problem, made->labels);
        surfaced.push_back(seconds_since(begun));
        polygons.push_back(static_cast<double>(surface.polygons.size()));
    }
    std::printf(
        "| %-14s | %3zu | %4zu | %7zu | %5.3f | %5.3f | %7.4f | %6.3f | %6.3f | %6.0f | %5u / %-3u "
        "| "
        "%-14s |\n",
        work.name,
        reading->topes().family_count(),
        reading->figures().count(),
        problem->arrangement.vertex_count(),
        read,
        prepared,
        median(first),
        median(solved),
        median(surfaced),
        median(polygons),
        accepted,
        reverted,
        work.thesis
    );
    std::fflush(stdout);
}

// How the work grows with planes per family, at one example (thesis 4.5.7: n^3).
void run_growth(std::uint64_t seeds) {
    for (const double side : {10.0, 20.0, 40.0}) {
        run({"houses", {side, side / 2, side}, "growth"}, seeds);
    }
}

void run_all(std::uint64_t seeds, const std::vector<std::string>& names) {
    for (const Work& work : kWork) {
        if (names.empty() || std::find(names.begin(), names.end(), work.name) != names.end()) {
            run(work, seeds);
        }
    }
    if (names.empty()) {
        run_growth(seeds);
    }
}

}  // namespace
}  // namespace modelsynth

int main(int argc, char** argv) {
    std::uint64_t seeds = 5;
    std::vector<std::string> names;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--seeds" && i + 1 < argc) {
            seeds = std::max(std::strtoull(argv[++i], nullptr, 10), 1ULL);
        } else {
            names.push_back(argument);
        }
    }
    std::printf(
        "| example        |  m  | figs | vertices| read s| prep s| first s | solve s| surf s | "
        "polyg. | "
        "acc. / rev. | thesis         |\n"
        "|----------------|-----|------|---------|-------|-------|---------|--------|--------|-----"
        "---|"
        "-------------|----------------|\n"
    );
    modelsynth::run_all(seeds, names);
    return 0;
}
