// The event log of the embedded store.

#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace modelsynth::server {

using proto::Job;
using proto::JobState;
using proto::UnixMillis;

// Registers itself; both ends hold the store's mutex, so that a callback is never running when
// the destructor returns.
class SqliteStore::Listener final : public EventLog::Subscription {
  public:
    Listener(
        SqliteStore& store, const std::string& job_id, News wanted, std::function<void()> changed
    )
        : store_(store), wanted_(wanted), changed_(std::move(changed)) {
        const std::lock_guard lock(store_.listeners_mutex_);
        place_ = store_.listeners_.emplace(job_id, this);
    }

    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    ~Listener() override {
        const std::lock_guard lock(store_.listeners_mutex_);
        store_.listeners_.erase(place_);
    }

    void tell(News news) const {
        if (wanted_ == News::kAny || news == News::kEnd) {
            changed_();
        }
    }

  private:
    SqliteStore& store_;
    News wanted_;
    std::function<void()> changed_;
    ListenerMap::iterator place_;
};

Stored<EventPage> SqliteStore::read(
    const std::string& job_id, std::uint64_t after, std::size_t limit
) {
    return with_reader<EventPage>([&](Database& database) -> Stored<EventPage> {
        EventPage page;
        {
            Statement row = database.prepare("SELECT next_seq, state FROM job WHERE id = ?");
            row.bind(std::string_view(job_id));
            if (!row.step()) {
                return no_job(job_id);
            }
            page.head = row.natural(0) - 1;
            page.ended = proto::is_ended(static_cast<JobState>(row.integer(1)));
        }
        Statement rows = database.prepare(
            "SELECT seq, type, fields, time FROM event WHERE job_id = ? AND seq > ? "
            "ORDER BY seq LIMIT ?"
        );
        rows.bind(std::string_view(job_id))
            .bind(static_cast<std::int64_t>(
                std::min<std::uint64_t>(after, std::numeric_limits<std::int64_t>::max())
            ))
            .bind(std::uint64_t{limit});
        while (rows.step()) {
            page.events.push_back({rows.natural(0), rows.text(1), rows.text(2), rows.integer(3)});
        }
        return page;
    });
}

std::unique_ptr<EventLog::Subscription> SqliteStore::subscribe(
    const std::string& job_id, News news, std::function<void()> changed
) {
    return std::make_unique<Listener>(*this, job_id, news, std::move(changed));
}

void SqliteStore::touch(const std::string& id, News news) {
    News& known = touched_.emplace(id, news).first->second;
    known = std::max(known, news);
}

void SqliteStore::tell_listeners(const std::map<std::string, News>& jobs) {
    const std::lock_guard lock(listeners_mutex_);
    for (const auto& [id, news] : jobs) {
        const auto [first, last] = listeners_.equal_range(id);
        for (auto listener = first; listener != last; ++listener) {
            listener->second->tell(news);
        }
    }
}

}  // namespace modelsynth::server
