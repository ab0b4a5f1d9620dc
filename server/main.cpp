#include "server/http/admission.h"
#include "server/http/api.h"
#include "server/http/server.h"
#include "server/http/tls_identity.h"
#include "server/jobs/job_service.h"
#include "server/log/event_line.h"
#include "server/ops/config.h"
#include "server/ops/limits_document.h"
#include "server/ops/logging.h"
#include "server/ops/metrics.h"
#include "server/store/sqlite/sqlite_store.h"
#include "server/webhooks/webhook_sender.h"
#include "server/webhooks/webhook_url.h"

#include <malloc.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>

namespace {

using namespace modelsynth::server;
namespace level = spdlog::level;

int refuse_to_start(const std::string& why) {
    std::fprintf(stderr, "modelsynthd: %s\n", why.c_str());
    return 1;
}

std::string metrics_text(
    Metrics& metrics, SqliteStore& store, const JobService& service, const Logging& logging
) {
    const auto space = store.artifacts().space();
    return metrics.text(
        {store.queued_count().value_or(0),
         service.running_count(),
         store.delivery_count().value_or(0),
         space.used_bytes,
         space.free_bytes,
         logging.dropped_count()}
    );
}

// Every model is made in buffers of a few megabytes. The C library would give each back to the
// system and take it anew, page by page: of small jobs a fifth of the time. What is kept in hand
// is this much for each thread that makes models, at most.
void keep_freed_memory() {
    constexpr int kKeptBytes = 32 << 20;
    ::mallopt(M_MMAP_THRESHOLD, kKeptBytes);
    ::mallopt(M_TRIM_THRESHOLD, kKeptBytes);
}

// Of what may change while the server runs.
void tell_reload(
    spdlog::logger& log,
    const tl::expected<void, std::string>& loaded,
    const char* when_read,
    const char* when_wrong
) {
    if (loaded) {
        log_event(log, level::info, when_read, {});
    } else {
        log_event(log, level::err, when_wrong, {{"why", loaded.error()}});
    }
}

// Null when jobs may have no webhooks.
std::unique_ptr<WebhookSender> make_sender(
    const WebhookConfig& config,
    SqliteStore& store,
    Metrics& metrics,
    std::shared_ptr<spdlog::logger> log
) {
    return config.secret_file.empty()
               ? nullptr
               : std::make_unique<WebhookSender>(config, store, store, metrics, std::move(log));
}

void announce(const Config& config, std::uint16_t port) {
    const bool is_v6 = config.http.address.find(':') != std::string::npos;
    std::printf(
        "listening on %s://%s%s%s:%u\n",
        config.http.tls.certificate.empty() ? "http" : "https",
        is_v6 ? "[" : "",
        config.http.address.c_str(),
        is_v6 ? "]" : "",
        static_cast<unsigned>(port)
    );
    std::fflush(stdout);
}

int serve(const Config& config) {
    const Logging logging(config.log);
    const auto& log = logging.logger();
    Metrics metrics(version());
    auto store = SqliteStore::open(config.data_directory, config.retention_ms);
    if (!store) {
        return refuse_to_start(store.error().message);
    }
    (*store)->on_commit([&metrics](double seconds) { metrics.on_commit(seconds); });
    JobService service(config.jobs, **store, **store, **store, (*store)->artifacts(), log, metrics);
    Admission admission(config.access);
    if (const auto loaded = admission.load_keys(); !loaded) {
        return refuse_to_start(loaded.error());
    }
    const auto webhooks = make_sender(config.webhooks, **store, metrics, log);
    if (webhooks) {
        if (const auto loaded = webhooks->load_secrets(); !loaded) {
            return refuse_to_start(loaded.error());
        }
        service.take_webhooks([rules = config.webhooks.rules](const std::string& url) {
            return find_url_fault(url, rules);
        });
        webhooks->start();
    }
    TlsIdentity tls(config.http.tls);
    if (const auto loaded = tls.load(); !loaded) {
        return refuse_to_start(loaded.error());
    }
    Api api(service, admission, config.http.limits, make_documents(limits_document(config)), [&] {
        return metrics_text(metrics, **store, service, logging);
    });
    HttpServer server(config.http, api, tls, log, metrics);
    announce(config, server.listen());
    log_event(
        *log,
        level::info,
        "started",
        {{"version", version()}, {"data", config.data_directory}, {"workers", config.jobs.workers}}
    );
    ServerHooks hooks;
    hooks.on_signal = [&service] { service.refuse_work(); };
    hooks.finish_work = [&service, &config] { service.drain(config.drain_timeout); };
    hooks.on_hangup = [&admission, &tls, &webhooks, &log] {
        tell_reload(*log, admission.load_keys(), "keys read again", "the keys stay as they were");
        if (tls.is_on()) {
            tell_reload(
                *log, tls.load(), "certificate read again", "the certificate stays as it was"
            );
        }
        if (webhooks) {
            tell_reload(
                *log,
                webhooks->load_secrets(),
                "webhook secret read again",
                "the webhook secret stays as it was"
            );
        }
    };
    server.run(hooks);
    log_event(*log, level::info, "stopped", {});
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    const auto config = parse_arguments(argc, argv);
    if (!config) {
        return config.error();
    }
    try {
        return serve(*config);
    } catch (const std::exception& error) {
        return refuse_to_start(error.what());
    }
}
