// Whether a service takes work, and what becomes of jobs when it stops.

#include "tests/unit/server/faulty_vfs.h"
#include "tests/unit/server/service_suite.h"

#include <sqlite3.h>

namespace modelsynth::server {
namespace {

std::string readiness(JobService& service) {
    const auto ready = service.check_ready();
    return ready ? "ready" : ready.error().type;
}

using Readiness = ServiceSuite;

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
    EXPECT_EQ(service.find(id)->state, proto::JobState::kSucceeded) << service.find(id)->error;
}

}  // namespace
}  // namespace modelsynth::server
