// Messages about ended jobs in the embedded store.

#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <utility>

namespace modelsynth::server {

using proto::UnixMillis;

namespace {

// Scheme, host and port, as far as a URL that was checked has them.
std::string receiver_of(const std::string& url) {
    const std::size_t host = url.find("://");
    const std::size_t end = host == std::string::npos ? host : url.find_first_of("/?#", host + 3);
    std::string receiver = url.substr(0, end);
    for (char& c : receiver) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    }
    return receiver;
}

}  // namespace

void SqliteStore::add_delivery(Database& database, const std::string& id, UnixMillis now) {
    std::string url;
    std::string owner;
    {
        Statement row = database.prepare("SELECT webhook, owner FROM job WHERE id = ?");
        row.bind(std::string_view(id));
        if (row.step()) {
            url = row.text(0);
            owner = row.text(1);
        }
    }
    if (url.empty()) {
        return;
    }
    database
        .prepare(
            "INSERT OR IGNORE INTO delivery (job_id, url, receiver, due, owner) "
            "VALUES (?, ?, ?, ?, ?)"
        )
        .bind(std::string_view(id))
        .bind(std::string_view(url))
        .bind(std::string_view(receiver_of(url)))
        .bind(now)
        .bind(std::string_view(owner))
        .run();
    has_new_deliveries_ = true;
}

Stored<DueDeliveries> SqliteStore::due_deliveries(
    UnixMillis now, std::size_t per_receiver_max, std::size_t limit
) {
    return with_reader<DueDeliveries>([&](Database& database) -> Stored<DueDeliveries> {
        DueDeliveries due;
        Statement rows = database.prepare(
            "SELECT job_id, url, receiver, tries FROM (SELECT *, ROW_NUMBER() OVER "
            "(PARTITION BY receiver ORDER BY due, job_id) AS place FROM delivery WHERE due <= ?) "
            "WHERE place <= ? ORDER BY due, job_id LIMIT ?"
        );
        rows.bind(now).bind(std::uint64_t{per_receiver_max}).bind(std::uint64_t{limit});
        while (rows.step()) {
            due.items.push_back(
                {rows.text(0),
                 rows.text(1),
                 rows.text(2),
                 static_cast<std::uint32_t>(rows.natural(3))}
            );
        }
        Statement next = database.prepare("SELECT MIN(due) FROM delivery WHERE due > ?");
        next.bind(now);
        if (next.step() && !next.is_null(0)) {
            due.next = next.integer(0);
        }
        return due;
    });
}

Stored<std::size_t> SqliteStore::delivery_count() {
    return with_reader<std::size_t>([](Database& database) -> Stored<std::size_t> {
        Statement row = database.prepare("SELECT COUNT(*) FROM delivery");
        row.step();
        return static_cast<std::size_t>(row.natural(0));
    });
}

Stored<void> SqliteStore::postpone_delivery(
    const std::string& job_id, std::uint32_t tries, UnixMillis due
) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        database.prepare("UPDATE delivery SET tries = ?, due = ? WHERE job_id = ?")
            .bind(std::uint64_t{tries})
            .bind(due)
            .bind(std::string_view(job_id))
            .run();
        return {};
    });
}

Stored<void> SqliteStore::drop_delivery(const std::string& job_id) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        database.prepare("DELETE FROM delivery WHERE job_id = ?")
            .bind(std::string_view(job_id))
            .run();
        return {};
    });
}

void SqliteStore::on_delivery(std::function<void()> told) {
    const std::lock_guard lock(listeners_mutex_);
    on_delivery_ = std::move(told);
}

}  // namespace modelsynth::server
