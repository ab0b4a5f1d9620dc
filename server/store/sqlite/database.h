#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

struct sqlite3;
struct sqlite3_stmt;

namespace modelsynth::server {

// A failure of SQLite. Stays inside server/store/sqlite.
class SqliteError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// A prepared statement in use; resets itself at the end.
class Statement {
  public:
    explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}

    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;
    ~Statement();

    // The next parameter.
    Statement& bind(std::int64_t value);
    Statement& bind(std::uint64_t value);
    Statement& bind(double value);
    Statement& bind(std::string_view value);
    Statement& bind(std::nullptr_t);
    Statement& bind_blob(std::string_view bytes);

    template <class T>
    Statement& bind(const std::optional<T>& value) {
        return value ? bind(*value) : bind(nullptr);
    }

    // Advances to the next row; false at the end.
    bool step();
    // Runs a statement that gives no rows.
    void run();

    [[nodiscard]] bool is_null(int column) const;
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] std::uint64_t natural(int column) const;
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::string blob(int column) const;

  private:
    sqlite3_stmt* statement_;
    int next_parameter_ = 1;
};

// One connection with its statements. One thread at a time.
class Database {
  public:
    enum class Mode : std::uint8_t { kWriter, kReader };

    Database(const std::string& path, Mode mode);
    ~Database();

    Database(const Database&) = delete;
    Database& operator=(const Database&) = delete;

    // Prepared once per text, kept for the connection's life.
    [[nodiscard]] Statement prepare(const std::string& sql);
    void execute(const char* sql);
    // Rows changed by the last statement.
    [[nodiscard]] int changes() const;

    // Pages in the write-ahead log since the last reset.
    [[nodiscard]] int wal_pages() const { return wal_pages_; }

    // Moves the log into the database, as far as readers let it; `truncate` empties it.
    void checkpoint(bool truncate);

  private:
    // Opens, no more; what throws from then on finds a destructor that closes.
    Database(const std::string& path, int flags);

    sqlite3* connection_ = nullptr;
    std::unordered_map<std::string, sqlite3_stmt*> statements_;
    int wal_pages_ = 0;
};

}  // namespace modelsynth::server
