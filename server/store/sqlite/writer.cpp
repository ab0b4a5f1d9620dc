#include "server/store/sqlite/writer.h"

#include "server/store/sqlite/job_rows.h"

#include <pthread.h>

#include <chrono>
#include <vector>

namespace modelsynth::server {

namespace {

// Applies one operation, or leaves no trace of it.
Stored<void> apply_in_savepoint(Database& database, const Writer::Operation& operation) {
    database.prepare("SAVEPOINT operation").run();
    Stored<void> outcome;
    try {
        outcome = operation.apply(database);
    } catch (const SqliteError& error) {
        outcome = failure(StoreErrorCode::kUnavailable, error.what());
    }
    if (!outcome) {
        database.prepare("ROLLBACK TO operation").run();
    }
    database.prepare("RELEASE operation").run();
    return outcome;
}

bool is_waited_for(const Writer::Operation& operation) {
    return operation.haste == Writer::Haste::kSomebodyWaits;
}

}  // namespace

Writer::Writer(const std::string& path, std::chrono::milliseconds gathering)
    : database_(path, Database::Mode::kWriter), gathering_(gathering) {
    thread_ = std::thread([this] {
        ::pthread_setname_np(::pthread_self(), "store");
        run();
    });
}

Writer::~Writer() { close(); }

void Writer::post(Operation operation) {
    {
        std::unique_lock lock(mutex_);
        const bool is_own_thread = std::this_thread::get_id() == own_id_;
        room_.wait(lock, [&] { return queue_.size() < kQueueMax || closed_ || is_own_thread; });
        if (!closed_) {
            waited_for_ += is_waited_for(operation) ? 1U : 0U;
            queue_.push_back(std::move(operation));
            if (queue_.size() == 1 || is_time_to_commit()) {
                work_.notify_one();
            }
            return;
        }
    }
    operation.done(tl::unexpected(StoreError{StoreErrorCode::kClosed, "the store is closed"}));
}

void Writer::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        work_.notify_one();
        room_.notify_all();
    }
    if (thread_.joinable()) {
        thread_.join();
    }
}

bool Writer::is_time_to_commit() const {
    return waited_for_ > 0 || queue_.size() >= kBatchMax || closed_;
}

void Writer::run() {
    constexpr auto kIdle = std::chrono::seconds(5);
    {
        const std::lock_guard lock(mutex_);
        own_id_ = std::this_thread::get_id();
    }
    for (;;) {
        std::deque<Operation> batch;
        {
            std::unique_lock lock(mutex_);
            const bool has_work =
                work_.wait_for(lock, kIdle, [this] { return !queue_.empty() || closed_; });
            if (has_work) {
                work_.wait_until(lock, committed_ + gathering_, [this] {
                    return is_time_to_commit();
                });
            }
            while (!queue_.empty() && batch.size() < kBatchMax) {
                waited_for_ -= is_waited_for(queue_.front()) ? 1U : 0U;
                batch.push_back(std::move(queue_.front()));
                queue_.pop_front();
            }
            room_.notify_all();
            if (batch.empty() && closed_) {
                break;
            }
            if (!has_work && database_.wal_pages() == 0) {
                continue;
            }
        }
        if (batch.empty()) {
            database_.checkpoint(true);
        } else {
            commit(batch);
            committed_ = Clock::now();
        }
    }
    database_.checkpoint(true);
}

void Writer::commit(std::deque<Operation>& batch) {
    const auto begun = std::chrono::steady_clock::now();
    std::vector<Stored<void>> outcomes;
    try {
        database_.prepare("BEGIN IMMEDIATE").run();
        for (const Operation& operation : batch) {
            outcomes.push_back(apply_in_savepoint(database_, operation));
        }
        database_.prepare("COMMIT").run();
    } catch (const SqliteError& error) {
        try {
            database_.execute("ROLLBACK");
        } catch (const SqliteError&) {
            // There was no transaction; nothing is left to take back.
        }
        outcomes.assign(batch.size(), failure(StoreErrorCode::kUnavailable, error.what()));
    }
    if (on_commit_) {
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
        on_commit_(took.count());
    }
    for (std::size_t i = 0; i < batch.size(); ++i) {
        batch[i].done(std::move(outcomes[i]));
    }
    if (after_commit_) {
        after_commit_(database_);
    }
    if (database_.wal_pages() > kCheckpointPages) {
        database_.checkpoint(false);
    }
}

}  // namespace modelsynth::server
