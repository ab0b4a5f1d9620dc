// Continuous synthesis of the built-in examples at about the output sizes of the thesis's
// Table 4.1, on one thread:
//
//   solids_bench [--seeds N] [NAME ...]
//
// Columns: reading the example and preparing the problem, once; then medians over seeds of the time
// to the first block and to the whole model, and of the surface read from it. Without names also
// one of 100 000 polygons, with the peak of memory, and how the work grows with planes and
// directions.

#include "solver/continuous/surface/surface.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "tests/bench/timing.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth {
namespace {

using modelsynth::bench::median;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begun) {
    return std::chrono::duration<double>(Clock::now() - begun).count();
}

struct Work {
    const char* name;
    std::array<double, 3> size;    // metres
    const char* thesis;            // polygons and minutes of Table 4.1
    std::uint32_t components = 1;  // of what hangs together; 0: it need not
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
    Work{"spaceships", {46, 12, 46}, ""},
    Work{"spaceships", {46, 12, 46}, "", 40},
    Work{"spaceships", {48, 12, 48}, "4 164, 0.6 min", 0},
    Work{"roads", {150, 6, 150}, "6 888, 0.2 min"},
    Work{"plumbing", {32, 14, 32}, "7 422, 0.8 min"},
    Work{"letters", {176, 14, 64}, "7 527, 3.5 min"},
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

void run(const Work& work, std::uint64_t seeds) {
    auto begun = Clock::now();
    const auto reading = examples::find_solids(work.name);
    const double read = seconds_since(begun);
    continuous::Parameters parameters;
    parameters.size = work.size;
    parameters = fill_defaults(parameters, reading->example());
    for (continuous::Constraint& constraint : *parameters.constraints) {
        if (auto* connected = std::get_if<continuous::ConnectedRule>(&constraint.rule)) {
            connected->components = std::max(work.components, 1U);
            if (work.components == 0) {
                constraint.objects.clear();
            }
        }
    }
    std::string name = work.name;
    if (work.components != 1) {
        name += work.components == 0 ? ", any" : ", " + std::to_string(work.components);
    }
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
        name.c_str(),
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

// Towers of a plan with so many equal sides, wide and narrow ones.
std::shared_ptr<const continuous::ExampleReading> read_towers(int sides) {
    continuous::Example example;
    example.name = "towers";
    example.materials = {{"grass", {}}, {"stone", {}}};
    example.objects = {{"grass", 0}, {"stone", 1}};
    example.ground = 1;
    for (const auto& [radius, at, height] :
         {std::array{2.0, 0.0, 3.0}, std::array{3.5, 12.0, 2.0}}) {
        examples::Outline outline;
        for (int i = 0; i < sides; ++i) {
            const double angle = std::numbers::pi * (2 * i + 1) / sides;
            outline.push_back({at + radius * std::cos(angle), radius * std::sin(angle)});
        }
        example.polyhedra.push_back(examples::prism_upwards(2, outline, 0, height));
    }
    example.density = 0.5;
    return continuous::ExampleReading::make(std::move(example)).value();
}

struct Growth {
    double cubed;  // of what grows
    double vertices = 0;
    double seconds = 0;
};

Growth grow(int sides, double extent, std::uint64_t seeds, double what_grows) {
    const auto reading = read_towers(sides);
    continuous::Parameters parameters;
    parameters.size = {extent, extent, extent};
    parameters = fill_defaults(parameters, reading->example());
    const auto problem = continuous::make_problem(reading, parameters);
    Growth growth = {what_grows * what_grows * what_grows};
    if (!problem) {
        return growth;
    }
    std::vector<double> solved;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        FirstBlock observer;
        const auto begun = Clock::now();
        if (continuous::synthesise(*problem, parameters, seed, observer, {})) {
            solved.push_back(seconds_since(begun));
        }
    }
    growth.vertices = static_cast<double>(problem->arrangement.vertex_count());
    growth.seconds = solved.empty() ? 0 : median(solved);
    return growth;
}

// A bar twice as long for twice the share of the cube; all are as long as the first where the work
// grows with the cube.
void print_growth(const char* what, double value, const Growth& growth, const Growth& first) {
    const double share = growth.seconds / growth.cubed / (first.seconds / first.cubed);
    const auto length = static_cast<int>(std::clamp(std::lround(20 * share), 0L, 60L));
    std::printf(
        "| %s %4.0f | %8.0f | %7.4f | %5.2f | %-60s |\n",
        what,
        value,
        growth.vertices,
        growth.seconds,
        share,
        std::string(static_cast<std::size_t>(length), '#').c_str()
    );
    std::fflush(stdout);
}

// How the work grows with planes per family, n, and with families, m (thesis 4.5.7: m^3 n^3).
void run_growth(std::uint64_t seeds) {
    std::printf(
        "\n| towers | vertices | solve s | share | seconds by the cube of n, at m = 5; of m, at n "
        "= 12 "
        "%13s|\n|--------|----------|---------|-------|-%s-|\n",
        "",
        std::string(60, '-').c_str()
    );
    const auto first_n = grow(8, 12, seeds, 12);
    for (const double n : {12.0, 16.0, 24.0, 32.0, 48.0}) {
        print_growth("n", n, grow(8, n, seeds, n), first_n);
    }
    const auto first_m = grow(4, 12, seeds, 3);
    for (const int sides : {4, 6, 8, 12}) {
        const double m = sides / 2 + 1;
        print_growth("m", m, grow(sides, 12, seeds, m), first_m);
    }
}

void run_large() {
    run({"skyscrapers", {240, 8, 240}, "100 000 polyg."}, 1);
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("\npeak memory after all of these: %ld MB\n", usage.ru_maxrss / 1024);
}

void run_all(std::uint64_t seeds, const std::vector<std::string>& names) {
    for (const Work& work : kWork) {
        if (names.empty() || std::find(names.begin(), names.end(), work.name) != names.end()) {
            run(work, seeds);
        }
    }
    if (names.empty()) {
        run_large();
        run_growth(seeds);
    }
}

}  // namespace
}  // namespace modelsynth

int main(int argc, char** argv) {
    modelsynth::bench::keep_freed_memory();
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
