#pragma once

#include "server/store/artifact_store.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

namespace modelsynth::server {

// Artifacts as files DIR/ab/cd/<sha256>, written in TMP, synced, renamed, the directory synced.
// Thread-safe.
class FileArtifacts final : public ArtifactStore {
  public:
    // Empties `temporary`.
    FileArtifacts(std::filesystem::path directory, std::filesystem::path temporary);

    [[nodiscard]] Space space() const override;
    [[nodiscard]] Stored<std::unique_ptr<Pin>> put(std::string_view bytes) override;
    [[nodiscard]] Stored<std::unique_ptr<Pin>> pin(const std::string& digest) override;
    [[nodiscard]] Stored<std::unique_ptr<Reader>> open(const std::string& digest) override;
    [[nodiscard]] Stored<std::string> load(const std::string& digest) override;

    [[nodiscard]] bool exists(const std::string& digest) const;
    // Whether there is no file at all.
    [[nodiscard]] bool empty() const;

    // Removes the file unless somebody holds a pin.
    void remove_if_unpinned(const std::string& digest);

    // Called with each digest whose last pin has gone. Set before the first put().
    void on_unpinned(std::function<void(const std::string& digest)> hook) {
        on_unpinned_ = std::move(hook);
    }

    // Its size, 0 when it is not there.
    [[nodiscard]] std::uint64_t size_of(const std::string& digest) const;

    // Removes every file for which `is_used` answers no, and counts what the others take. For the
    // start, before anyone else.
    void sweep(const std::function<bool(const std::string& digest)>& is_used);

  private:
    class FilePin;

    [[nodiscard]] std::filesystem::path path_of(const std::string& digest) const;
    [[nodiscard]] bool sync_directories(const std::string& digest);
    Stored<void> write_file(const std::string& digest, std::string_view bytes);
    void unpin(const std::string& digest);

    std::filesystem::path directory_;
    std::filesystem::path temporary_;
    std::mutex mutex_;
    std::atomic<std::uint64_t> used_bytes_ = 0;  // changed with mutex_ held
    std::map<std::string, std::size_t> pins_;
    std::uint64_t next_temporary_ = 0;
    std::set<std::string> synced_ways_;  // inner directories whose names are on disk
    std::function<void(const std::string&)> on_unpinned_;
};

}  // namespace modelsynth::server
