#include "server/ops/options.h"

#include "server/ops/number_checks.h"

#include <CLI/CLI.hpp>

#include <concepts>

namespace modelsynth::server {

namespace {

constexpr std::uint64_t kBytesMax = std::uint64_t{1} << 50;
constexpr std::uint64_t kBodyBytesMax = std::uint64_t{1} << 30;
constexpr double kHoursMax = 24.0 * 3650;

void add_number(
    CLI::App& app,
    const std::string& name,
    std::integral auto& value,
    const std::string& what,
    std::uint64_t least,
    std::uint64_t most
) {
    app.add_option(name, value, what)
        ->check(check_whole_number(least, most), "")
        ->capture_default_str();
}

void add_hours(
    CLI::App& app, const std::string& name, double& value, const std::string& what, double least
) {
    app.add_option(name, value, what)
        ->check(check_number(least, kHoursMax), "")
        ->capture_default_str();
}

void add_word(
    CLI::App& app,
    const std::string& name,
    std::string& value,
    const std::string& what,
    const std::vector<std::string>& words
) {
    app.add_option(name, value, what)->check(CLI::IsMember(words))->capture_default_str();
}

}  // namespace

void add_server_options(CLI::App& app, Config& config, WrittenOptions& written) {
    app.add_option("--data", config.data_directory, "Directory of the store")
        ->capture_default_str();
    app.add_option("--listen", written.listen, "ADDRESS:PORT; port 0 picks one")
        ->capture_default_str();
    app.add_option("--keys", config.access.keys_file, "File of keys, read again on SIGHUP");
    app.add_option(
        "--allow-origin",
        config.access.browsers.origins,
        "Pages of this origin may ask, as https://studio.example.com; * for all"
    );
    app.add_option(
        "--allow-host",
        config.access.browsers.hosts,
        "Further name of this server, which browsers may call it without a key"
    );
    add_word(
        app,
        "--log-level",
        config.log.level,
        "debug, info, warn or error",
        {"debug", "info", "warn", "error"}
    );
    add_word(
        app, "--log-format", written.log_format, "text or json, a line an event", {"text", "json"}
    );
    add_number(
        app, "--log-lines-max", config.log.lines_waiting_max, "Lines that wait", 1, 1'000'000
    );
    add_number(
        app,
        "--drain-delay",
        config.http.drain_delay_seconds,
        "Seconds after SIGTERM in which all is answered but no work taken; 5 behind a balancer",
        0,
        3600
    );
    add_number(
        app,
        "--drain-timeout",
        written.drain_timeout_seconds,
        "Seconds after that in which running jobs may end; the others go on after the next start",
        0,
        86400
    );
}

void add_work_options(CLI::App& app, Config& config) {
    proto::RequestLimits& limits = config.jobs.limits;
    add_number(app, "--workers", config.jobs.workers, "Threads that solve", 1, 256);
    add_number(app, "--queue-max", config.jobs.queue_max, "Jobs that may wait", 1, 1'000'000);
    add_number(
        app,
        "--memory-max",
        config.jobs.memory_bytes_max,
        "Bytes that running jobs may need; 0: three quarters of the machine's",
        0,
        kBytesMax
    );
    add_number(
        app,
        "--large-choices",
        config.jobs.large_choices,
        "Jobs that choose more labels, overlap included, are large: one worker is kept for the "
        "others",
        0,
        kBytesMax
    );
    add_number(
        app,
        "--examples-max",
        config.jobs.examples_max,
        "Uploaded examples that are kept",
        1,
        100'000
    );
    add_number(
        app,
        "--webhooks-waiting-max",
        config.jobs.webhooks_waiting_max,
        "Webhooks of one key that are not delivered yet; with as many its jobs may have none",
        1,
        1'000'000
    );
    add_number(
        app, "--model-cells-max", limits.model_cells_max, "Cells of one model", 1, 100'000'000
    );
    add_number(app, "--blocks-max", limits.blocks_max, "Blocks of one model", 1, 10'000'000);
    add_number(
        app, "--example-cells-max", limits.example_cells_max, "Cells of one example", 1, 100'000'000
    );
    // Labels have 16 bits.
    add_number(app, "--pieces-max", limits.pieces_max, "Pieces of one example", 1, 65'000);
    add_number(
        app, "--constraints-max", limits.constraints_max, "Constraints of one job", 0, 100'000
    );
    // Readers go as deep as the text does.
    add_number(app, "--json-depth-max", limits.json.depth_max, "Nesting of JSON", 8, 256);
    add_number(
        app, "--json-nodes-max", limits.json.nodes_max, "Values in one JSON text", 100, 100'000'000
    );
    add_number(
        app,
        "--json-string-bytes-max",
        limits.json.string_bytes_max,
        "Bytes of a string in JSON",
        1024,
        kBodyBytesMax
    );
}

void add_keeping_options(CLI::App& app, Config& config, WrittenOptions& written) {
    add_hours(app, "--retention-hours", written.retention_hours, "How long models are kept", 0.001);
    add_hours(
        app,
        "--forget-hours",
        written.forget_hours,
        "How long ended jobs and their events are; 0 is four times the retention",
        0
    );
    add_number(
        app,
        "--data-bytes-max",
        written.data_bytes_max,
        "Bytes of models and all else that jobs leave; the oldest go first. 0 is no limit",
        0,
        kBytesMax
    );
    add_number(
        app,
        "--disk-free-min",
        config.jobs.disk_free_bytes_min,
        "Bytes that must be free on the disk for work to be taken",
        0,
        kBytesMax
    );
}

void add_http_options(CLI::App& app, Config& config, WrittenOptions& written) {
    HttpLimits& limits = config.http.limits;
    add_number(
        app,
        "--job-body-bytes-max",
        limits.job_body_bytes_max,
        "Bytes of a job request",
        1024,
        kBodyBytesMax
    );
    add_number(
        app,
        "--upload-body-bytes-max",
        limits.upload_body_bytes_max,
        "Bytes of an uploaded example",
        1024,
        kBodyBytesMax
    );
    add_number(
        app,
        "--other-body-bytes-max",
        limits.other_body_bytes_max,
        "Bytes of all other bodies",
        1024,
        kBodyBytesMax
    );
    add_number(
        app, "--target-bytes-max", limits.target_bytes_max, "Bytes of a request line", 256, 1 << 20
    );
    add_number(
        app, "--head-bytes-max", limits.head_bytes_max, "Bytes of a request's head", 1024, 1 << 20
    );
    add_number(app, "--fields-max", limits.fields_max, "Header fields of a request", 8, 10'000);
    add_number(app, "--connections-max", limits.connections_max, "Open connections", 1, 1'000'000);
    add_number(
        app,
        "--connections-per-address-max",
        written.connections_per_address_max,
        "... from one address, 0 is no limit; that is the default on loopback, where proxies are",
        0,
        1'000'000
    );
    add_number(
        app,
        "--requests-per-connection-max",
        limits.requests_per_connection_max,
        "Requests on one connection",
        1,
        1'000'000'000
    );
    add_number(app, "--head-seconds", limits.head_seconds, "For a request's head", 1, 3600);
    add_number(app, "--body-seconds", limits.body_seconds, "For a request's body", 1, 3600);
    add_number(app, "--idle-seconds", limits.idle_seconds, "Between two requests", 1, 3600);
    add_number(
        app, "--write-seconds", limits.write_seconds, "For each piece of an answer", 1, 3600
    );
    add_number(
        app,
        "--stream-idle-seconds",
        limits.stream_idle_seconds,
        "Until a silent WebSocket is closed; heartbeats come several times in it",
        4,
        3600
    );
    add_number(
        app,
        "--stream-subscriptions-max",
        limits.stream_subscriptions_max,
        "Jobs that one WebSocket follows",
        1,
        10'000
    );
    add_number(
        app,
        "--stream-pending-max",
        limits.stream_pending_max,
        "Requests on one WebSocket that wait for answers",
        1,
        10'000
    );
    add_number(
        app,
        "--network-threads",
        config.http.network_threads,
        "Threads that send and receive",
        1,
        64
    );
    add_number(
        app, "--pool-threads", config.http.pool_threads, "Threads that answer requests", 1, 256
    );
}

}  // namespace modelsynth::server
