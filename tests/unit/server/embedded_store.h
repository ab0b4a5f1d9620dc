#pragma once

#include "server/store/sqlite/sqlite_store.h"
#include "tests/unit/server/store_suite.h"

#include <filesystem>
#include <memory>
#include <string>

namespace modelsynth::server {

// A directory of its own, gone at the end.
class TemporaryDirectory {
  public:
    TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    ~TemporaryDirectory();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    [[nodiscard]] std::string database() const { return (path_ / "modelsynth.db").string(); }

  private:
    std::filesystem::path path_;
};

// The embedded store in a directory of its own.
class EmbeddedStore final : public StoreUnderTest {
  public:
    EmbeddedStore() { open(); }

    JobStore& jobs() override { return *store_; }

    EventLog& events() override { return *store_; }

    ArtifactStore& artifacts() override { return store_->artifacts(); }

    ExampleStore& examples() override { return *store_; }

    DeliveryStore& deliveries() override { return *store_; }

    void reopen() override {
        store_.reset();
        open();
    }

  private:
    void open() { store_ = value(SqliteStore::open(directory_.path(), kRetentionMs)); }

    TemporaryDirectory directory_;
    std::unique_ptr<SqliteStore> store_;
};

}  // namespace modelsynth::server
