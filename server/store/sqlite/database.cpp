#include "server/store/sqlite/database.h"

#include <sqlite3.h>

namespace modelsynth::server {

namespace {

[[noreturn]] void fail(sqlite3* connection, const std::string& what) {
    throw SqliteError(
        what + ": " + (connection == nullptr ? "no memory" : sqlite3_errmsg(connection))
    );
}

void require(int code, sqlite3_stmt* statement) {
    if (code != SQLITE_OK) {
        fail(sqlite3_db_handle(statement), "a parameter cannot be bound");
    }
}

}  // namespace

Statement::~Statement() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
}

Statement& Statement::bind(std::int64_t value) {
    require(sqlite3_bind_int64(statement_, next_parameter_++, value), statement_);
    return *this;
}

Statement& Statement::bind(std::uint64_t value) { return bind(static_cast<std::int64_t>(value)); }

Statement& Statement::bind(double value) {
    require(sqlite3_bind_double(statement_, next_parameter_++, value), statement_);
    return *this;
}

Statement& Statement::bind(std::string_view value) {
    // A copy is made; the text may be gone before the statement runs.
    require(
        sqlite3_bind_text64(
            statement_,
            next_parameter_++,
            value.data(),
            value.size(),
            SQLITE_TRANSIENT,  // NOLINT: the library's own cast
            SQLITE_UTF8
        ),
        statement_
    );
    return *this;
}

Statement& Statement::bind(std::nullptr_t) {
    require(sqlite3_bind_null(statement_, next_parameter_++), statement_);
    return *this;
}

bool Statement::step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) {
        fail(sqlite3_db_handle(statement_), "a statement failed");
    }
    return code == SQLITE_ROW;
}

void Statement::run() {
    while (step()) {
    }
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(statement_, column);
}

std::uint64_t Statement::natural(int column) const {
    return static_cast<std::uint64_t>(integer(column));
}

double Statement::real(int column) const { return sqlite3_column_double(statement_, column); }

std::string Statement::text(int column) const {
    const auto* bytes = sqlite3_column_text(statement_, column);
    const int size = sqlite3_column_bytes(statement_, column);
    return bytes == nullptr
               ? std::string()
               : std::string(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

Statement& Statement::bind_blob(std::string_view bytes) {
    // The same goes for these.
    require(
        sqlite3_bind_blob64(
            statement_,
            next_parameter_++,
            bytes.data(),
            bytes.size(),
            SQLITE_TRANSIENT  // NOLINT: the library's own cast
        ),
        statement_
    );
    return *this;
}

std::string Statement::blob(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    const int size = sqlite3_column_bytes(statement_, column);
    return bytes == nullptr ? std::string() : std::string(bytes, static_cast<std::size_t>(size));
}

Database::Database(const std::string& path, int flags) {
    // Counting what the library allocates takes a lock at each; nobody reads the count. Refused
    // once the library is in use, which does no harm.
    static const int once = sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
    static_cast<void>(once);
    if (sqlite3_open_v2(path.c_str(), &connection_, flags | SQLITE_OPEN_NOMUTEX, nullptr) !=
        SQLITE_OK) {
        const std::string why = connection_ == nullptr ? "no memory" : sqlite3_errmsg(connection_);
        sqlite3_close(connection_);
        throw SqliteError("the database " + path + " cannot be opened: " + why);
    }
}

Database::Database(const std::string& path, Mode mode)
    : Database(
          path,
          mode == Mode::kWriter ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY
      ) {
    execute("PRAGMA busy_timeout=5000");
    execute("PRAGMA temp_store=MEMORY");
    if (mode == Mode::kReader) {
        return;
    }
    {
        Statement wal = prepare("PRAGMA journal_mode=WAL");
        if (!wal.step() || wal.text(0) != "wal") {
            throw SqliteError("the database does not take write-ahead logging");
        }
    }
    execute("PRAGMA synchronous=FULL");
    execute("PRAGMA foreign_keys=ON");
    execute("PRAGMA cache_size=-16384");
    // Only the writer checkpoints, and only between its transactions: SQLite up to 3.51.2 has a
    // rare race between a checkpoint and a commit on different connections.
    execute("PRAGMA wal_autocheckpoint=0");
    sqlite3_wal_hook(
        connection_,
        [](void* self, sqlite3*, const char*, int pages) {
            static_cast<Database*>(self)->wal_pages_ = pages;
            return SQLITE_OK;
        },
        this
    );
}

Database::~Database() {
    for (const auto& [sql, statement] : statements_) {
        sqlite3_finalize(statement);
    }
    sqlite3_close(connection_);
}

Statement Database::prepare(const std::string& sql) {
    sqlite3_stmt*& statement = statements_[sql];
    if (statement == nullptr &&
        sqlite3_prepare_v3(
            connection_, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr
        ) != SQLITE_OK) {
        fail(connection_, "a statement cannot be prepared");
    }
    return Statement(statement);
}

void Database::execute(const char* sql) {
    if (sqlite3_exec(connection_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
        fail(connection_, sql);
    }
}

int Database::changes() const { return sqlite3_changes(connection_); }

void Database::checkpoint(bool truncate) {
    const int mode = truncate ? SQLITE_CHECKPOINT_TRUNCATE : SQLITE_CHECKPOINT_PASSIVE;
    if (sqlite3_wal_checkpoint_v2(connection_, nullptr, mode, nullptr, nullptr) == SQLITE_OK) {
        wal_pages_ = 0;
    }
}

}  // namespace modelsynth::server
