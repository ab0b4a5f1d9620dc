#include "server/ops/logging.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace modelsynth::server {

std::shared_ptr<spdlog::logger> make_logger(const std::string& level) {
    auto log = std::make_shared<spdlog::logger>(
        "modelsynthd", std::make_shared<spdlog::sinks::stderr_sink_mt>()
    );
    log->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc);
    log->set_level(spdlog::level::from_str(level));
    log->flush_on(spdlog::level::info);
    return log;
}

}  // namespace modelsynth::server
