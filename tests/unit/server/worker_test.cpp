// What a worker makes of a job that was begun before: by itself, by another version of the
// solver, or with a log that it cannot have written.

#include "server/jobs/worker.h"

#include "proto/frame.h"
#include "proto/job.h"
#include "server/jobs/job_inputs.h"
#include "server/jobs/logging_observer.h"
#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spdlog/sinks/null_sink.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::server {
namespace {

// 9 blocks and more, so that there is something before and after a place to stop at.
constexpr const char* kRequest =
    R"({"solver":"discrete","example":"castle","seed":7,"parameters":{"size":[16,6,16],)"
    R"("blocks":{"size":[6,6,6]}}})";

class WorkerOnAnEarlierLog : public testing::Test {
  protected:
    void submit(const std::string& id) {
        NewJob job = new_job(id);
        job.request = kRequest;
        value(store_.jobs().submit(job, kNoLimit));
    }

    Claim claim() {
        auto claim = value(store_.jobs().claim(kNow, {}));
        if (!claim) {
            throw std::runtime_error("no job is queued");
        }
        return *claim;
    }

    void run(const Claim& claim) {
        run_claim(
            {store_.jobs(),
             store_.events(),
             store_.artifacts(),
             examples_,
             live_,
             previews_,
             running_,
             preparations_,
             limits_,
             log_,
             observer_},
            claim
        );
    }

    // A job that was never stopped.
    void run_whole(const std::string& id) {
        submit(id);
        run(claim());
        if (job(id).state != proto::JobState::kSucceeded) {
            throw std::runtime_error("the whole job did not succeed: " + job(id).error);
        }
    }

    // As a worker of `version` leaves a job at which it is stopped after these blocks; they come
    // with a checkpoint of the model when there is one.
    void leave_begun(
        const std::string& version,
        const std::vector<std::string>& blocks,
        const std::optional<std::string>& labels
    ) {
        const Claim begun = claim();
        Progress progress;
        progress.solver_version = version;
        std::vector<NewEvent> events = {{"started", proto::started_fields(9, false), kNow}};
        for (const std::string& fields : blocks) {
            events.push_back({"block", fields, kNow});
        }
        progress.blocks_done = static_cast<std::uint32_t>(blocks.size());
        if (labels) {
            SearchTally tally;
            tally.solved_by[0] = progress.blocks_done;
            progress.checkpoint =
                JobCheckpoint{0, progress.blocks_done, proto::encode_tally(tally), *labels};
        }
        value(append(store_.jobs(), begun.lease, events, progress));
        value(store_.jobs().release(begun.lease, 0));
    }

    std::vector<std::string> blocks_of(const std::string& id) {
        std::vector<std::string> blocks;
        for (const Event& event : whole_log(store_.events(), id)) {
            if (event.type == "block") {
                blocks.push_back(event.fields);
            }
        }
        return blocks;
    }

    proto::Job job(const std::string& id) { return value(store_.jobs().find(id)); }

    std::string digest(const std::string& id) {
        return value(store_.jobs().artifact(id, "nodes.glb"));
    }

    // A model of one label, which the solver never makes.
    static std::string wrong_labels() {
        return proto::encode_labels(std::vector<Label>(std::size_t{16} * 6 * 16, 1));
    }

    EmbeddedStore store_;
    JobObserver observer_;
    proto::RequestLimits limits_;
    ExampleLibrary examples_{store_.examples(), store_.artifacts(), limits_, 10};
    LiveJobs live_;
    std::shared_ptr<spdlog::logger> log_ =
        std::make_shared<spdlog::logger>("none", std::make_shared<spdlog::sinks::null_sink_mt>());
    PreviewKeeper previews_{store_.jobs(), store_.artifacts(), live_, log_};
    RunningJobs running_;
    Preparations preparations_;
};

TEST_F(WorkerOnAnEarlierLog, OwnBlocksAreSolvedAgainAndNotLoggedAgain) {
    run_whole("whole");
    const auto blocks = blocks_of("whole");
    ASSERT_GE(blocks.size(), 4U);
    submit("begun");
    leave_begun(kSolverVersion, {blocks[0], blocks[1], blocks[2]}, std::nullopt);
    run(claim());
    EXPECT_EQ(job("begun").state, proto::JobState::kSucceeded) << job("begun").error;
    EXPECT_EQ(blocks_of("begun"), blocks);
    EXPECT_EQ(digest("begun"), digest("whole"));
}

TEST_F(WorkerOnAnEarlierLog, ALogThatTellsOfAnotherModelEndsTheJobAsAFault) {
    run_whole("whole");
    auto blocks = blocks_of("whole");
    auto second = nlohmann::json::parse(blocks[1]);
    second["outcome"] = second.at("outcome") == "accepted" ? "reverted" : "accepted";
    submit("begun");
    leave_begun(kSolverVersion, {blocks[0], second.dump()}, std::nullopt);
    run(claim());
    EXPECT_EQ(job("begun").state, proto::JobState::kFailed);
    EXPECT_NE(job("begun").error.find("/problems/internal"), std::string::npos);
    EXPECT_NE(job("begun").error.find("another model"), std::string::npos);
    // Nothing was added to the log but that it was taken up and how it ended.
    EXPECT_EQ(whole_log(store_.events(), "begun").size(), 6U);
    EXPECT_EQ(error_of(store_.jobs().artifact("begun", "nodes.glb")), StoreErrorCode::kNotFound);
}

TEST_F(WorkerOnAnEarlierLog, AnotherVersionSolvesFromTheBeginning) {
    run_whole("whole");
    submit("begun");
    leave_begun("older", {R"({"index":0})", R"({"index":1})"}, wrong_labels());
    run(claim());
    EXPECT_EQ(job("begun").state, proto::JobState::kSucceeded) << job("begun").error;
    EXPECT_EQ(digest("begun"), digest("whole"));
    auto blocks = blocks_of("begun");
    blocks.erase(blocks.begin(), blocks.begin() + 2);
    EXPECT_EQ(blocks, blocks_of("whole"));
}

TEST_F(WorkerOnAnEarlierLog, AnotherVersionThatCrashedBeforeItsFirstBlockDoesToo) {
    run_whole("whole");
    submit("begun");
    leave_begun("older", {R"({"index":0})", R"({"index":1})"}, wrong_labels());
    leave_begun(kSolverVersion, {}, std::nullopt);
    run(claim());
    EXPECT_EQ(job("begun").state, proto::JobState::kSucceeded) << job("begun").error;
    EXPECT_EQ(digest("begun"), digest("whole"));
}

TEST_F(WorkerOnAnEarlierLog, LabelsToStartFromThatAreNoModelEndTheJobAsAFault) {
    run_whole("whole");
    auto request = nlohmann::json::parse(kRequest);
    request["from"] = {{"job", "whole"}, {"size", {16, 6, 16}}};
    NewJob from = new_job("from");
    from.request = request.dump();
    const auto pin = value(store_.artifacts().put("no labels"));
    from.artifacts = {{kOriginArtifact, pin->digest()}};
    value(store_.jobs().submit(from, kNoLimit));
    run(claim());
    EXPECT_EQ(job("from").state, proto::JobState::kFailed);
    EXPECT_NE(job("from").error.find("/problems/internal"), std::string::npos);
    EXPECT_NE(job("from").error.find("damaged"), std::string::npos);
}

}  // namespace
}  // namespace modelsynth::server
