#include "clients/cli/command_line.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>
#include <utility>

namespace modelsynth::cli {

namespace {

constexpr const char* kFooter =
    "\nExit codes:\n"
    "  0    done\n"
    "  1    the job failed or was cancelled, or the server answered a problem\n"
    "  2    wrong usage\n"
    "  3    the server cannot be reached, or the connection broke\n"
    "  130  interrupted\n"
    "\nResults go to standard output, progress, summaries and errors to standard error; with\n"
    "--json both speak JSON, and an error is a problem document (RFC 9457).";

// All options of all commands; the one that was given is taken from here.
struct Options {
    Invocation invocation;
    SubmitOptions submit;
    FollowOptions follow;
    FetchOptions fetch;
    ListOptions list;
    CancelOptions cancel;
    DeleteOptions erase;
    UploadOptions upload;
    RunOptions run;
};

// The library's own reading of the environment does not do here: a variable would be read for the
// commands that were not given, too, and win over the option of the one that was.
void read_environment(const char* name, std::string& value) {
    const char* const text = std::getenv(name);
    if (text != nullptr && *text != '\0') {
        value = text;
    }
}

// Values that become part of a header must not end it.
std::string refuse_control(const std::string& value) {
    return printable(value) == value ? "" : "has control characters";
}

std::string refuse_empty(const std::string& value) { return value.empty() ? "is empty" : ""; }

CLI::App* add_command(
    CLI::App& app, Invocation& invocation, const char* name, const char* description
) {
    CLI::App* command = app.add_subcommand(name, description);
    command
        ->add_option(
            "--server", invocation.server, "Where the server is; default: $MODELSYNTH_SERVER"
        )
        ->type_name("URL")
        ->capture_default_str();
    command
        ->add_option(
            "--key",
            invocation.key,
            "Key for servers that ask for one; default: $MODELSYNTH_KEY, which other users of "
            "this machine do not see"
        )
        ->type_name("KEY")
        ->check(refuse_control);
    command
        ->add_option(
            "--ca", invocation.ca_file, "PEM file of the roots to trust in place of the system's"
        )
        ->check(CLI::ExistingFile);
    command->add_flag("--json", invocation.as_json, "Write JSON, for programs");
    return command;
}

void add_job(CLI::App& command, std::string& job_id) {
    command.add_option("JOB", job_id, "Id of the job")->required()->check(refuse_empty);
}

std::array<CLI::Option*, 2> add_form(CLI::App& command, ModelForm& form) {
    return {
        command
            .add_option(
                "--profile",
                form.profile,
                "nodes: core glTF, a node for each piece (default); instanced: small, needs "
                "EXT_mesh_gpu_instancing; merged: few meshes"
            )
            ->check(CLI::IsMember({"nodes", "instanced", "merged"}))
            ->type_name("NAME"),
        command
            .add_option(
                "--compression",
                form.compression,
                "none (default), or meshopt: smaller, needs EXT_meshopt_compression"
            )
            ->check(CLI::IsMember({"none", "meshopt"}))
            ->type_name("NAME")};
}

CLI::Option* add_output(CLI::App& command, std::string& output) {
    return command
        .add_option("-o,--output", output, "File for the model; \"-\" is standard output")
        ->type_name("FILE")
        ->check(refuse_empty);
}

// The option that names a job to start from.
CLI::Option* add_request(CLI::App& command, RequestOptions& request) {
    CLI::Option_group* const choice = command.add_option_group(
        "request", "What to make: an example or a finished job with options, or all of it"
    );
    choice->require_option(1, 2);
    CLI::Option* const example = choice->add_option(
        "--example", request.example, "Id of an example, or a file of one (.json, or with a slash)"
    );
    CLI::Option* const from =
        choice
            ->add_option(
                "--from",
                request.from,
                "Finished job to start from: its model keeps its labels but in the --box, and "
                "grows to a larger --size; what is not given is as it was there"
            )
            ->type_name("JOB")
            ->check(refuse_empty);
    CLI::Option* const whole =
        choice
            ->add_option(
                "--request", request.request_file, "Whole request; \"-\" is standard input"
            )
            ->type_name("FILE")
            ->excludes(example)
            ->excludes(from);
    const auto add = [&](const char* name, auto& value, const char* description) {
        return command.add_option(name, value, description)->excludes(whole);
    };
    add("--solver", request.solver, "Name of the solver; default: that of the example");
    add("--box", request.box, "Cells that are made anew, the second corner exclusive")
        ->type_name("X,Y,Z:X,Y,Z")
        ->needs(from);
    add("--at", request.at, "Where the job's model lies in a larger one; default: 0,0,0")
        ->type_name("X,Y,Z")
        ->needs(from);
    add("--size", request.size, "Cells along x, y (up) and z")->type_name("40x10x40");
    add("--seed", request.seed, "Same seed, same model")->check(CLI::NonNegativeNumber);
    add("--alternatives",
        request.alternatives,
        "So many different models; their files are FILE.glb, FILE-1.glb, ...")
        ->type_name("N");
    add("--parameters", request.parameters, "The solver's parameters; --size is put with them")
        ->type_name("JSON|FILE");
    add("--priority", request.priority, "-10 ... 10, higher first");
    add("--deadline", request.deadline_seconds, "Longest solving time")->type_name("SECONDS");
    add("--tag", request.tags, "Tags of the job")->type_name("NAME=VALUE");
    return from;
}

void add_job_commands(CLI::App& app, Options& options) {
    CLI::App& submit =
        *add_command(app, options.invocation, "submit", "Submit a job and print its id");
    add_request(submit, options.submit.request);
    submit
        .add_option(
            "--idempotency-key",
            options.submit.idempotency_key,
            "Name of this request: sent again, it gives the same job"
        )
        ->type_name("KEY")
        ->check(refuse_control);
    submit.add_flag("--follow", options.submit.is_followed, "Show the progress until the end");
    CLI::Option* const output = add_output(submit, options.submit.output);
    for (CLI::Option* const form : add_form(submit, options.submit.form)) {
        form->needs(output);
    }

    CLI::App& follow = *add_command(
        app,
        options.invocation,
        "follow",
        "Show a job's progress until its end; with --json, each event as a line"
    );
    add_job(follow, options.follow.job_id);
    follow.add_option("--after", options.follow.after, "Begin after this event")
        ->check(CLI::NonNegativeNumber)
        ->type_name("SEQ");

    CLI::App& fetch = *add_command(app, options.invocation, "fetch", "Download a job's model");
    add_job(fetch, options.fetch.job_id);
    add_output(fetch, options.fetch.output)->required();
    const auto form = add_form(fetch, options.fetch.form);
    CLI::Option* const preview =
        fetch.add_flag("--preview", options.fetch.is_preview, "The model as far as it is now");
    fetch.add_option("--alternative", options.fetch.alternative, "Which of several models, from 0")
        ->check(CLI::NonNegativeNumber)
        ->type_name("K")
        ->excludes(preview);
    fetch.add_flag("--labels", options.fetch.is_labels, "The labels as JSON instead")
        ->excludes(form[0])
        ->excludes(form[1])
        ->excludes(preview);

    CLI::App& run = *add_command(
        app, options.invocation, "run", "Make a model: submit, follow and fetch, or --local"
    );
    CLI::Option* const from = add_request(run, options.run.request);
    add_output(run, options.run.output)->required();
    add_form(run, options.run.form);
    run.add_flag("--local", options.run.is_local, "Solve here, without a server")->excludes(from);
}

void add_catalog_commands(CLI::App& app, Options& options) {
    Invocation& invocation = options.invocation;
    CLI::App& list = *add_command(app, invocation, "list", "List jobs, newest first");
    list.add_option("--state", options.list.state, "Only jobs in this state")
        ->check(CLI::IsMember({"queued", "running", "succeeded", "failed", "cancelled"}))
        ->type_name("NAME");
    list.add_option("--limit", options.list.limit, "At most so many")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}))
        ->type_name("N")
        ->capture_default_str();
    add_job(*add_command(app, invocation, "cancel", "Stop a job"), options.cancel.job_id);
    add_job(
        *add_command(app, invocation, "delete", "Forget a job and its model"), options.erase.job_id
    );
    add_command(app, invocation, "upload", "Upload an example and print its id")
        ->add_option(
            "FILE", options.upload.path, "Example as JSON (meshes: a .glb beside it), or a .glb"
        )
        ->required();
    add_command(app, invocation, "examples", "List the examples of the server");
}

