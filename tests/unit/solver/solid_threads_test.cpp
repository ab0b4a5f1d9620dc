// Models of solids are the same on any number of threads.

#include "solver/continuous/problem.h"
#include "solver/continuous/synthesis.h"
#include "solver/examples/solids/built_in_solids.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace modelsynth::continuous {
namespace {

struct Report {
    std::uint32_t index = 0;
    bool accepted = false;
    SearchTally tally;
    std::vector<Label> labels;

    friend bool operator==(const Report&, const Report&) = default;
};

class Recorder final : public Observer {
  public:
    void on_start(std::uint32_t, std::span<const Label>) override {}

    void on_block(const BlockReport& report) override {
        reports.push_back(
            {report.index,
             report.accepted,
             report.tally,
             {report.model.begin(), report.model.end()}}
        );
        if (reports.size() == stop_after) {
            stop.request_stop();
        }
    }

    std::vector<Report> reports;
    std::size_t stop_after = 0;
    std::stop_source stop;
};

class SolidThreads : public ::testing::TestWithParam<const char*> {
  protected:
    SolidThreads() {
        Parameters parameters;
        parameters.size = {26, 8, 26};
        parameters_ = fill_defaults(parameters, reading_->example());
        problem_ = std::make_unique<Problem>(make_problem(reading_, parameters_).value());
    }

    [[nodiscard]] Result<Synthesis> make(
        Recorder& recorder, std::uint32_t threads, const Checkpoint* from = nullptr
    ) const {
        return synthesise(
            *problem_, parameters_, 3, recorder, recorder.stop.get_token(), from, threads
        );
    }

    std::shared_ptr<const ExampleReading> reading_ = examples::find_solids(GetParam());
    Parameters parameters_;
    std::unique_ptr<Problem> problem_;
};

TEST_P(SolidThreads, ChangeNothing) {
    Recorder alone;
    const auto expected = make(alone, 1);
    ASSERT_TRUE(expected);
    ASSERT_GT(alone.reports.size(), 9U);
    for (const std::uint32_t threads : {2U, 3U, 8U}) {
        SCOPED_TRACE(std::to_string(threads) + " threads");
        Recorder recorder;
        const auto made = make(recorder, threads);
        ASSERT_TRUE(made);
        EXPECT_TRUE(made->labels == expected->labels);
        EXPECT_TRUE(recorder.reports == alone.reports);
    }
}

TEST_P(SolidThreads, GoOnFromACheckpoint) {
    Recorder alone;
    const auto expected = make(alone, 1);
    ASSERT_TRUE(expected);
    const std::size_t half = alone.reports.size() / 2;
    const Report& last = alone.reports[half - 1];
    const Checkpoint checkpoint = {static_cast<std::uint32_t>(half), last.tally, last.labels};
    Recorder rest;
    const auto made = make(rest, 4, &checkpoint);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->labels == expected->labels);
    EXPECT_EQ(rest.reports.size(), alone.reports.size() - half);
}

TEST_P(SolidThreads, EndWhenTheyAreStopped) {
    Recorder recorder;
    recorder.stop_after = 2;
    const auto made = make(recorder, 4);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::kCancelled);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    SolidThreads,
    ::testing::Values("skyscrapers", "terrain", "arches"),
    [](const auto& it) { return std::string(it.param); }
);

}  // namespace
}  // namespace modelsynth::continuous
