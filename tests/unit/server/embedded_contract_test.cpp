// The contract of the store, kept by the embedded one.

#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>

namespace modelsynth::server {

namespace {

// Fresh, reopened, loaded.
std::vector<StoreSetting> embedded_settings() {
    const auto make = [] { return std::make_unique<EmbeddedStore>(); };
    return {{"Fresh", make}, {"Reopened", make, true}, {"Loaded", make, false, 120}};
}

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
INSTANTIATE_TEST_SUITE_P(
    Embedded, DeliveryContract, testing::ValuesIn(embedded_settings()), name_of
);

}  // namespace

}  // namespace modelsynth::server
