#pragma once

#include "clients/cli/catalog_commands.h"
#include "clients/cli/job_commands.h"
#include "clients/cli/run_options.h"

#include <optional>
#include <string>
#include <variant>

namespace modelsynth::cli {

struct ExamplesOptions {};

struct CancelOptions {
    std::string job_id;
};

struct DeleteOptions {
    std::string job_id;
};

struct UploadOptions {
    std::string path;
};

// A command line, read.
struct Invocation {
    std::string server = "http://127.0.0.1:8080";
    std::string key;      // sent as a bearer token; empty: none
    std::string ca_file;  // of the roots that https is trusted by; empty: the system's
    bool as_json = false;
    std::variant<
        ExamplesOptions,
        SubmitOptions,
        FollowOptions,
        FetchOptions,
        ListOptions,
        CancelOptions,
        DeleteOptions,
        UploadOptions,
        RunOptions>
        command;
};

// Reads the command line, and $MODELSYNTH_SERVER and $MODELSYNTH_KEY where it names none.
// The error is the exit code of a program that is done: help was asked for, or the usage is wrong;
// either has been printed then.
[[nodiscard]] tl::expected<Invocation, ExitCode> read_command_line(
    int argument_count, const char* const* arguments
);

}  // namespace modelsynth::cli
