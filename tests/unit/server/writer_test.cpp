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

}  // namespace

}  // namespace modelsynth::server
