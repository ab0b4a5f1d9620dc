#pragma once

// The contract of the store as tests over a factory: a backend gives its settings and has every
// suite below run on them (INSTANTIATE_TEST_SUITE_P in a file of its own).

#include "server/store/artifact_store.h"
#include "server/store/delivery_store.h"
#include "server/store/event_log.h"
#include "server/store/job_store.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace modelsynth::server {

// A time for what is submitted, claimed and ended; nothing in the tests is later than the clock.
inline constexpr proto::UnixMillis kNow = 1'000'000;
inline constexpr proto::UnixMillis kRetentionMs = 50'000;  // a factory's stores are opened with it
inline constexpr QueueLimits kNoLimit = {1'000'000};

// A store as the tests see it, whatever is behind it.
class StoreUnderTest {
  public:
    virtual ~StoreUnderTest() = default;
    virtual JobStore& jobs() = 0;
    virtual EventLog& events() = 0;
    virtual ArtifactStore& artifacts() = 0;
    virtual ExampleStore& examples() = 0;
    virtual DeliveryStore& deliveries() = 0;
    // Closes the store and opens it again. No lease, pin or subscription may be in use.
    virtual void reopen() = 0;
};

struct StoreSetting {
    std::string name;
    std::function<std::unique_ptr<StoreUnderTest>()> make;
    bool is_reopened = false;     // between the steps of a test
    std::size_t other_count = 0;  // jobs that are in it before the test
};

std::ostream& operator<<(std::ostream& out, const StoreSetting& setting);
std::ostream& operator<<(std::ostream& out, StoreErrorCode code);

// The value, or the test fails with the error's message.
template <class T>
T value(Stored<T> stored) {
    if (!stored) {
        throw std::runtime_error("the store answered: " + stored.error().message);
    }
    if constexpr (!std::is_void_v<T>) {
        return std::move(*stored);
    }
}

// Nothing when the call went well.
template <class T>
std::optional<StoreErrorCode> error_of(const Stored<T>& stored) {
    return stored ? std::nullopt : std::optional(stored.error().code);
}

using EventTuple = std::tuple<std::uint64_t, std::string, std::string, proto::UnixMillis>;

[[nodiscard]] EventTuple tuple_of(const Event& event);
[[nodiscard]] std::vector<EventTuple> tuples_of(const std::vector<Event>& events);

// A job to submit, created at kNow.
[[nodiscard]] NewJob new_job(std::string id, std::int32_t priority = 0);
[[nodiscard]] NewJob keyed_job(std::string id, std::string key, std::string hash);

[[nodiscard]] NewEvent block_event(std::size_t index);
[[nodiscard]] Progress progress_of(std::uint32_t blocks_done);
[[nodiscard]] Outcome succeeded(std::vector<ArtifactLink> artifacts = {});
[[nodiscard]] Outcome failed();

// The same on every run.
[[nodiscard]] std::string random_bytes(std::size_t count, std::uint64_t seed);

// Text that storing could spoil: NUL bytes, several scripts, 64 KiB.
[[nodiscard]] std::string hard_text(std::string_view salt);

// Appends and waits for the commit.
Stored<std::uint64_t> append(
    JobStore& jobs,
    const Lease& lease,
    std::vector<NewEvent> events,
    const Progress& progress = progress_of(1)
);

// The whole log, read in pages; the test fails unless it is gapless from 1 to the head.
[[nodiscard]] std::vector<Event> whole_log(EventLog& events, const std::string& id);

// Runs `work` with 0, 1, ... on as many threads, which begin together.
void run_together(std::size_t count, const std::function<void(std::size_t)>& work);

// Whether it comes true, within a time that only a fault uses up.
[[nodiscard]] bool eventually(const std::function<bool()>& is_true);

class StoreSuite : public testing::TestWithParam<StoreSetting> {
  protected:
    void SetUp() override;

    [[nodiscard]] JobStore& jobs() { return store_->jobs(); }

    [[nodiscard]] EventLog& events() { return store_->events(); }

    [[nodiscard]] ArtifactStore& artifacts() { return store_->artifacts(); }

    [[nodiscard]] ExampleStore& examples() { return store_->examples(); }

    [[nodiscard]] DeliveryStore& deliveries() { return store_->deliveries(); }

    // The end of a step: a setting may open the store again here. As reopen().
    void between_steps();

    void reopen() { store_->reopen(); }

    // Waits until what earlier calls left to do behind them is done.
    void settle();

    Submitted submit(const NewJob& job) { return value(jobs().submit(job, kNoLimit)); }

    proto::Job find(const std::string& id) { return value(jobs().find(id)); }

    // Nothing when only jobs are queued that were there before the test.
    std::optional<Claim> claim(proto::UnixMillis now = kNow);
    // A new job, claimed.
    Claim submit_and_claim(const std::string& id);
    // Ids of the test's own jobs, newest first, in pages of `limit`.
    std::vector<std::string> listed(
        std::optional<proto::JobState> state = std::nullopt, std::size_t limit = 20
    );
    [[nodiscard]] bool is_own(const std::string& id) const;

    std::vector<Event> log(const std::string& id) { return whole_log(events(), id); }

  private:
    void add_others(std::size_t count);

    std::unique_ptr<StoreUnderTest> store_;
};

class JobContract : public StoreSuite {};

class ClaimContract : public StoreSuite {};

class ProgressContract : public StoreSuite {};

class EventContract : public StoreSuite {};

class ArtifactContract : public StoreSuite {};

class ExampleContract : public StoreSuite {};

class DeliveryContract : public StoreSuite {};

}  // namespace modelsynth::server
