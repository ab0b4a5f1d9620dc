#include "server/ops/outside_options.h"

#include "server/ops/number_checks.h"

#include <CLI/CLI.hpp>

namespace modelsynth::server {

void add_tls_options(CLI::App& app, Config& config) {
    app.add_option(
        "--tls-certificate",
        config.http.tls.certificate,
        "PEM file of a certificate and those that lead to its root; speaks HTTPS with it. Read "
        "again on SIGHUP"
    );
    app.add_option("--tls-key", config.http.tls.key, "PEM file of its key, without passphrase");
}

void add_webhook_options(CLI::App& app, Config& config) {
    WebhookConfig& webhooks = config.webhooks;
    app.add_option(
        "--webhook-secret-file",
        webhooks.secret_file,
        "File of the secret that webhooks are signed with, whsec_ and base64; jobs may have "
        "webhooks with it. Several lines: signed with each. Read again on SIGHUP"
    );
    app.add_flag(
        "--webhook-allow-http", webhooks.rules.allow_http, "Webhooks may go to http:// URLs"
    );
    app.add_flag(
        "--webhook-allow-private",
        webhooks.rules.allow_private,
        "Webhooks may go to loopback and private addresses"
    );
    app.add_option("--webhook-ca", webhooks.ca_file, "PEM file of the roots that webhooks trust");
    app.add_option(
           "--webhook-first-delay",
           webhooks.first_delay_seconds,
           "Seconds from the first try of a webhook to the second; each further pause is six times "
           "as long, and all are a fifth shorter or longer by chance"
    )
        ->check(check_number(0.001, 3600), "")
        ->capture_default_str();
    app.add_option(
           "--webhook-seconds", webhooks.try_seconds, "For a receiver of webhooks to answer"
    )
        ->check(check_whole_number(1, 300), "")
        ->capture_default_str();
}

}  // namespace modelsynth::server
