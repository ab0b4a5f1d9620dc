#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace modelsynth::server {

// The disk under SQLite, which can be made to fail. While one of these lives it is what every new
// connection of the process uses. Thread-safe.
class FaultyVfs {
  public:
    enum class Call : std::uint8_t { kRead, kWrite, kSync, kTruncate };

    FaultyVfs();
    FaultyVfs(const FaultyVfs&) = delete;
    FaultyVfs& operator=(const FaultyVfs&) = delete;
    // Requires: every connection is closed.
    ~FaultyVfs();

    // The n-th such call from now on, counted from 1, answers `code` (SQLITE_IOERR, SQLITE_FULL)
    // and `count` - 1 after it.
    void fail(Call call, std::size_t n, int code, std::size_t count = 1);
    // Nothing fails from now on.
    void heal();
    // Whether a call has failed since fail().
    [[nodiscard]] bool has_failed() const;

    [[nodiscard]] int open_file_count() const;

    // From now on it is kept what each file was when it was last synced; what is in the files now
    // counts as that.
    void watch();
    // The n-th write, sync or truncate from now on does not happen, and nothing after it.
    void cut_power_at(std::size_t n);
    // Once every connection is closed: leaves in the files what was synced, and of each write and
    // truncation after that only what the seed picks (0: nothing). The power is back.
    void restore_power(std::uint64_t seed);

    // What the methods of the files ask before they do anything; for them only.
    struct Change {
        bool is_truncation = false;
        std::int64_t at = 0;  // offset or new size
        std::string bytes;
    };

    int before(Call call);
    void change(const std::string& path, Change change);  // before it is made
    void synced(const std::string& path);
    void removed(const std::string& path);
    void opened();
    void closed();

  private:
    struct Watched {
        std::string synced;
        std::vector<Change> changes;  // since then
    };

    struct Registration;

    mutable std::mutex mutex_;
    Call failing_ = Call::kWrite;
    std::size_t calls_to_failure_ = 0;  // 0: none is to fail
    std::size_t failures_left_ = 0;
    int code_ = 0;
    bool failed_ = false;
    int open_file_count_ = 0;
    bool is_watching_ = false;
    bool is_powerless_ = false;
    std::size_t calls_to_power_cut_ = 0;
    std::map<std::string, Watched> files_;
    std::unique_ptr<Registration> registration_;
};

}  // namespace modelsynth::server
