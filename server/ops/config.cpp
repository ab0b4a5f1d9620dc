#include "server/ops/config.h"

#include "server/access/key_ring.h"
#include "server/http/tls_identity.h"
#include "server/ops/config_file.h"
#include "server/ops/config_sources.h"
#include "server/ops/options.h"
#include "server/ops/outside_options.h"
#include "server/webhooks/signing.h"

#include <CLI/CLI.hpp>
#include <boost/asio/ip/address.hpp>

#include <algorithm>
#include <cstdio>
#include <thread>
#include <vector>

namespace modelsynth::server {

namespace {

// What is asked for on the command line alone.
struct Questions {
    bool check = false;
    bool print = false;
};

// Sets address and port from ADDRESS:PORT; what is wrong, or nothing.
std::string read_listen(const std::string& text, HttpConfig& http) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) {
        return "must be ADDRESS:PORT";
    }
    std::string address = text.substr(0, colon);
    if (address.size() > 2 && address.front() == '[' && address.back() == ']') {
        address = address.substr(1, address.size() - 2);
    }
    if (address == "localhost") {
        address = "127.0.0.1";
    }
    boost::system::error_code error;
    static_cast<void>(boost::asio::ip::make_address(address, error));
    const std::string port = text.substr(colon + 1);
    if (error || port.empty() || port.size() > 5 ||
        port.find_first_not_of("0123456789") != std::string::npos || std::stoul(port) > 65535) {
        return "must be ADDRESS:PORT with a numeric address";
    }
    http.address = address;
    http.port = static_cast<std::uint16_t>(std::stoul(port));
    return "";
}

proto::UnixMillis millis_of(double hours) {
    return static_cast<proto::UnixMillis>(hours * 3600 * 1000);
}

// What depends on several options.
void resolve(
    CLI::App& app, const WrittenOptions& written, Config& config, std::vector<ConfigFault>& faults
) {
    if (const std::string wrong = read_listen(written.listen, config.http); !wrong.empty()) {
        faults.push_back({"--listen", wrong});
        return;
    }
    const bool is_loopback = boost::asio::ip::make_address(config.http.address).is_loopback();
    if (!is_loopback && config.access.keys_file.empty()) {
        faults.push_back(
            {"--listen", "without keys (--keys) only loopback addresses are listened on"}
        );
    }
    if (const TlsFiles& tls = config.http.tls; tls.certificate.empty() != tls.key.empty()) {
        faults.push_back(
            {tls.key.empty() ? "--tls-certificate" : "--tls-key",
             "--tls-certificate and --tls-key go together"}
        );
    }
    auto& of_address_max = config.http.limits.connections_per_address_max;
    CLI::Option* option = app.get_option("--connections-per-address-max");
    of_address_max = is_loopback && option->empty() ? 0 : written.connections_per_address_max;
    option->default_str(std::to_string(of_address_max));  // as it is printed
    config.log.format = written.log_format == "json" ? LogFormat::kJson : LogFormat::kText;
    config.drain_timeout = std::chrono::seconds(written.drain_timeout_seconds);
    config.retention_ms = millis_of(written.retention_hours);
    const double forget_hours =
        written.forget_hours > 0 ? written.forget_hours : 4 * written.retention_hours;
    if (forget_hours < written.retention_hours) {
        faults.push_back({"--forget-hours", "must not be less than --retention-hours"});
    }
    config.jobs.forget_after_expiry_ms = millis_of(forget_hours) - config.retention_ms;
    if (written.data_bytes_max > 0) {
        config.jobs.artifact_bytes_max = written.data_bytes_max;
    }
}

void check_keys(const Config& config, std::vector<ConfigFault>& faults) {
    if (config.access.keys_file.empty()) {
        return;
    }
    if (const auto keys = KeyRing::load(config.access.keys_file); !keys) {
        faults.push_back({"--keys", keys.error()});
    }
}

void check_secrets(const Config& config, std::vector<ConfigFault>& faults) {
    if (const auto loaded = TlsIdentity(config.http.tls).load(); !loaded) {
        faults.push_back({"--tls-certificate", loaded.error()});
    }
    if (config.webhooks.secret_file.empty()) {
        return;
    }
    if (const auto loaded = Signer(config.webhooks.secret_file).load(); !loaded) {
        faults.push_back({"--webhook-secret-file", loaded.error()});
    }
}

void print(CLI::App& app) {
    std::string text = "# modelsynthd --config takes this file.\n";
    for (const CLI::Option* option : app.get_options()) {
        if (!is_setting(*option)) {
            continue;
        }
        const bool list = is_list(*option);
        std::vector<std::string> values = option->results();
        if (option->empty() && !list && !option->get_default_str().empty()) {
            values = {option->get_default_str()};
        }
        text += "\n# " + option->get_description() + "\n";
        text += values.empty() ? "# " : "";
        text += config_file_line(option->get_single_name(), values, list);
    }
    std::fputs(text.c_str(), stdout);
}

int refuse(const std::vector<ConfigFault>& faults) {
    for (const ConfigFault& fault : faults) {
        std::fprintf(stderr, "modelsynthd: %s: %s\n", fault.place.c_str(), fault.detail.c_str());
    }
    return 2;
}

}  // namespace

const char* version() { return MODELSYNTH_VERSION; }

tl::expected<Config, int> parse_arguments(int argc, const char* const* argv) {
    Config config;
    config.jobs.workers = std::max(1U, std::thread::hardware_concurrency());
    config.jobs.disk_free_bytes_min = std::uint64_t{64} << 20;
    WrittenOptions written;
    Questions questions;
    std::string config_file;
    CLI::App app("modelsynthd makes large 3D models from small examples, over HTTP.");
    app.footer(
        "Every option --some-thing may also be given as MODELSYNTH_SOME_THING in the environment\n"
        "(lists with commas) and as some-thing = value in the file of --config. The command line\n"
        "goes before the environment, which goes before the file."
    );
    app.set_version_flag("--version", version());
    app.add_option("--config", config_file, "File of options; unknown names are refused");
    app.add_flag(
        "--check-config", questions.check, "Reads all of it and the keys; tells what is wrong"
    );
    app.add_flag("--print-config", questions.print, "Writes what holds, as a file for --config");
    add_server_options(app, config, written);
    add_work_options(app, config);
    add_keeping_options(app, config, written);
    add_http_options(app, config, written);
    add_tls_options(app, config);
    add_webhook_options(app, config);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return tl::unexpected(app.exit(error) == 0 ? 0 : 2);
    }
    std::vector<ConfigFault> faults;
    take_environment(app, faults);
    if (config_file.empty()) {
        config_file = environment("MODELSYNTH_CONFIG").value_or("");
    }
    if (!config_file.empty()) {
        take_file(app, config_file, faults);
    }
    resolve(app, written, config, faults);
    if (questions.check) {
        check_keys(config, faults);
        check_secrets(config, faults);
    }
    if (!faults.empty()) {
        return tl::unexpected(refuse(faults));
    }
    if (questions.print) {
        print(app);
    } else if (questions.check) {
        std::puts("the configuration is fine");
    }
    if (questions.print || questions.check) {
        return tl::unexpected(0);
    }
    return config;
}

}  // namespace modelsynth::server
