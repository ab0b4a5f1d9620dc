// Uploaded examples in the embedded store.

#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <utility>

namespace modelsynth::server {

namespace {

void add_owner(Database& database, const std::string& id, const std::string& owner) {
    database.prepare("INSERT OR IGNORE INTO example_owner VALUES (?, ?)")
        .bind(std::string_view(id))
        .bind(std::string_view(owner))
        .run();
}

// The example's digest, when it is there and the owner's.
std::optional<std::string> digest_for(
    Database& database, const std::string& id, const OwnerFilter& owner
) {
    Statement row = database.prepare(
        std::string("SELECT digest FROM example WHERE id = ?") +
        (owner ? " AND EXISTS (SELECT 1 FROM example_owner WHERE example_id = id AND owner = ?)"
               : "")
    );
    row.bind(std::string_view(id));
    if (owner) {
        row.bind(std::string_view(*owner));
    }
    return row.step() ? std::optional(row.text(0)) : std::nullopt;
}

}  // namespace

Stored<void> SqliteStore::add_example(
    const Row& row, const std::string& owner, std::size_t count_max
) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        {
            Statement known = database.prepare("SELECT 1 FROM example WHERE id = ?");
            known.bind(std::string_view(row.id));
            if (known.step()) {
                add_owner(database, row.id, owner);
                return {};
            }
        }
        {
            Statement count = database.prepare("SELECT COUNT(*) FROM example");
            count.step();
            if (count.natural(0) >= count_max) {
                return failure(
                    StoreErrorCode::kQueueFull,
                    std::to_string(count_max) + " examples are kept, as many as are taken"
                );
            }
        }
        if (!artifacts_->exists(row.digest)) {
            return failure(StoreErrorCode::kConflict, "the example's text is not stored");
        }
        database.prepare("INSERT INTO example VALUES (?, ?, ?)")
            .bind(std::string_view(row.id))
            .bind(std::string_view(row.name))
            .bind(std::string_view(row.digest))
            .run();
        add_owner(database, row.id, owner);
        return {};
    });
}

Stored<ExampleStore::Row> SqliteStore::find_example(
    const std::string& id, const OwnerFilter& owner
) {
    return with_reader<Row>([&](Database& database) -> Stored<Row> {
        const auto digest = digest_for(database, id, owner);
        if (!digest) {
            return failure(StoreErrorCode::kNotFound, "there is no example " + id);
        }
        Statement row = database.prepare("SELECT name FROM example WHERE id = ?");
        row.bind(std::string_view(id)).step();
        return Row{id, row.text(0), *digest};
    });
}

Stored<std::vector<ExampleStore::Row>> SqliteStore::list_examples(const OwnerFilter& owner) {
    return with_reader<std::vector<Row>>([&](Database& database) -> Stored<std::vector<Row>> {
        std::vector<Row> rows;
        Statement found = database.prepare(
            std::string("SELECT id, name, digest FROM example ") +
            (owner ? "JOIN example_owner ON example_id = id AND owner = ? " : "") + "ORDER BY id"
        );
        if (owner) {
            found.bind(std::string_view(*owner));
        }
        while (found.step()) {
            rows.push_back({found.text(0), found.text(1), found.text(2)});
        }
        return rows;
    });
}

Stored<void> SqliteStore::erase_example(const std::string& id, const OwnerFilter& owner) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        const auto digest = digest_for(database, id, owner);
        const std::string uses =
            std::string(" AND example_id = ?1") + (owner ? " AND owner = ?2" : "");
        // By these indexes, or it looks at all jobs that ever were.
        Statement users = database.prepare(
            "SELECT 1 FROM job INDEXED BY job_queue WHERE state = 0" + uses +
            " UNION ALL SELECT 1 FROM job INDEXED BY job_running WHERE state = 1" + uses
        );
        users.bind(std::string_view(id));
        if (owner) {
            users.bind(std::string_view(*owner));
        }
        // The job may be all that is left of an example.
        if (users.step()) {
            return failure(StoreErrorCode::kConflict, "an unfinished job uses the example");
        }
        if (!digest) {
            return failure(StoreErrorCode::kNotFound, "there is no example " + id);
        }
        if (owner) {
            database.prepare("DELETE FROM example_owner WHERE example_id = ? AND owner = ?")
                .bind(std::string_view(id))
                .bind(std::string_view(*owner))
                .run();
            Statement others = database.prepare("SELECT 1 FROM example_owner WHERE example_id = ?");
            others.bind(std::string_view(id));
            if (others.step()) {
                return {};
            }
        }
        unlinked_digests_.push_back(*digest);
        database.prepare("DELETE FROM example WHERE id = ?").bind(std::string_view(id)).run();
        return {};
    });
}

}  // namespace modelsynth::server
