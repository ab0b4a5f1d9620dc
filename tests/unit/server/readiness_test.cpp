// Whether a service takes work, and what becomes of jobs when it stops.

#include "server/jobs/job_service.h"
#include "tests/unit/server/embedded_store.h"
#include "tests/unit/server/faulty_vfs.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/null_sink.h>
#include <sqlite3.h>

#include <atomic>
#include <stdexcept>

namespace modelsynth::server {
namespace {

// For as long as it takes to look at a service.
constexpr const char* kLong =
    R"([60,10,60],"blocks":{"size":[20,10,20],"overlap":0.75,"passes":15})";

// The artifacts of another store on a disk of any size.
class ArtifactsOnADisk final : public ArtifactStore {
  public:
    explicit ArtifactsOnADisk(ArtifactStore& artifacts) : artifacts_(artifacts) {}

    [[nodiscard]] Space space() const override {
        return {artifacts_.space().used_bytes, free_bytes};
    }

    Stored<std::unique_ptr<Pin>> put(std::string_view bytes) override {
        if (is_broken) {
            throw std::logic_error("a fault of ours");
        }
        return artifacts_.put(bytes);
    }

    Stored<std::unique_ptr<Pin>> pin(const std::string& digest) override {
        return artifacts_.pin(digest);
    }

    Stored<std::unique_ptr<Reader>> open(const std::string& digest) override {
        return artifacts_.open(digest);
    }

    Stored<std::string> load(const std::string& digest) override { return artifacts_.load(digest); }

    std::atomic<std::uint64_t> free_bytes = 1'000'000;
    std::atomic<bool> is_broken = false;

  private:
    ArtifactStore& artifacts_;
};

std::shared_ptr<spdlog::logger> no_log() {
    return std::make_shared<spdlog::logger>(
        "none", std::make_shared<spdlog::sinks::null_sink_mt>()
    );
}

// The id of the job, or the type of the problem.
std::string submit(JobService& service, const std::string& size) {
    auto submitted = service.submit(
        R"({"solver":"discrete","example":"castle","seed":7,"parameters":{"size":)" + size + "}}",
        "",
        {},
        ""
    );
    return submitted ? submitted->job.id : submitted.error().type;
}

std::string readiness(JobService& service) {
    const auto ready = service.check_ready();
    return ready ? "ready" : ready.error().type;
}

class Readiness : public testing::Test {
  protected:
    std::unique_ptr<JobService> make_service(const JobServiceConfig& config) {
        return std::make_unique<JobService>(
            config,
            store_.jobs(),
            store_.events(),
            store_.examples(),
            artifacts_,
            no_log(),
            observer_
        );
    }