void take_command(const std::string& name, Options& options) {
    auto& command = options.invocation.command;
    if (name == "submit") {
        command = std::move(options.submit);
    } else if (name == "follow") {
        command = std::move(options.follow);
    } else if (name == "fetch") {
        command = std::move(options.fetch);
    } else if (name == "run") {
        command = std::move(options.run);
    } else if (name == "list") {
        command = std::move(options.list);
    } else if (name == "cancel") {
        command = std::move(options.cancel);
    } else if (name == "delete") {
        command = std::move(options.erase);
    } else if (name == "upload") {
        command = std::move(options.upload);
    }
}

// JSON and a model cannot share standard output.
void check_output(const Options& options) {
    const auto is_standard = [](const std::string& output) { return output == "-"; };
    if (options.invocation.as_json &&
        (is_standard(options.submit.output) || is_standard(options.fetch.output) ||
         is_standard(options.run.output))) {
        throw CLI::ValidationError("-o -", "does not go with --json");
    }
}

}  // namespace

tl::expected<Invocation, ExitCode> read_command_line(
    int argument_count, const char* const* arguments
) {
    Options options;
    read_environment("MODELSYNTH_SERVER", options.invocation.server);
    read_environment("MODELSYNTH_KEY", options.invocation.key);
    CLI::App app("Makes large 3D models from small examples.", "modelsynth");
    app.footer(kFooter);
    app.set_version_flag("--version", MODELSYNTH_VERSION);
    app.require_subcommand(1);
    add_job_commands(app, options);
    add_catalog_commands(app, options);
    try {
        app.parse(argument_count, arguments);
        check_output(options);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
            app.exit(error);
            return tl::unexpected(ExitCode::kDone);
        }
        const std::span all(arguments, static_cast<std::size_t>(argument_count));
        const bool as_json =
            std::find(all.begin(), all.end(), std::string_view("--json")) != all.end();
        const Failure failure{ExitCode::kWrongUsage, error.what()};
        std::fputs(describe(failure, as_json).c_str(), stderr);
        return tl::unexpected(failure.code);
    }
    take_command(app.get_subcommands().front()->get_name(), options);
    return std::move(options.invocation);
}

}  // namespace modelsynth::cli
