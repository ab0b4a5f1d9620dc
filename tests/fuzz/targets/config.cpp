// The file that --config names.

#include "server/ops/config.h"

#include "tests/fuzz/targets/law.h"

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

using modelsynth::server::parse_arguments;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = ::memfd_create("config", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    law(::ftruncate(file, 0) == 0);
    law(::pwrite(file, data, size, 0) == static_cast<ssize_t>(size));
    const std::array<const char*, 3> arguments = {"modelsynthd", "--config", path.c_str()};
    const auto config = parse_arguments(static_cast<int>(arguments.size()), arguments.data());
    if (config) {
        law(config->jobs.workers >= 1 && config->jobs.workers <= 256);
        law(config->retention_ms > 0);
    }
    return 0;
}
