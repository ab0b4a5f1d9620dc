// Random operations on the embedded store and on a model of it give the same answers.
// MODELSYNTH_STORE_OPERATIONS: how many for each seed.

#include "tests/unit/server/store_model.h"

#include "tests/unit/server/embedded_store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <sstream>

namespace modelsynth::server {

namespace {

constexpr proto::UnixMillis kLongAgo = 1'000'000'000;  // times of the test; the clock's are later

// Times that the store takes from the clock are not compared.
std::string text_of(const std::optional<proto::UnixMillis>& time) {
    return !time ? "-" : *time > 2 * kLongAgo ? "clock" : std::to_string(*time);
}

std::string text_of(const proto::Job& job) {
    std::ostringstream text;
    const bool is_by_clock = text_of(job.finished) == "clock";
    text << job.id << ' ' << proto::state_name(job.state) << ' ' << job.solver << ' ' << job.seed
         << ' ' << job.created << ' ' << text_of(job.started) << ' ' << text_of(job.finished) << ' '
         << (is_by_clock ? "clock" : text_of(job.expires)) << ' ' << job.blocks_done << '/'
         << job.blocks_total << ' ' << job.request << ' ' << job.result << ' ' << job.error << ' '
         << job.head;
    return text.str();
}

std::string text_of(const std::optional<JobCheckpoint>& checkpoint) {
    std::ostringstream text;
    if (checkpoint) {
        text << checkpoint->seq << ' ' << checkpoint->blocks_done << ' ' << checkpoint->tally << ' '
             << checkpoint->labels;
    }
    return text.str();
}

std::string text_of(const std::vector<Event>& events) {
    std::ostringstream text;
    for (const Event& event : events) {
        text << event.seq << ' ' << event.type << ' ' << event.fields << ' ' << text_of(event.time)
             << '\n';
    }
    return text.str();
}

std::string text_of(const std::optional<Claim>& claim) {
    std::ostringstream text;
    if (claim) {
        text << claim->lease.token << ' ' << text_of(claim->job) << ' '
             << claim->deadline_seconds.value_or(-1) << ' ' << claim->solved_seconds << ' '
             << claim->solver_version << ' ' << claim->version_base << ' ' << claim->head << ' '
             << claim->fruitless_claims << ' ' << claim->cost << ' ' << claim->memory_bytes << ' '
             << text_of(claim->checkpoint);
    }
    return text.str();
}

std::string text_of(const Submitted& submitted) {
    return text_of(submitted.job) + (submitted.replayed ? " replayed" : "");
}

std::string text_of(std::uint64_t seq) { return std::to_string(seq); }

template <class T>
std::string answer_of(const Stored<T>& stored) {
    if (!stored) {
        std::ostringstream text;
        text << stored.error().code;
        return text.str();
    }
    if constexpr (std::is_void_v<T>) {
        return "done";
    } else {
        return text_of(*stored);
    }
}

// Does the same to both and compares at once.
class Comparison {
  public:
    explicit Comparison(std::uint64_t seed) : random_(seed), model_(keep_digests(), kRetentionMs) {}

