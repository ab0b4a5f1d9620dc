#pragma once

#include "proto/limits.h"
#include "proto/problem.h"
#include "server/jobs/caller.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"
#include "solver/registry/task.h"

#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::server {

// The examples there are: built-in ones by name, uploaded ones from the store, a few of which are
// kept parsed. Of what others uploaded a caller learns nothing. Thread-safe; calls block.
class ExampleLibrary {
  public:
    struct Entry {
        std::string id;
        bool built_in = false;
        Example example;
        std::string digest = {};  // of an uploaded one's JSON text in the artifact store
    };

    ExampleLibrary(
        ExampleStore& store,
        ArtifactStore& artifacts,
        const proto::RequestLimits& limits,
        std::size_t uploads_max
    );

    [[nodiscard]] std::optional<Entry> find(const std::string& id, const Caller& caller);

    // The id of an uploaded example with a text of this digest.
    [[nodiscard]] static std::string id_of(const std::string& digest);

    // An uploaded example by the digest of its text, deleted or not.
    [[nodiscard]] std::optional<Example> load(const std::string& digest);

    // Built-in ones first, then the uploaded ones by id.
    [[nodiscard]] proto::Parsed<std::vector<Entry>> list(const Caller& caller);

    // Checks the example and keeps it; the id is derived from the content. A GLB is kept as the
    // JSON that says the same.
    enum class Form : std::uint8_t { kJson, kGlb };
    [[nodiscard]] proto::Parsed<Entry> upload(
        std::string_view body, Form form, const Caller& caller
    );

    // Fails: not-found, forbidden for a built-in one, example-in-use.
    [[nodiscard]] proto::Parsed<void> erase(const std::string& id, const Caller& caller);

  private:
    void remember(const Entry& entry);

    static constexpr std::size_t kParsedMax = 16;

    ExampleStore& store_;
    ArtifactStore& artifacts_;
    proto::RequestLimits limits_;
    std::size_t uploads_max_;
    std::mutex mutex_;
    std::list<Entry> parsed_;  // most recently used first
};

}  // namespace modelsynth::server
