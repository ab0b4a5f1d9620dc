#pragma once

#include <spdlog/logger.h>

#include <cstdint>
#include <memory>
#include <string>

namespace spdlog::details {
class thread_pool;
}

namespace modelsynth::server {

enum class LogFormat : std::uint8_t { kText, kJson };

struct LogConfig {
    std::string level = "info";  // debug, info, warn or error
    LogFormat format = LogFormat::kText;
    std::size_t lines_waiting_max = 8192;
};

// One line an event to standard error, see log/event_line.h, written by a thread of its own: nobody
// waits for whoever reads the log. Lines that wait to be written are bounded; the oldest go when
// there are too many. Whoever has the logger must let go of it before this ends, which writes what
// still waits. Thread-safe.
class Logging {
  public:
    explicit Logging(const LogConfig& config);
    ~Logging();

    Logging(const Logging&) = delete;
    Logging& operator=(const Logging&) = delete;

    [[nodiscard]] const std::shared_ptr<spdlog::logger>& logger() const { return logger_; }

    // Lines that went for want of room.
    [[nodiscard]] std::uint64_t dropped_count() const;

  private:
    std::shared_ptr<spdlog::logger> logger_;
    std::shared_ptr<spdlog::details::thread_pool> pool_;  // last: its thread writes by the logger
};

// A line as it is written, with its end: what a formatter of that format makes of a payload.
[[nodiscard]] std::string log_line(LogFormat format, const spdlog::details::log_msg& message);

}  // namespace modelsynth::server
