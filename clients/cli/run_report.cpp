#include "clients/cli/run_report.h"

#include "clients/cli/failure.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace modelsynth::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string report_json(const RunReport& report) {
    const Json json = {
        {"job", report.job_id.empty() ? Json() : Json(report.job_id)},
        {"file", report.file},
        {"bytes", report.bytes},
        {"seed", report.seed},
        {"blocks_accepted", report.progress.accepted},
        {"blocks_reverted", report.progress.reverted}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void print_report(const RunReport& report, bool as_json) {
    if (as_json) {
        print_line(report_json(report));
        return;
    }
    const std::string file = report.file == "-" ? "standard output" : report.file;
    const std::string line = file + ": " + std::to_string(report.bytes) + " bytes, " +
                             describe_blocks(report.progress) + ", seed " +
                             std::to_string(report.seed) + ", " + describe_time(report.elapsed);
    std::fprintf(stderr, "%s\n", printable(line).c_str());
}

void print_line(const std::string& line) {
    std::fwrite(line.data(), 1, line.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
}

}  // namespace modelsynth::cli
