#include "clients/cli/catalog_commands.h"
#include "clients/cli/command_line.h"
#include "clients/cli/interrupt.h"
#include "clients/cli/job_commands.h"
#include "clients/cli/run_local.h"
#include "clients/cli/server_url.h"

#include <cstdio>
#include <exception>
#include <variant>

namespace {

using namespace modelsynth::cli;

// Carries out a command that asks a server.
struct AskServer {
    const HttpClient& client;
    bool as_json;

    Outcome<void> operator()(const SubmitOptions& options) const {
        return submit(client, options, as_json);
    }

    Outcome<void> operator()(const FollowOptions& options) const {
        return follow(client, options, as_json);
    }

    Outcome<void> operator()(const FetchOptions& options) const {
        return fetch(client, options, as_json);
    }

    Outcome<void> operator()(const RunOptions& options) const {
        return run_on_server(client, options, as_json);
    }

    Outcome<void> operator()(const ListOptions& options) const {
        return list_jobs(client, options, as_json);
    }

    Outcome<void> operator()(const ExamplesOptions& /*options*/) const {
        return list_examples(client, as_json);
    }

    Outcome<void> operator()(const CancelOptions& options) const {
        return cancel_job(client, options.job_id, as_json);
    }

    Outcome<void> operator()(const DeleteOptions& options) const {
        return delete_job(client, options.job_id, as_json);
    }

    Outcome<void> operator()(const UploadOptions& options) const {
        return upload_example(client, options.path, as_json);
    }
};

Outcome<void> carry_out(const Invocation& invocation) {
    const auto* const run = std::get_if<RunOptions>(&invocation.command);
    if (run != nullptr && run->is_local) {
        return run_local(*run, invocation.as_json);
    }
    return parse_server_url(invocation.server).and_then([&invocation](const ServerUrl& server) {
        const HttpClient client(server, invocation.key, invocation.ca_file);
        return std::visit(AskServer{client, invocation.as_json}, invocation.command);
    });
}

Outcome<void> carry_out_or_catch(Invocation invocation) {
    try {
        const auto complete = [](auto& options) {
            if constexpr (requires { options.request; }) {
                complete_request(options.request);
            }
        };
        std::visit(complete, invocation.command);
        return carry_out(invocation);
    } catch (const std::exception& error) {
        return tl::unexpected(Failure{ExitCode::kFailed, error.what()});
    }
}

}  // namespace

int main(int argument_count, char** arguments) {
    const auto invocation = read_command_line(argument_count, arguments);
    if (!invocation) {
        return static_cast<int>(invocation.error());
    }
    catch_interrupts();
    auto outcome = carry_out_or_catch(*invocation);
    if (outcome && std::ferror(stdout) != 0) {
        outcome = tl::unexpected(Failure{ExitCode::kFailed, "cannot write standard output"});
    }
    if (outcome) {
        return static_cast<int>(ExitCode::kDone);
    }
    std::fputs(describe(outcome.error(), invocation->as_json).c_str(), stderr);
    return static_cast<int>(outcome.error().code);
}
