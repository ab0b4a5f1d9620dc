// What becomes of a job that is told to stop, and how soon its worker is free.

#include "proto/frame.h"
#include "server/store/artifact_names.h"
#include "tests/unit/server/service_suite.h"

#include <algorithm>
#include <atomic>

namespace modelsynth::server {
namespace {

// Holds the worker of the first job that logs a block, as a solver does that does not ask whether
// it is to stop.
class HoldingObserver final : public JobObserver {
  public:
    void on_block(std::string_view /*example*/, bool /*accepted*/) override {
        if (!holds.exchange(true)) {
            is_held_.wait(true);
        }
    }

    void let_go() {
        is_held_ = false;
        is_held_.notify_all();
    }

    std::atomic<bool> holds = false;

  private:
    std::atomic<bool> is_held_ = true;
};

class LingeringJob : public ServiceSuite {
  protected:
    ~LingeringJob() override { observer_.let_go(); }

    JobObserver& observer() override { return observer_; }

    // It waits for its workers when it goes, which is when nothing is held any more.
    JobService& start(const JobServiceConfig& config) {
        service_ = make_service(config);
        return *service_;
    }

    HoldingObserver observer_;

  private:
    std::unique_ptr<JobService> service_;
};

constexpr const char* kSmall = "[8,6,8]";

proto::JobState state_of(JobService& service, const std::string& id) {
    return service.find(id)->state;
}

bool is_ended(JobService& service, const std::string& id) {
    return proto::is_ended(state_of(service, id));
}

// Requires: more than the service has.
std::uint64_t bytes_needed(JobService& service, const std::string& size) {
    const auto refused = service.submit(
        R"({"solver":"discrete","example":"castle","parameters":{"size":)" + size + "}}", "", {}, ""
    );
    const std::string& detail = refused.error().detail;
    return std::stoull(detail.substr(detail.find_first_of("0123456789")));
}

TEST_F(LingeringJob, PassesItsPlaceOn) {
    JobServiceConfig config;
    config.workers = 1;
    config.large_choices = 0;  // all are large ones, of which there may be one at a time
    JobService& service = start(config);
    const std::string id = submit(service, kLong);
    const std::string behind = submit(service, kSmall);
    ASSERT_TRUE(eventually([&] { return observer_.holds.load(); }));
    EXPECT_TRUE(service.cancel(id));
    EXPECT_TRUE(eventually([&] { return is_ended(service, behind); }));
    EXPECT_EQ(state_of(service, behind), proto::JobState::kSucceeded);
    EXPECT_EQ(state_of(service, id), proto::JobState::kRunning);
    EXPECT_TRUE(eventually([&] { return service.running_count() == 1; }));
    observer_.let_go();
    EXPECT_TRUE(eventually([&] { return service.running_count() == 0; }));
    EXPECT_EQ(state_of(service, id), proto::JobState::kCancelled);
    // There is one place again, and it is taken.
    const std::string next = submit(service, kSmall);
    EXPECT_TRUE(eventually([&] { return is_ended(service, next); }));
}

TEST_F(LingeringJob, PassesItsPlaceOnWhenItIsDeleted) {
    JobServiceConfig config;
    config.workers = 1;
    JobService& service = start(config);
    const std::string id = submit(service, kLong);
    const std::string behind = submit(service, kSmall);
    ASSERT_TRUE(eventually([&] { return observer_.holds.load(); }));
    EXPECT_TRUE(service.erase(id));
    EXPECT_TRUE(eventually([&] { return is_ended(service, behind); }));
    EXPECT_TRUE(eventually([&] { return service.running_count() == 1; }));
}

TEST(RunningJobs, TellOnceOfWhatLingersAfterItsDeadline) {
    RunningJobs running;
    std::atomic<int> told = 0;
    RunningJobs::Entry entry(running, "a", [&] { ++told; });
    entry.set_deadline(RunningJobs::Clock::now());
    EXPECT_TRUE(eventually([&] { return told == 1; }));
    EXPECT_EQ(entry.reason(), StopReason::kDeadline);
    EXPECT_TRUE(entry.token().stop_requested());
    running.stop("a", StopReason::kCancelled);  // too late to be the reason
    // By the time that the next one is told of, the first one has been looked at again.
    std::atomic<bool> is_next_told = false;
    const RunningJobs::Entry next(running, "b", [&] { is_next_told = true; });
    running.stop("b", StopReason::kErased);
    EXPECT_TRUE(eventually([&] { return is_next_told.load(); }));
    EXPECT_EQ(entry.reason(), StopReason::kDeadline);
    EXPECT_EQ(told, 1);
}

TEST_F(LingeringJob, KeepsItsMemoryUntilItIsGone) {
    JobServiceConfig config;
    config.workers = 1;
    config.memory_bytes_max = 1;
    std::uint64_t need = 0;
    {
        const auto service = make_service(config);
        need = bytes_needed(*service, kLong) + bytes_needed(*service, kSmall);
    }
    config.memory_bytes_max = need;
    JobService& service = start(config);
    const std::string id = submit(service, kLong);
    ASSERT_TRUE(eventually([&] { return observer_.holds.load(); }));
    const std::string large = submit(service, kLong);
    const std::string small = submit(service, kSmall);
    EXPECT_TRUE(service.cancel(id));
    // Its place is free, as the small one shows, but there is no room for one before that.
    EXPECT_TRUE(eventually([&] { return is_ended(service, small); }));
    EXPECT_EQ(state_of(service, large), proto::JobState::kQueued);
    observer_.let_go();
    EXPECT_TRUE(eventually([&] { return is_ended(service, large); }));
}

using StoppedJob = ServiceSuite;

TEST_F(StoppedJob, EndsBeforeItsPreviewIsOnDisk) {
    JobServiceConfig config;
    config.workers = 1;
    auto service = make_service(config);
    artifacts_.is_held = true;
    const std::string id = submit(*service, kLong);
    ASSERT_TRUE(eventually([&] { return service->find(id)->blocks_done > 0; }));
    EXPECT_TRUE(service->cancel(id));
    EXPECT_TRUE(eventually([&] { return service->running_count() == 0; }));
    EXPECT_EQ(state_of(*service, id), proto::JobState::kCancelled);
    EXPECT_FALSE(store_.jobs().artifact(id, kPreviewArtifact));
    // Meanwhile the live model is its preview, ...
    EXPECT_TRUE(service->models().preview(id));
    // ... and for the time after a crash there is the checkpoint.
    EXPECT_TRUE(value(store_.jobs().checkpoint(id)));
    artifacts_.let_go();
    service.reset();
    const std::string digest = value(store_.jobs().artifact(id, kPreviewArtifact));
    const auto labels = proto::decode_labels(value(store_.artifacts().load(digest)));
    ASSERT_TRUE(labels);
    EXPECT_EQ(labels->size(), std::size_t{60} * 10 * 60);
    EXPECT_GT(std::count_if(labels->begin(), labels->end(), [](Label l) { return l > 1; }), 0);
    EXPECT_FALSE(value(store_.jobs().checkpoint(id)));
}

TEST_F(StoppedJob, HasItsCheckpointForAPreviewWhereNoneCanBeKept) {
    JobServiceConfig config;
    config.workers = 1;
    auto service = make_service(config);
    const std::string id = submit(*service, kLong);
    ASSERT_TRUE(eventually([&] { return service->find(id)->blocks_done > 0; }));
    artifacts_.is_broken = true;
    EXPECT_TRUE(service->cancel(id));
    EXPECT_TRUE(eventually([&] { return service->running_count() == 0; }));
    service.reset();
    EXPECT_FALSE(store_.jobs().artifact(id, kPreviewArtifact));
    EXPECT_TRUE(make_service({})->models().preview(id));
}

TEST_F(StoppedJob, WaitsForThePreviewsOfOthersWhenTheyAreMany) {
    JobServiceConfig config;
    config.workers = 1;
    auto service = make_service(config);
    artifacts_.is_held = true;
    std::vector<std::string> ids;
    for (std::size_t i = 0; i < PreviewKeeper::kWaitingMax + 2; ++i) {
        ids.push_back(submit(*service, kLong));
        ASSERT_TRUE(eventually([&] { return service->find(ids.back())->blocks_done > 0; }));
        EXPECT_TRUE(service->cancel(ids.back()));
    }
    // The last two have ended, but their workers wait to hand the previews over.
    EXPECT_TRUE(eventually([&] {
        return is_ended(*service, ids.back()) && service->running_count() == 2;
    }));
    artifacts_.let_go();
    service.reset();
    for (const std::string& id : ids) {
        EXPECT_TRUE(store_.jobs().artifact(id, kPreviewArtifact)) << id;
    }
}

}  // namespace
}  // namespace modelsynth::server
