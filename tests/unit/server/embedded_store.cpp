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

std::vector<StoreSetting> embedded_settings() {
    const auto make = [] { return std::make_unique<EmbeddedStore>(); };
    return {{"Fresh", make}, {"Reopened", make, true}, {"Loaded", make, false, 120}};
}

namespace {

std::string name_of(const testing::TestParamInfo<StoreSetting>& setting) {
    return setting.param.name;
}

// Other backends run the same tests by lines like these.
INSTANTIATE_TEST_SUITE_P(Embedded, JobContract, testing::ValuesIn(embedded_settings()), name_of);
INSTANTIATE_TEST_SUITE_P(Embedded, ClaimContract, testing::ValuesIn(embedded_settings()), name_of);
INSTANTIATE_TEST_SUITE_P(
    Embedded, ProgressContract, testing::ValuesIn(embedded_settings()), name_of
);
INSTANTIATE_TEST_SUITE_P(Embedded, EventContract, testing::ValuesIn(embedded_settings()), name_of);
INSTANTIATE_TEST_SUITE_P(
    Embedded, ArtifactContract, testing::ValuesIn(embedded_settings()), name_of
);
INSTANTIATE_TEST_SUITE_P(
    Embedded, ExampleContract, testing::ValuesIn(embedded_settings()), name_of
);

}  // namespace

}  // namespace modelsynth::server
