#include "tests/unit/server/store_suite.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <latch>
#include <limits>
#include <ostream>
#include <random>
#include <thread>

namespace modelsynth::server {

namespace {

constexpr std::string_view kOther = "other-";

}  // namespace

std::ostream& operator<<(std::ostream& out, const StoreSetting& setting) {
    return out << setting.name;
}

std::ostream& operator<<(std::ostream& out, StoreErrorCode code) {
    switch (code) {
        case StoreErrorCode::kNotFound:
            return out << "kNotFound";
        case StoreErrorCode::kConflict:
            return out << "kConflict";
        case StoreErrorCode::kQueueFull:
            return out << "kQueueFull";
        case StoreErrorCode::kOwnerFull:
            return out << "kOwnerFull";
        case StoreErrorCode::kWebhooksFull:
            return out << "kWebhooksFull";
        case StoreErrorCode::kLeaseLost:
            return out << "kLeaseLost";
        case StoreErrorCode::kInvalid:
            return out << "kInvalid";
        case StoreErrorCode::kCorrupt:
            return out << "kCorrupt";
        case StoreErrorCode::kUnavailable:
            return out << "kUnavailable";
        case StoreErrorCode::kClosed:
            return out << "kClosed";
    }
    return out << "?";
}

EventTuple tuple_of(const Event& event) {
    return {event.seq, event.type, event.fields, event.time};
}

std::vector<EventTuple> tuples_of(const std::vector<Event>& events) {
    std::vector<EventTuple> tuples;
    std::transform(events.begin(), events.end(), std::back_inserter(tuples), tuple_of);
    return tuples;
}

NewJob new_job(std::string id, std::int32_t priority) {
    NewJob job;
    job.request_hash = "hash of " + id;
    job.id = std::move(id);
    job.solver = "discrete";
    job.seed = 7;
    job.priority = priority;
    job.request = R"({"solver":"discrete"})";
    job.created = kNow;
    return job;
}

NewJob keyed_job(std::string id, std::string key, std::string hash) {
    NewJob job = new_job(std::move(id));
    job.idempotency_key = std::move(key);
    job.request_hash = std::move(hash);
    return job;
}

NewEvent block_event(std::size_t index) {
    return {"block", "{\"index\":" + std::to_string(index) + "}", kNow + 1};
}

Progress progress_of(std::uint32_t blocks_done) {
    Progress progress;
    progress.blocks_done = blocks_done;
    progress.blocks_total = 100;
    progress.solved_seconds = 0.25;
    progress.solver_version = "v1";
    return progress;
}

Outcome succeeded(std::vector<ArtifactLink> artifacts) {
    Outcome outcome;
    outcome.state = proto::JobState::kSucceeded;
    outcome.result = R"({"bytes":1})";
    outcome.artifacts = std::move(artifacts);
    outcome.finished = kNow + 2;
    return outcome;
}

Outcome failed() {
    Outcome outcome;
    outcome.state = proto::JobState::kFailed;
    outcome.error = R"({"title":"no"})";
    outcome.finished = kNow + 2;
    return outcome;
}

std::string random_bytes(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::string bytes(count, '\0');
    for (char& byte : bytes) {
        byte = static_cast<char>(random() & 0xff);
    }
    return bytes;
}

std::string hard_text(std::string_view salt) {
    std::string text(salt);
    text += '\0';
    text += "Gr\xc3\xbc\xc3\x9f \xe6\xa8\xa1\xe5\x9e\x8b \xf0\x9f\x8f\xb0 '\"\\;--%s\n";
    while (text.size() < std::size_t{64} * 1024) {
        text += text;
    }
    return text;
}

Stored<std::uint64_t> append(
    JobStore& jobs, const Lease& lease, std::vector<NewEvent> events, const Progress& progress
) {
    std::promise<Stored<std::uint64_t>> told;
    jobs.append(lease, std::move(events), progress, [&told](const Stored<std::uint64_t>& first) {
        told.set_value(first);
    });
    return told.get_future().get();
}

std::vector<Event> whole_log(EventLog& events, const std::string& id) {
    std::vector<Event> log;
    for (;;) {
        EventPage page = value(events.read(id, log.size(), 100));
        for (Event& event : page.events) {
            EXPECT_EQ(event.seq, log.size() + 1) << id;
            log.push_back(std::move(event));
        }
        if (log.size() >= page.head || page.events.empty()) {
            EXPECT_EQ(log.size(), page.head) << id;
            return log;
        }
    }
}

void run_together(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::latch begin(static_cast<std::ptrdiff_t>(count));
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i) {
        threads.emplace_back([&begin, &work, i] {
            begin.arrive_and_wait();
            work(i);
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
}

bool eventually(const std::function<bool()>& is_true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_true()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

void StoreSuite::SetUp() {
    store_ = GetParam().make();
    add_others(GetParam().other_count);
}

void StoreSuite::between_steps() {
    if (GetParam().is_reopened) {
        store_->reopen();
    }
}

void StoreSuite::settle() {
    // The second call begins after all that belongs to the first one's commit.
    jobs().expire(0);
    jobs().expire(0);
}

std::optional<Claim> StoreSuite::claim(proto::UnixMillis now) {
    auto claim = value(jobs().claim(now, {}));
    if (claim && !is_own(claim->lease.job_id)) {
        value(jobs().release(claim->lease, 0));
        return std::nullopt;
    }
    return claim;
}

Claim StoreSuite::submit_and_claim(const std::string& id) {
    submit(new_job(id));
    auto claimed = claim();
    if (!claimed || claimed->lease.job_id != id) {
        throw std::runtime_error("another job than " + id + " was claimed");
    }
    return std::move(*claimed);
}

std::vector<std::string> StoreSuite::listed(
    std::optional<proto::JobState> state, std::size_t limit
) {
    std::vector<std::string> ids;
    JobQuery query{{}, state, limit, ""};
    for (;;) {
        const JobPage page = value(jobs().list(query));
        EXPECT_LE(page.jobs.size(), limit);
        for (const proto::Job& job : page.jobs) {
            if (is_own(job.id)) {
                ids.push_back(job.id);
            }
        }
        if (!page.next) {
            return ids;
        }
        query.cursor = *page.next;
    }
}

bool StoreSuite::is_own(const std::string& id) const { return !id.starts_with(kOther); }

void StoreSuite::add_others(std::size_t count) {
    constexpr std::size_t kThreads = 16;
    // A quarter stays queued, after all that a test submits.
    run_together(kThreads, [this, count](std::size_t thread) {
        for (std::size_t i = thread; i < count; i += kThreads) {
            NewJob job = new_job(std::string(kOther) + std::to_string(i));
            job.owner = "somebody else";
            job.priority = std::numeric_limits<std::int32_t>::min();
            job.created = 1'000'000'000'000'000;
            job.idempotency_key = job.id;
            value(jobs().submit(job, kNoLimit));
        }
    });
    run_together(kThreads, [this, count](std::size_t thread) {
        for (std::size_t i = thread; i < count * 3 / 4; i += kThreads) {
            const auto claimed = value(jobs().claim(kNow, {}));
            value(append(jobs(), claimed->lease, {block_event(0)}));
            if (i % 3 == 0) {
                value(jobs().finish(claimed->lease, failed()));
            } else if (i % 3 == 1) {
                value(jobs().cancel(claimed->lease.job_id, kNow));
                value(jobs().finish(claimed->lease, succeeded()));
            }  // the last third stays running
        }
    });
}

}  // namespace modelsynth::server
