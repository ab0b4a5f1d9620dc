#pragma once

#include <tl/expected.hpp>

#include <string>

namespace modelsynth::cli {

// How a command ended; the numbers are promised to scripts.
enum class ExitCode : int {
    kDone = 0,
    kFailed = 1,       // the job failed or was cancelled, or the server answered a problem
    kWrongUsage = 2,   // the command line or a file it names cannot be used
    kUnreachable = 3,  // no server, or the connection broke
    kInterrupted = 130,
};

// Why a command did not do what it was asked for.
struct Failure {
    ExitCode code = ExitCode::kFailed;
    std::string message;       // one sentence for a person
    std::string problem = {};  // the problem document as JSON text, where the server gave one
    int status = 0;            // of the HTTP answer; 0: there was none
    bool is_idle = false;      // the server kept the connection but sent nothing for too long
};

template <class T>
using Outcome = tl::expected<T, Failure>;

[[nodiscard]] tl::unexpected<Failure> wrong_usage(std::string message);

// The failure that an answer outside 2xx means. Bodies that are no problem document will do.
[[nodiscard]] Failure failure_of_answer(int status, const std::string& body);

// The failure that the problem document of a failed job means.
[[nodiscard]] Failure failure_of_problem(std::string problem);

// What is shown of a failure: a line for a person and, indented, one for each entry of `errors`;
// or, for programs, one line of JSON that is a problem document in any case.
[[nodiscard]] std::string describe(const Failure& failure, bool as_json);

// The text with control characters replaced, so that no answer can steer the terminal.
[[nodiscard]] std::string printable(std::string text);

}  // namespace modelsynth::cli
