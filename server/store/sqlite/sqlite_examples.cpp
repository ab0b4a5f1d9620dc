// Uploaded examples in the embedded store.

#include "server/store/sqlite/job_rows.h"
#include "server/store/sqlite/sqlite_store.h"

#include <utility>

namespace modelsynth::server {

Stored<void> SqliteStore::add_example(const Row& row, std::size_t count_max) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        {
            Statement known = database.prepare("SELECT 1 FROM example WHERE id = ?");
            known.bind(std::string_view(row.id));
            if (known.step()) {
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
        return {};
    });
}

Stored<ExampleStore::Row> SqliteStore::find_example(const std::string& id) {
    return with_reader<Row>([&id](Database& database) -> Stored<Row> {
        Statement row = database.prepare("SELECT id, name, digest FROM example WHERE id = ?");
        row.bind(std::string_view(id));
        if (!row.step()) {
            return failure(StoreErrorCode::kNotFound, "there is no example " + id);
        }
        return Row{row.text(0), row.text(1), row.text(2)};
    });
}

Stored<std::vector<ExampleStore::Row>> SqliteStore::list_examples() {
    return with_reader<std::vector<Row>>([](Database& database) -> Stored<std::vector<Row>> {
        std::vector<Row> rows;
        Statement found = database.prepare("SELECT id, name, digest FROM example ORDER BY id");
        while (found.step()) {
            rows.push_back({found.text(0), found.text(1), found.text(2)});
        }
        return rows;
    });
}

Stored<void> SqliteStore::erase_example(const std::string& id) {
    return writer_->call<void>([&](Database& database) -> Stored<void> {
        Statement users =
            database.prepare("SELECT 1 FROM job WHERE state IN (0, 1) AND example_id = ?");
        users.bind(std::string_view(id));
        if (users.step()) {
            return failure(StoreErrorCode::kConflict, "an unfinished job uses the example");
        }
        {
            Statement row = database.prepare("SELECT digest FROM example WHERE id = ?");
            row.bind(std::string_view(id));
            if (!row.step()) {
                return failure(StoreErrorCode::kNotFound, "there is no example " + id);
            }
            unlinked_digests_.push_back(row.text(0));
        }
        database.prepare("DELETE FROM example WHERE id = ?").bind(std::string_view(id)).run();
        return {};
    });
}

}  // namespace modelsynth::server
