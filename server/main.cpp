#include "server/http/admission.h"
#include "server/http/api.h"
#include "server/http/server.h"
#include "server/jobs/job_service.h"
#include "server/ops/config.h"
#include "server/ops/limits_document.h"
#include "server/ops/logging.h"
#include "server/store/sqlite/sqlite_store.h"

#include <cstdio>
#include <exception>
#include <string>

namespace {

using namespace modelsynth::server;

int serve(const Config& config) {
    const auto log = make_logger(config.log_level);
    auto store = SqliteStore::open(config.data_directory, config.retention_ms);
    if (!store) {
        std::fprintf(stderr, "modelsynthd: %s\n", store.error().message.c_str());
        return 1;
    }
    JobService service(config.jobs, **store, **store, **store, (*store)->artifacts(), log);
    Admission admission(config.access);
    if (const auto loaded = admission.load_keys(); !loaded) {
        std::fprintf(stderr, "modelsynthd: %s\n", loaded.error().c_str());
        return 1;
    }
    Api api(service, admission, config.http.limits, make_documents(limits_document(config)));
    HttpServer server(config.http, api, log);
    const std::uint16_t port = server.listen();
    const bool is_v6 = config.http.address.find(':') != std::string::npos;
    std::printf(
        "listening on http://%s%s%s:%u\n",
        is_v6 ? "[" : "",
        config.http.address.c_str(),
        is_v6 ? "]" : "",
        static_cast<unsigned>(port)
    );
    std::fflush(stdout);
    log->info("started data={} workers={}", config.data_directory, config.jobs.workers);
    const auto reload = [&admission, &log] {
        if (const auto loaded = admission.load_keys(); loaded) {
            log->info("configuration read again");
        } else {
            log->error("the keys stay as they were why=\"{}\"", loaded.error());
        }
    };
    server.run([&service] { service.drain(); }, reload);
    log->info("stopped");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const auto config = parse_arguments(argc, argv);
    if (!config) {
        return config.error();
    }
    try {
        return serve(*config);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "modelsynthd: %s\n", error.what());
        return 1;
    }
}
