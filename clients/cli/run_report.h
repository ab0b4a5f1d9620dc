#pragma once

#include "clients/cli/progress.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace modelsynth::cli {

// What a run made.
struct RunReport {
    struct File {
        std::string name;
        std::uint64_t bytes = 0;
    };

    std::string job_id;       // empty: there was no server
    std::vector<File> files;  // one for each model; none was wanted: empty
    std::uint64_t seed = 0;
    Progress progress;
    std::chrono::seconds elapsed{};
};

// Lines on standard error, or one of JSON on standard output.
void print_report(const RunReport& report, bool as_json);

// A line on standard output, at once.
void print_line(const std::string& line);

}  // namespace modelsynth::cli
