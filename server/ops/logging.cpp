#include "server/ops/logging.h"

#include "server/log/event_line.h"

#include <fmt/chrono.h>
#include <spdlog/async.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <chrono>

namespace modelsynth::server {

namespace {

class LineFormatter final : public spdlog::formatter {
  public:
    explicit LineFormatter(LogFormat format) : format_(format) {}

    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& into) override {
        const std::string line = log_line(format_, message);
        into.append(line.data(), line.data() + line.size());
    }

    [[nodiscard]] std::unique_ptr<spdlog::formatter> clone() const override {
        return std::make_unique<LineFormatter>(format_);
    }

  private:
    LogFormat format_;
};

}  // namespace

std::string log_line(LogFormat format, const spdlog::details::log_msg& message) {
    using std::chrono::milliseconds;
    const auto since_epoch =
        std::chrono::duration_cast<milliseconds>(message.time.time_since_epoch()).count();
    const std::string time = fmt::format(
        "{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
        fmt::gmtime(spdlog::log_clock::to_time_t(message.time)),
        since_epoch % 1000
    );
    const spdlog::string_view_t level = spdlog::level::to_string_view(message.level);
    const std::string_view payload(message.payload.data(), message.payload.size());
    if (format == LogFormat::kText) {
        return fmt::format("{} {} {}\n", time, level, printable(payload));
    }
    return fmt::format(
        "{{\"time\":\"{}\",\"level\":\"{}\",{}}}\n", time, level, json_members_of(payload)
    );
}

Logging::Logging(const LogConfig& config)
    : pool_(std::make_shared<spdlog::details::thread_pool>(config.lines_waiting_max, 1)) {
    auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    logger_ = std::make_shared<spdlog::async_logger>(
        "modelsynthd", std::move(sink), pool_, spdlog::async_overflow_policy::overrun_oldest
    );
    logger_->set_formatter(std::make_unique<LineFormatter>(config.format));
    logger_->set_level(spdlog::level::from_str(config.level));
}

Logging::~Logging() = default;

std::uint64_t Logging::dropped_count() const { return pool_->overrun_counter(); }

}  // namespace modelsynth::server