    void step() {
        now_ += static_cast<proto::UnixMillis>(below(20'000));
        switch (below(20)) {
            case 0:
            case 1:
            case 2:
            case 3:
                return submit();
            case 4:
            case 5:
            case 6:
                return claim();
            case 7:
            case 8:
            case 9:
            case 10:
            case 11:
                return append();
            case 12:
            case 13:
            case 14:
                return finish();
            case 15:
                return release();
            case 16:
                return cancel();
            case 17:
                return erase();
            case 18:
                return link();
            default:
                return below(3) == 0 ? reopen() : expire();
        }
    }

    // All that can be seen of every job.
    void compare_all() {
        const auto& rows = model_.rows();
        std::vector<std::string> expected;
        for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
            expected.push_back(text_of(row->job));
            compare(*row);
        }
        std::vector<std::string> listed;
        JobQuery query{{}, std::nullopt, 1 + below(20), ""};
        for (;;) {
            const JobPage page = value(store_.jobs().list(query));
            for (const proto::Job& job : page.jobs) {
                listed.push_back(text_of(job));
            }
            if (!page.next) {
                break;
            }
            query.cursor = *page.next;
        }
        EXPECT_EQ(listed, expected);
        const auto queued_count = std::count_if(rows.begin(), rows.end(), [](const auto& row) {
            return row.job.state == proto::JobState::kQueued;
        });
        EXPECT_EQ(value(store_.jobs().queued_count()), static_cast<std::size_t>(queued_count));
    }

  private:
    // Two contents that an example each keeps for good.
    std::set<std::string> keep_digests() {
        std::set<std::string> digests;
        for (const char* content : {"one", "two"}) {
            const auto pin = value(store_.artifacts().put(content));
            value(store_.examples().add_example({content, content, pin->digest()}, "", 2));
            digests.insert(pin->digest());
        }
        return digests;
    }

    std::size_t below(std::size_t bound) { return random_() % bound; }

    std::string any_digest() {
        return below(8) == 0 ? sha256_hex("none") : sha256_hex(below(2) == 0 ? "one" : "two");
    }

    // Mostly one that is there.
    std::string any_id() {
        const auto& rows = model_.rows();
        return rows.empty() || below(10) == 0 ? "gone" : rows[below(rows.size())].job.id;
    }

    // Mostly one that was given out lately.
    Lease any_lease() {
        if (leases_.empty()) {
            return {"none", 1};
        }
        return leases_[leases_.size() - 1 - below(std::min<std::size_t>(leases_.size(), 8))];
    }

    void submit() {
        NewJob job = new_job("job" + std::to_string(submitted_count_++));
        job.seed = random_();
        job.priority = static_cast<std::int32_t>(below(4)) - 2;
        job.created = now_;
        if (below(2) == 0) {
            job.idempotency_key = "key" + std::to_string(below(30));
            job.request_hash = below(5) == 0 ? "other" : "hash";
        }
        if (below(2) == 0) {
            job.deadline_seconds = static_cast<double>(below(100));
        }
        for (const char* name : {"origin", "example"}) {
            if (below(4) == 0) {
                job.artifacts.push_back({name, any_digest()});
            }
        }
        job.owner = std::string(1, static_cast<char>('a' + below(3)));
        job.cost = 1 + below(10);
        job.memory_bytes = below(10);
        const QueueLimits limits = {15, 4 + below(12)};
        EXPECT_EQ(
            answer_of(store_.jobs().submit(job, limits)), answer_of(model_.submit(job, limits))
        );
    }

    void claim() {
        ClaimLimits limits;
        if (below(2) == 0) {
            limits = {below(10), 1 + below(10)};
        }
        const auto claimed = value(store_.jobs().claim(now_, limits));
        EXPECT_EQ(text_of(claimed), text_of(model_.claim(now_, limits)));
        if (claimed) {
            leases_.push_back(claimed->lease);
        }
    }

    void append() {
        const Lease lease = any_lease();
        std::vector<NewEvent> events(below(4), {"started", "{}", now_});
        for (NewEvent& event : events) {
            if (below(3) > 0) {
                event = {"block", "{\"n\":" + std::to_string(below(1000)) + "}", now_};
            }
        }
        Progress progress = progress_of(static_cast<std::uint32_t>(below(100)));
        progress.solved_seconds = static_cast<double>(below(100));
        progress.solver_version = "v" + std::to_string(below(3));
        if (below(3) == 0) {
            progress.checkpoint =
                JobCheckpoint{0, progress.blocks_done, "1", "labels" + std::to_string(below(1000))};
        }
        for (const char* name : {"labels", "labels.1", "nodes.glb", "example"}) {
            if (below(6) == 0) {
                progress.artifacts.push_back({name, any_digest()});
            }
        }
        EXPECT_EQ(
            answer_of(server::append(store_.jobs(), lease, events, progress)),
            answer_of(model_.append(lease, events, progress))
        );
    }

    void finish() {
        const Lease lease = any_lease();
        Outcome outcome = below(2) == 0 ? succeeded() : failed();
        outcome.finished = now_;
        for (const char* name : {"labels", "nodes.glb", "example", "preview"}) {
            if (below(2) == 0) {
                outcome.artifacts.push_back({name, any_digest()});
            }
        }
        EXPECT_EQ(
            answer_of(store_.jobs().finish(lease, outcome)),
            answer_of(model_.finish(lease, outcome))
        );
    }

    void release() {
        const Lease lease = any_lease();
        const auto solved_seconds = static_cast<double>(below(100));
        EXPECT_EQ(
            answer_of(store_.jobs().release(lease, solved_seconds)),
            answer_of(model_.release(lease, solved_seconds))
        );
    }

    void cancel() {
        const std::string id = any_id();
        EXPECT_EQ(answer_of(store_.jobs().cancel(id, now_)), answer_of(model_.cancel(id, now_)));
    }

    void erase() {
        const std::string id = any_id();
        EXPECT_EQ(answer_of(store_.jobs().erase(id)), answer_of(model_.erase(id)));
    }

    void link() {
        const std::string id = any_id();
        constexpr std::array kNames = {"preview", "preview0", "preview1"};
        const ArtifactLink link{kNames.at(below(kNames.size())), any_digest()};
        EXPECT_EQ(answer_of(store_.jobs().link(id, link)), answer_of(model_.link(id, link)));
    }

    void expire() {
        store_.jobs().expire(now_);
        model_.expire(now_);
    }

    void reopen() {
        store_.reopen();
        model_.reopen();
    }

    void compare(const StoreModel::Row& row) {
        const std::string& id = row.job.id;
        EXPECT_EQ(answer_of(store_.jobs().find(id)), text_of(row.job));
        EXPECT_EQ(text_of(whole_log(store_.events(), id)), text_of(row.events));
        EXPECT_EQ(
            value(store_.events().read(id, below(5), 1)).ended, proto::is_ended(row.job.state)
        );
        EXPECT_EQ(text_of(value(store_.jobs().checkpoint(id))), text_of(row.checkpoint));
        for (const char* name :
             {"labels",
              "labels.1",
              "nodes.glb",
              "example",
              "origin",
              "preview",
              "preview0",
              "preview1"}) {
            const auto expected = row.artifacts.find(name);
            const auto digest = store_.jobs().artifact(id, name);
            EXPECT_EQ(digest.has_value(), expected != row.artifacts.end()) << id << ' ' << name;
            if (digest && expected != row.artifacts.end()) {
                EXPECT_EQ(*digest, expected->second);
            }
        }
    }

    std::mt19937_64 random_;
    EmbeddedStore store_;
    StoreModel model_;
    std::vector<Lease> leases_;
    std::size_t submitted_count_ = 0;
    proto::UnixMillis now_ = kLongAgo;
};

std::size_t operation_count() {
    const char* chosen = std::getenv("MODELSYNTH_STORE_OPERATIONS");
    return chosen == nullptr ? 500 : std::strtoul(chosen, nullptr, 10);
}

class StoreModelTest : public testing::TestWithParam<std::uint64_t> {};

}  // namespace

TEST_P(StoreModelTest, RandomOperationsGiveTheSameAnswers) {
    Comparison comparison(GetParam());
    const std::size_t count = operation_count();
    for (std::size_t i = 0; i < count; ++i) {
        SCOPED_TRACE(testing::Message() << "seed " << GetParam() << " operation " << i);
        comparison.step();
        if (i % 25 == 24 || i + 1 == count) {
            comparison.compare_all();
        }
        ASSERT_FALSE(HasFailure());
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, StoreModelTest, testing::Range<std::uint64_t>(1, 5));

}  // namespace modelsynth::server
