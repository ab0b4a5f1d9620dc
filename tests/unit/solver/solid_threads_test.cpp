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

// With one attempt each, blocks fail, and their corners are made instead.
TEST(SolidCorners, ComeOutTheSameOnAnyNumberOfThreads) {
    const auto reading = examples::find_solids("roller_coaster");
    Parameters parameters;
    parameters.size = {26, 8, 26};
    parameters = fill_defaults(parameters, reading->example());
    (*parameters.blocks)->attempts = 1;
    const Problem problem = make_problem(reading, parameters).value();
    std::uint32_t by_corners = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Recorder alone;
        const auto expected = synthesise(problem, parameters, seed, alone, {});
        ASSERT_TRUE(expected);
        const SearchTally& tally = expected->stats.blocks;
        by_corners += tally.solved_by[static_cast<std::size_t>(SolvedBy::kSmallerBlock)];
        Recorder recorder;
        const auto made = synthesise(problem, parameters, seed, recorder, {}, nullptr, 3);
        ASSERT_TRUE(made);
        EXPECT_TRUE(made->labels == expected->labels);
        EXPECT_TRUE(recorder.reports == alone.reports);
        for (Site site = 0; site < made->labels.size(); ++site) {
            for (const ArrangementEdge& edge : problem.arrangement.edges(site)) {
                if (edge.end != kNoSite) {
                    const Figures& figures = problem.reading->figures();
                    ASSERT_EQ(
                        figures.along(made->labels[site], edge.heading),
                        figures.along(made->labels[edge.end], edge.heading ^ 1)
                    );
                }
            }
        }
    }
    EXPECT_GT(by_corners, 0U);
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