    EmbeddedStore store_;
    ArtifactsOnADisk artifacts_{store_.artifacts()};
    JobObserver observer_;
};

TEST_F(Readiness, ADiskThatIsNearlyFullTakesNoWorkUntilItHasRoomAgain) {
    JobServiceConfig config;
    config.disk_free_bytes_min = 1'000'000;
    const auto service = make_service(config);
    EXPECT_EQ(readiness(*service), "ready");
    artifacts_.free_bytes = 999'999;
    EXPECT_EQ(readiness(*service), "/problems/unavailable");
    EXPECT_EQ(submit(*service, "[8,6,8]"), "/problems/unavailable");
    artifacts_.free_bytes = 1'000'000;
    EXPECT_EQ(readiness(*service), "ready");
    const std::string id = submit(*service, "[8,6,8]");
    EXPECT_TRUE(eventually([&] { return proto::is_ended(service->find(id)->state); }));
}

TEST_F(Readiness, AFaultCostsTheJobThatMetItAndNoOther) {
    JobServiceConfig config;
    config.workers = 1;
    const auto service = make_service(config);
    artifacts_.is_broken = true;
    const std::string id = submit(*service, "[8,6,8]");
    ASSERT_TRUE(eventually([&] { return proto::is_ended(service->find(id)->state); }));
    const auto job = service->find(id);
    EXPECT_EQ(job->state, proto::JobState::kFailed);
    EXPECT_NE(job->error.find("/problems/internal"), std::string::npos) << job->error;
    EXPECT_NE(job->error.find("\"instance\":\"/v1/jobs/" + id), std::string::npos) << job->error;
    artifacts_.is_broken = false;
    const std::string next = submit(*service, "[8,6,8]");
    ASSERT_TRUE(eventually([&] { return proto::is_ended(service->find(next)->state); }));
    EXPECT_EQ(service->find(next)->state, proto::JobState::kSucceeded);
}

TEST_F(Readiness, AFullQueueIsReadyAgainWhenATenthOfItIsFree) {
    JobServiceConfig config;
    config.workers = 0;  // nobody takes jobs out of the queue
    config.queue_max = 20;
    const auto service = make_service(config);
    std::vector<std::string> ids;
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(readiness(*service), "ready");
        ids.push_back(submit(*service, "[8,6,8]"));
    }
    EXPECT_EQ(readiness(*service), "/problems/queue-full");
    EXPECT_TRUE(service->cancel(ids[0]));
    EXPECT_EQ(readiness(*service), "/problems/queue-full");
    EXPECT_TRUE(service->cancel(ids[1]));
    EXPECT_EQ(readiness(*service), "ready");
}

TEST_F(Readiness, ADrainLetsRunningJobsEndAndLeavesTheOthersInTheQueue) {
    JobServiceConfig config;
    config.workers = 1;
    const auto service = make_service(config);
    const std::string running = submit(*service, kLong);
    const std::string queued = submit(*service, "[8,6,8]");
    ASSERT_TRUE(eventually([&] { return service->running_count() == 1; }));
    service->refuse_work();
    EXPECT_EQ(readiness(*service), "/problems/draining");
    EXPECT_EQ(submit(*service, "[8,6,8]"), "/problems/draining");
    service->drain(std::chrono::seconds(600));
    EXPECT_EQ(service->find(running)->state, proto::JobState::kSucceeded);
    EXPECT_EQ(service->find(queued)->state, proto::JobState::kQueued);
}

TEST_F(Readiness, ADrainThatWaitsForNothingGivesRunningJobsBack) {
    JobServiceConfig config;
    config.workers = 1;
    const auto service = make_service(config);
    const std::string id = submit(*service, kLong);
    ASSERT_TRUE(eventually([&] { return service->running_count() == 1; }));
    service->drain(std::chrono::seconds(0));
    EXPECT_EQ(service->find(id)->state, proto::JobState::kQueued);
    EXPECT_EQ(service->running_count(), 0U);
}

TEST(ReadinessOnAFaultyDisk, AJobThatWasCutOffGoesOnWhenTheDiskHasRoomAgain) {
    const TemporaryDirectory directory;
    FaultyVfs disk;
    JobObserver observer;
    const auto store = value(SqliteStore::open(directory.path(), kRetentionMs));
    JobServiceConfig config;
    config.workers = 1;
    JobService service(config, *store, *store, *store, store->artifacts(), no_log(), observer);
    const std::string id = submit(service, kLong);
    ASSERT_TRUE(eventually([&] { return service.find(id)->blocks_done > 0; }));
    disk.fail(FaultyVfs::Call::kWrite, 1, SQLITE_FULL, 1'000'000'000);
    ASSERT_TRUE(eventually([&] { return disk.has_failed(); }));
    EXPECT_EQ(submit(service, "[8,6,8]"), "/problems/unavailable");
    EXPECT_EQ(service.find(id)->state, proto::JobState::kRunning);
    disk.heal();
    EXPECT_TRUE(eventually([&] { return proto::is_ended(service.find(id)->state); }));
    EXPECT_EQ(service.find(id)->state, proto::JobState::kSucceeded);
}

}  // namespace
}  // namespace modelsynth::server
