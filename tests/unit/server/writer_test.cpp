// The writer's queue at its edge.

#include "server/store/sqlite/writer.h"

#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <thread>
#include <utility>

namespace modelsynth::server {

namespace {

// Of the queue, as the writer has it.
constexpr int kQueueMax = 4096;

Writer::Operation telling(std::function<void(Stored<void>)> done) {
    return {[](Database&) -> Stored<void> { return {}; }, std::move(done)};
}

Writer::Operation unhurried(std::function<void(Stored<void>)> done) {
    Writer::Operation operation = telling(std::move(done));
    operation.haste = Writer::Haste::kNobodyWaits;
    return operation;
}

// A pin that goes with what `done` holds asks the writer to forget it.
TEST(Writer, TakesWhatItsOwnThreadPostsWhileTheQueueIsFull) {
    const TemporaryDirectory directory;
    Writer writer(directory.database());
    std::promise<void> begun;
    std::promise<void> filled;
    std::promise<void> posted;
    int told = 0;
    writer.post(telling([&](Stored<void> outcome) {
        EXPECT_TRUE(outcome);
        begun.set_value();
        filled.get_future().wait();
        writer.post(telling([&](Stored<void> later) { told += later ? 1 : 0; }));
        posted.set_value();
    }));
    begun.get_future().wait();
    for (int i = 0; i < kQueueMax; ++i) {
        writer.post(telling([&](Stored<void> outcome) { told += outcome ? 1 : 0; }));
    }
    filled.set_value();
    // Else it waits for itself, until it is closed.
    const bool is_in_time =
        posted.get_future().wait_for(std::chrono::minutes(1)) == std::future_status::ready;
    EXPECT_TRUE(is_in_time);
    writer.close();
    EXPECT_EQ(told, kQueueMax + 1);
}

TEST(Writer, TellsEveryOperationOnceThoughItIsClosedWhileOthersPost) {
    const TemporaryDirectory directory;
    Writer writer(directory.database());
    std::atomic<bool> is_closed = false;
    std::atomic<int> posted = 0;
    std::atomic<int> told = 0;
    const auto post_all_the_time = [&] {
        while (!is_closed) {
            ++posted;
            writer.post(telling([&](Stored<void> outcome) {
                EXPECT_TRUE(outcome || outcome.error().code == StoreErrorCode::kClosed);
                ++told;
            }));
        }
    };
    std::thread one(post_all_the_time);
    std::thread other(post_all_the_time);
    while (told == 0) {
        std::this_thread::yield();
    }
    writer.close();
    is_closed = true;
    one.join();
    other.join();
    EXPECT_EQ(told, posted);
}

class WriterOfALongGathering : public testing::Test {
  protected:
    WriterOfALongGathering() : writer_(directory_.database(), std::chrono::hours(1)) {
        writer_.on_commit([this](double) { ++commits_; });
    }

    void post_unhurried() {
        writer_.post(unhurried([this](Stored<void> outcome) { told_ += outcome ? 1 : 0; }));
    }

    // Returns once `operations` were posted and one more after them, that is waited for.
    void post_and_call(int operations) {
        for (int i = 0; i < operations; ++i) {
            post_unhurried();
            std::this_thread::yield();
        }
        ASSERT_TRUE(writer_.call<int>([](Database&) -> Stored<int> { return 0; }));
    }

    std::atomic<int> commits_ = 0;
    std::atomic<int> told_ = 0;
    TemporaryDirectory directory_;
    Writer writer_;  // last: its thread uses the others
};

TEST_F(WriterOfALongGathering, CommitsWhatNobodyWaitsForWithTheNextThatSomebodyDoes) {
    constexpr int kCalls = 50;
    constexpr int kOperations = 10;
    post_and_call(0);
    for (int i = 1; i <= kCalls; ++i) {
        post_and_call(kOperations);
        EXPECT_EQ(commits_, 1 + i);
    }
    writer_.close();
    EXPECT_EQ(told_, kCalls * kOperations);
    EXPECT_EQ(commits_, 1 + kCalls);
}

TEST_F(WriterOfALongGathering, CommitsWhatNobodyWaitsForWhenItIsClosed) {
    post_and_call(0);
    post_unhurried();
    writer_.close();
    EXPECT_EQ(told_, 1);
}

TEST(Writer, CommitsWhatNobodyWaitsForOnceItHasGathered) {
    const TemporaryDirectory directory;
    Writer writer(directory.database());
    for (int i = 0; i < 3; ++i) {
        std::promise<Stored<void>> told;
        writer.post(unhurried([&](Stored<void> outcome) { told.set_value(std::move(outcome)); }));
        EXPECT_TRUE(told.get_future().get());
    }
}

}  // namespace

}  // namespace modelsynth::server
