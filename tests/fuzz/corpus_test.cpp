// The inputs that are kept for the targets of libFuzzer (targets/), through the same functions and
// held against the same laws, by any compiler. What a campaign found is kept there and stays
// mended.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

// LLVMFuzzerTestOneInput() of each target, under these names (CMakeLists.txt).
extern "C" {
int fuzz_config(const std::uint8_t* data, std::size_t size);
int fuzz_example_glb(const std::uint8_t* data, std::size_t size);
int fuzz_example_json(const std::uint8_t* data, std::size_t size);
int fuzz_frame(const std::uint8_t* data, std::size_t size);
int fuzz_header_values(const std::uint8_t* data, std::size_t size);
int fuzz_job_request(const std::uint8_t* data, std::size_t size);
int fuzz_keys(const std::uint8_t* data, std::size_t size);
int fuzz_mask(const std::uint8_t* data, std::size_t size);
int fuzz_request_head(const std::uint8_t* data, std::size_t size);
int fuzz_stream_message(const std::uint8_t* data, std::size_t size);
}

namespace modelsynth {
namespace {

struct Target {
    const char* name;
    int (*run)(const std::uint8_t* data, std::size_t size);
};

constexpr std::array<Target, 10> kTargets = {
    {{"config", fuzz_config},
     {"example_glb", fuzz_example_glb},
     {"example_json", fuzz_example_json},
     {"frame", fuzz_frame},
     {"header_values", fuzz_header_values},
     {"job_request", fuzz_job_request},
     {"keys", fuzz_keys},
     {"mask", fuzz_mask},
     {"request_head", fuzz_request_head},
     {"stream_message", fuzz_stream_message}}};

std::vector<std::filesystem::path> sorted_entries(const std::filesystem::path& directory) {
    std::vector<std::filesystem::path> entries;
    for (const auto& entry : std::filesystem::directory_iterator(directory)) {
        entries.push_back(entry.path());
    }
    std::sort(entries.begin(), entries.end());
    return entries;
}

class FuzzCorpus : public testing::TestWithParam<Target> {};

// A law that breaks ends the program: the last input that was printed is the one.
TEST_P(FuzzCorpus, KeepsTheLaws) {
    const auto inputs =
        sorted_entries(std::filesystem::path(MODELSYNTH_FUZZ_CORPUS_DIR) / GetParam().name);
    EXPECT_FALSE(inputs.empty());
    for (const auto& input : inputs) {
        std::ifstream file(input, std::ios::binary);
        ASSERT_TRUE(file) << input;
        const std::vector<std::uint8_t> bytes{
            std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
        std::printf("%s\n", input.c_str());
        std::fflush(stdout);
        EXPECT_EQ(GetParam().run(bytes.data(), bytes.size()), 0) << input;
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzCorpus, testing::ValuesIn(kTargets), [](const auto& target) {
    return std::string(target.param.name);
});

TEST(FuzzCorpora, HaveATargetEach) {
    std::vector<std::string> names;
    for (const auto& directory : sorted_entries(MODELSYNTH_FUZZ_CORPUS_DIR)) {
        names.push_back(directory.filename().string());
    }
    std::vector<std::string> of_targets;
    for (const Target& target : kTargets) {
        of_targets.emplace_back(target.name);
    }
    EXPECT_EQ(names, of_targets);
}

}  // namespace
}  // namespace modelsynth
