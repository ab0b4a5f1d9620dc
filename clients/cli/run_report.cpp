#include "clients/cli/run_report.h"

#include "clients/cli/failure.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace modelsynth::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string report_json(const RunReport& report) {
    const RunReport::File& first = report.files.front();
    Json json = {
        {"job", report.job_id.empty() ? Json() : Json(report.job_id)},
        {"file", first.name},
        {"bytes", first.bytes},
        {"seed", report.seed},
        {"blocks_accepted", report.progress.accepted},
        {"blocks_reverted", report.progress.reverted}};
    if (report.files.size() > 1) {
        Json files = Json::array();
        for (const RunReport::File& file : report.files) {
            files.push_back({{"file", file.name}, {"bytes", file.bytes}});
        }
        json["alternatives"] = std::move(files);
    }
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void print_report(const RunReport& report, bool as_json) {
    if (as_json) {
        print_line(report_json(report));
        return;
    }
    const std::string summary = ", " + describe_blocks(report.progress) + ", seed " +
                                std::to_string(report.seed) + ", " + describe_time(report.elapsed);
    for (const RunReport::File& file : report.files) {
        const std::string line = (file.name == "-" ? "standard output" : file.name) + ": " +
                                 std::to_string(file.bytes) + " bytes" +
                                 (&file == &report.files.back() ? summary : "");
        std::fprintf(stderr, "%s\n", printable(line).c_str());
    }
}

void print_line(const std::string& line) {
    std::fwrite(line.data(), 1, line.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
}

}  // namespace modelsynth::cli
