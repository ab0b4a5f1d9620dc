// The file that --config names.

#include "server/ops/config.h"

#include "server/ops/config_file.h"
#include "tests/fuzz/targets/law.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

using namespace modelsynth::server;

namespace {

// What was read, as it is printed, reads the same.
void check_lines(std::string_view text) {
    std::vector<ConfigFault> faults;
    for (const ConfigLine& line : parse_config_file(text, "", faults)) {
        const std::string printed =
            config_file_line(line.name, line.values, line.values.size() != 1);
        std::vector<ConfigFault> none;
        const auto again = parse_config_file(printed, "", none);
        law(none.empty() && again.size() == 1);
        law(again.front().name == line.name && again.front().values == line.values);
    }
}

void check_ranges(const Config& config) {
    law(config.jobs.workers >= 1 && config.jobs.workers <= 256);
    law(config.jobs.queue_max >= 1 && config.jobs.queue_max <= 1'000'000);
    law(config.retention_ms > 0);
    law(config.jobs.forget_after_expiry_ms >= 0);
    law(config.webhooks.first_delay_seconds >= 0.001 && config.webhooks.first_delay_seconds <= 3600
    );
    law(config.webhooks.try_seconds >= 1 && config.webhooks.try_seconds <= 300);
    law(config.http.limits.fields_max >= 8 && config.http.limits.fields_max <= 10'000);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = ::memfd_create("config", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    law(::ftruncate(file, 0) == 0);
    law(::pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
    const std::array<const char*, 3> arguments = {"modelsynthd", "--config", path.c_str()};
    const auto config = parse_arguments(static_cast<int>(arguments.size()), arguments.data());
    if (config) {
        check_ranges(*config);
    }
    check_lines({reinterpret_cast<const char*>(data), size});
    return 0;
}
