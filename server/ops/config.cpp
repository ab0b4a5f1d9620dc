#include "server/ops/config.h"

#include <CLI/CLI.hpp>
#include <boost/asio/ip/address.hpp>

#include <cstdint>
#include <thread>

namespace modelsynth::server {

namespace {

// Sets address and port from ADDRESS:PORT; the text of what is wrong, or nothing.
std::string parse_listen(const std::string& text, bool has_keys, HttpConfig& http) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) {
        return "--listen must be ADDRESS:PORT";
    }
    std::string address = text.substr(0, colon);
    if (address.size() > 2 && address.front() == '[' && address.back() == ']') {
        address = address.substr(1, address.size() - 2);
    }
    if (address == "localhost") {
        address = "127.0.0.1";
    }
    boost::system::error_code error;
    const auto parsed = boost::asio::ip::make_address(address, error);
    const std::string port = text.substr(colon + 1);
    if (error || port.empty() || port.size() > 5 ||
        port.find_first_not_of("0123456789") != std::string::npos || std::stoul(port) > 65535) {
        return "--listen must be ADDRESS:PORT with a numeric address";
    }
    if (!parsed.is_loopback() && !has_keys) {
        return "without keys (--keys) only loopback addresses are listened on";
    }
    http.address = address;
    http.port = static_cast<std::uint16_t>(std::stoul(port));
    return "";
}

}  // namespace

tl::expected<Config, int> parse_arguments(int argc, const char* const* argv) {
    Config config;
    config.jobs.workers = std::max(1U, std::thread::hardware_concurrency());
    std::string listen = "127.0.0.1:8080";
    double retention_hours = 7 * 24;
    CLI::App app("modelsynthd makes large 3D models from small examples, over HTTP.");
    app.set_config("--config", "", "Options from an INI or TOML file; unknown keys are refused")
        ->check(CLI::ExistingFile);
    app.allow_config_extras(false);
    app.add_option("--data", config.data_directory, "Directory of the store")
        ->capture_default_str();
    app.add_option("--listen", listen, "ADDRESS:PORT; port 0 picks one")->capture_default_str();
    app.add_option("--workers", config.jobs.workers, "Threads that solve")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    app.add_option("--keys", config.access.keys_file, "File of keys, read again on SIGHUP")
        ->check(CLI::ExistingFile);
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
    app.add_option("--log-level", config.log_level, "debug, info, warn or error")
        ->check(CLI::IsMember({"debug", "info", "warn", "error"}))
        ->capture_default_str();
    app.add_option("--queue-max", config.jobs.queue_max, "Jobs that may wait")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    app.add_option(
           "--memory-max",
           config.jobs.memory_bytes_max,
           "Bytes that running jobs may need; 0: three quarters of the machine's"
    )
        ->capture_default_str();
    app.add_option(
           "--large-choices",
           config.jobs.large_choices,
           "Jobs that choose more labels, overlap included, are large: one worker is kept for the "
           "others"
    )
        ->capture_default_str();
    app.add_option("--examples-max", config.jobs.examples_max, "Uploaded examples that are kept")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    app.add_option("--model-cells-max", config.jobs.limits.model_cells_max, "Cells of one model")
        ->check(CLI::Range(1, 100'000'000))
        ->capture_default_str();
    app.add_option("--retention-hours", retention_hours, "How long models are kept")
        ->check(CLI::Range(0.001, 24.0 * 3650))
        ->capture_default_str();
    app.add_option(
           "--job-body-bytes-max", config.http.limits.job_body_bytes_max, "Bytes of a job request"
    )
        ->check(CLI::Range(1024, 1 << 30))
        ->capture_default_str();
    app.add_option(
           "--upload-body-bytes-max",
           config.http.limits.upload_body_bytes_max,
           "Bytes of an uploaded example"
    )
        ->check(CLI::Range(1024, 1 << 30))
        ->capture_default_str();
    app.add_option("--connections-max", config.http.limits.connections_max, "Open connections")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    app.add_option("--head-seconds", config.http.limits.head_seconds, "For a request's head")
        ->check(CLI::Range(1, 3600))
        ->capture_default_str();
    app.add_option("--body-seconds", config.http.limits.body_seconds, "For a request's body")
        ->check(CLI::Range(1, 3600))
        ->capture_default_str();
    app.add_option("--idle-seconds", config.http.limits.idle_seconds, "Between two requests")
        ->check(CLI::Range(1, 3600))
        ->capture_default_str();
    app.add_option(
           "--write-seconds",
           config.http.limits.write_seconds,
           "For a client to take what is written to it"
    )
        ->check(CLI::Range(1, 3600))
        ->capture_default_str();
    app.add_option(
           "--stream-idle-seconds",
           config.http.limits.stream_idle_seconds,
           "Until a silent WebSocket is closed; heartbeats come several times in it"
    )
        ->check(CLI::Range(4, 3600))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
        const std::string wrong =
            parse_listen(listen, !config.access.keys_file.empty(), config.http);
        if (!wrong.empty()) {
            throw CLI::ValidationError(wrong);
        }
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error);
        return tl::unexpected(code == 0 ? 0 : 2);
    }
    config.retention_ms = static_cast<proto::UnixMillis>(retention_hours * 3600 * 1000);
    return config;
}

}  // namespace modelsynth::server
