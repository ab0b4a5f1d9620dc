#pragma once

#include "proto/problem.h"
#include "server/jobs/example_library.h"
#include "server/store/artifact_names.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"
#include "solver/registry/task.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::server {

// What a job works on besides its request. It stays linked to the job, whoever gave it may go.

// What a new job takes over from the one that it starts from, held until it is linked to it.
class InheritedInputs {
  public:
    // Fails: kNotFound when there is no such job or it has no such model.
    [[nodiscard]] Stored<void> take(
        JobStore& jobs,
        ArtifactStore& artifacts,
        const std::string& earlier_id,
        std::uint32_t alternative
    );

    // The links of a job with that example; an earlier job's other example is none of its.
    [[nodiscard]] std::vector<ArtifactLink> links(const std::string& example_id) const;

  private:
    std::vector<ArtifactLink> links_;
    std::vector<std::unique_ptr<ArtifactStore::Pin>> pins_;
};

// The example of an id that the job's request names, also when it was deleted since and the job
// keeps it.
[[nodiscard]] std::optional<ExampleLibrary::Entry> find_example(
    JobStore& jobs, ExampleLibrary& examples, const std::string& job_id, const std::string& id
);

// What the job starts from, as its request tells it, with the labels.
[[nodiscard]] proto::Parsed<std::shared_ptr<const Origin>> load_origin(
    JobStore& jobs, ArtifactStore& artifacts, const std::string& job_id, Origin origin
);

}  // namespace modelsynth::server
