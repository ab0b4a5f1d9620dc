#include "tests/unit/server/embedded_store.h"

#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace modelsynth::server {

namespace {

// What the tests are about needs no disk, and in memory a sync takes no time.
std::string parent_directory() {
    const bool is_chosen = std::getenv("TEST_TMPDIR") != nullptr;
    return !is_chosen && std::filesystem::is_directory("/dev/shm") ? "/dev/shm/"
                                                                   : testing::TempDir();
}

}  // namespace

TemporaryDirectory::TemporaryDirectory() {
    std::string name = parent_directory() + "modelsynth-store-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("no directory can be made as " + name);
    }
    path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace modelsynth::server
