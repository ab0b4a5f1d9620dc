#pragma once

#include "server/store/sqlite/database.h"
#include "server/store/types.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace modelsynth::server {

// The one thread that commits and checkpoints. It drains a bounded queue of operations into one
// transaction each time (group commit), every operation in a savepoint of its own so that one
// that fails does not spoil the rest, and tells the outcome only after the commit.
class Writer {
  public:
    // Whether somebody waits for the commit. One that nobody waits for goes with the next that
    // somebody does, and else with what has gathered kGathering after the commit before: a solver
    // logs blocks faster than a disk syncs, and each sync takes processor time from the solvers.
    enum class Haste { kSomebodyWaits, kNobodyWaits };

    struct Operation {
        // Changes the database. An error takes back what this operation did.
        std::function<Stored<void>(Database&)> apply;
        // Told after the commit, on the writer's thread, in order of submission.
        std::function<void(Stored<void>)> done;
        Haste haste = Haste::kSomebodyWaits;
    };

    static constexpr std::chrono::milliseconds kGathering{20};

    explicit Writer(const std::string& path, std::chrono::milliseconds gathering = kGathering);
    ~Writer();

    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    // Blocks while the queue is full, but not on the writer's own thread, which alone makes room.
    // After close(), `done` is told kClosed at once.
    void post(Operation operation);

    // Runs `change` and waits for its commit.
    template <class T>
    Stored<T> call(std::function<Stored<T>(Database&)> change) {
        std::promise<Stored<T>> promise;
        auto future = promise.get_future();
        auto value = std::make_shared<Stored<T>>(tl::unexpected(StoreError{}));
        post(
            {[value, &change](Database& database) -> Stored<void> {
                 *value = change(database);
                 if (!*value) {
                     return tl::unexpected(value->error());
                 }
                 return {};
             },
             [value, &promise](Stored<void> committed) {
                 if (!committed) {
                     promise.set_value(tl::unexpected(std::move(committed.error())));
                 } else {
                     promise.set_value(std::move(*value));
                 }
             }}
        );
        return future.get();
    }

    // Runs on the writer's thread after each commit, once the operations were told.
    void after_commit(std::function<void(Database&)> hook) { after_commit_ = std::move(hook); }

    // Told on the writer's thread how long each commit took.
    void on_commit(std::function<void(double seconds)> told) { on_commit_ = std::move(told); }

    // Finishes what is queued and stops.
    void close();

  private:
    using Clock = std::chrono::steady_clock;

    void run();
    bool is_time_to_commit() const;
    void commit(std::deque<Operation>& batch);

    static constexpr std::size_t kQueueMax = 4096;
    static constexpr std::size_t kBatchMax = 512;
    static constexpr int kCheckpointPages = 1000;

    Database database_;
    std::function<void(Database&)> after_commit_;
    std::function<void(double)> on_commit_;
    std::mutex mutex_;
    std::condition_variable work_;
    std::condition_variable room_;
    std::deque<Operation> queue_;
    std::size_t waited_for_ = 0;  // of the queue's operations, how many somebody waits for
    bool closed_ = false;
    std::chrono::milliseconds gathering_;
    Clock::time_point committed_;  // the last time
    std::thread::id own_id_;       // of thread_, which changes when it is joined
    std::thread thread_;
};

}  // namespace modelsynth::server
