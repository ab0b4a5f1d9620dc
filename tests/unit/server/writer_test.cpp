// The writer's queue at its edge.

#include "server/store/sqlite/writer.h"

#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

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

}  // namespace

}  // namespace modelsynth::server
