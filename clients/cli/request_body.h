#pragma once

#include "clients/cli/failure.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::cli {

// A job request as the command line gives it; what is absent is left to the server.
struct RequestOptions {
    std::string request_file;  // the whole request, "-" for standard input; all else is then empty
    std::string solver;        // empty: that of the example or of the job to start from
    std::string example;       // an id, or a file: its name ends in .json or has a slash
    std::string from;          // a finished job to start from; it tells what is not given
    std::string box;           // of the new model, made anew: 0,0,0:8,10,8
    std::string at;            // where the job's model lies in the new one: 10,0,10
    std::string size;          // 40x10x40
    std::optional<std::uint64_t> seed;
    std::optional<std::int64_t> alternatives;
    std::string parameters;  // an object as text, or a file of it
    std::optional<std::int64_t> priority;
    std::optional<double> deadline_seconds;
    std::vector<std::string> tags;  // name=value
};

// The body for POST /v1/jobs. Only what could not be put into a request is refused here; the rest
// is the server's to judge.
// Fails: kWrongUsage.
[[nodiscard]] Outcome<std::string> make_request_body(const RequestOptions& options);

// "40x10x40": cells along x, y and z.
[[nodiscard]] std::optional<std::array<std::uint32_t, 3>> parse_size(std::string_view text);

}  // namespace modelsynth::cli
