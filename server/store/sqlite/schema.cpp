#include "server/store/sqlite/schema.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace modelsynth::server {

namespace {

// The form of the tables is numbered; step i makes form i + 1 of form i, step 0 out of nothing. A
// step that was released is not changed any more.
constexpr std::array<const char*, 6> kSteps = {
    R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value INTEGER NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE job (
    ordinal INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE,
    solver TEXT NOT NULL,
    seed INTEGER NOT NULL,
    priority INTEGER NOT NULL,
    request TEXT NOT NULL,
    example_id TEXT NOT NULL,
    request_hash TEXT NOT NULL,
    idempotency_key TEXT,
    state INTEGER NOT NULL,
    cancel_requested INTEGER NOT NULL DEFAULT 0,
    next_seq INTEGER NOT NULL DEFAULT 1,
    blocks_done INTEGER NOT NULL DEFAULT 0,
    blocks_total INTEGER NOT NULL DEFAULT 0,
    solver_version TEXT NOT NULL DEFAULT '',
    solved_seconds REAL NOT NULL DEFAULT 0,
    deadline REAL,
    token INTEGER NOT NULL DEFAULT 0,
    fruitless_claims INTEGER NOT NULL DEFAULT 0,
    created INTEGER NOT NULL,
    started INTEGER,
    finished INTEGER,
    expires INTEGER,
    result TEXT NOT NULL DEFAULT '',
    error TEXT NOT NULL DEFAULT ''
) STRICT;
CREATE UNIQUE INDEX job_key ON job (idempotency_key) WHERE idempotency_key IS NOT NULL;
CREATE INDEX job_queue ON job (ordinal) WHERE state = 0;
CREATE INDEX job_running ON job (ordinal) WHERE state = 1;
CREATE INDEX job_expiry ON job (expires) WHERE expires IS NOT NULL;
CREATE TABLE event (
    job_id TEXT NOT NULL REFERENCES job (id) ON DELETE CASCADE,
    seq INTEGER NOT NULL,
    type TEXT NOT NULL,
    time INTEGER NOT NULL,
    fields TEXT NOT NULL,
    PRIMARY KEY (job_id, seq)
) STRICT, WITHOUT ROWID;
CREATE TABLE job_artifact (
    job_id TEXT NOT NULL REFERENCES job (id) ON DELETE CASCADE,
    name TEXT NOT NULL,
    digest TEXT NOT NULL,
    PRIMARY KEY (job_id, name)
) STRICT, WITHOUT ROWID;
CREATE INDEX job_artifact_digest ON job_artifact (digest);
CREATE TABLE example (
    id TEXT PRIMARY KEY,
    name TEXT NOT NULL,
    digest TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE INDEX example_digest ON example (digest);
)sql",
    R"sql(
CREATE TABLE checkpoint (
    job_id TEXT PRIMARY KEY REFERENCES job (id) ON DELETE CASCADE,
    seq INTEGER NOT NULL,
    blocks_done INTEGER NOT NULL,
    blocks_accepted INTEGER NOT NULL,
    labels BLOB NOT NULL
) STRICT;
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN version_base INTEGER NOT NULL DEFAULT 0;
ALTER TABLE checkpoint DROP COLUMN blocks_accepted;
ALTER TABLE checkpoint ADD COLUMN tally TEXT NOT NULL DEFAULT '';
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN owner TEXT NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN traceparent TEXT NOT NULL DEFAULT '';
ALTER TABLE job ADD COLUMN cost INTEGER NOT NULL DEFAULT 1;
ALTER TABLE job ADD COLUMN memory_bytes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE job ADD COLUMN turn INTEGER NOT NULL DEFAULT 0;
DROP INDEX job_key;
CREATE UNIQUE INDEX job_key ON job (owner, idempotency_key) WHERE idempotency_key IS NOT NULL;
DROP INDEX job_queue;
CREATE INDEX job_queue ON job (owner, priority, turn, cost) WHERE state = 0;
DROP INDEX job_running;
CREATE INDEX job_running ON job (owner, priority, turn, cost) WHERE state = 1;
CREATE INDEX job_owner ON job (owner, ordinal);
CREATE TABLE flow (
    owner TEXT NOT NULL,
    priority INTEGER NOT NULL,
    served INTEGER NOT NULL,
    PRIMARY KEY (owner, priority)
) STRICT, WITHOUT ROWID;
INSERT INTO meta VALUES ('turn', 0);
CREATE TABLE example_owner (
    example_id TEXT NOT NULL REFERENCES example (id) ON DELETE CASCADE,
    owner TEXT NOT NULL,
    PRIMARY KEY (example_id, owner)
) STRICT, WITHOUT ROWID;
INSERT INTO example_owner SELECT id, '' FROM example;
)sql",
    R"sql(
ALTER TABLE job ADD COLUMN webhook TEXT NOT NULL DEFAULT '';
CREATE TABLE delivery (
    job_id TEXT PRIMARY KEY REFERENCES job (id) ON DELETE CASCADE,
    url TEXT NOT NULL,
    receiver TEXT NOT NULL,
    tries INTEGER NOT NULL DEFAULT 0,
    due INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
CREATE INDEX delivery_due ON delivery (due);
)sql",
    R"sql(
ALTER TABLE delivery ADD COLUMN owner TEXT NOT NULL DEFAULT '';
UPDATE delivery SET owner = (SELECT owner FROM job WHERE id = job_id);
CREATE INDEX delivery_owner ON delivery (owner);
)sql"};

// 0: the file is new.
std::int64_t read_version(Database& database) {
    {
        Statement meta = database.prepare("SELECT COUNT(*) FROM sqlite_schema WHERE name = 'meta'");
        meta.step();
        if (meta.integer(0) == 0) {
            return 0;
        }
    }
    Statement version = database.prepare("SELECT value FROM meta WHERE key = 'schema'");
    return version.step() ? version.integer(0) : -1;
}

}  // namespace

bool is_new(Database& database) { return read_version(database) == 0; }

void prepare_schema(Database& database) {
    {
        Statement check = database.prepare("PRAGMA quick_check(1)");
        if (!check.step() || check.text(0) != "ok") {
            throw SqliteError("the database is damaged: " + check.text(0));
        }
    }
    constexpr auto kNewest = static_cast<std::int64_t>(kSteps.size());
    const std::int64_t version = read_version(database);
    if (version < 0 || version > kNewest) {
        throw NewerSchema(
            "the database was made by a newer version of the program: its tables have form " +
            std::to_string(version) + ", known are forms up to " + std::to_string(kNewest)
        );
    }
    if (version == kNewest) {
        return;
    }
    database.execute("BEGIN IMMEDIATE");
    for (auto step = static_cast<std::size_t>(version); step < kSteps.size(); ++step) {
        database.execute(kSteps[step]);
    }
    database.prepare("INSERT OR REPLACE INTO meta VALUES ('schema', ?)").bind(kNewest).run();
    database.execute("COMMIT");
}

}  // namespace modelsynth::server
