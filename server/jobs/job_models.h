#pragma once

#include "proto/job.h"
#include "proto/job_request.h"
#include "proto/limits.h"
#include "proto/problem.h"
#include "server/jobs/example_library.h"
#include "server/jobs/live_job.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"
#include "solver/mesh/glb_writer.h"
#include "solver/registry/task.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace modelsynth::server {

// Which file of a finished model. Of several models the first; an alternative that is named is
// there as soon as it is made, whatever becomes of the job.
struct ModelFile {
    GlbProfile profile = GlbProfile::kNodes;
    GlbCompression compression = GlbCompression::kNone;
    std::optional<std::uint32_t> alternative;
};

// The models of jobs, finished or as far as they are, as files and as states. Takes the id of
// anybody's job. Thread-safe; calls block on the disk and the processor.
class JobModels {
  public:
    // All outlive it.
    JobModels(
        JobStore& jobs,
        ArtifactStore& artifacts,
        ExampleLibrary& examples,
        LiveJobs& live,
        Preparations& preparations,
        const proto::RequestLimits& limits
    );

    // Coding this much takes some ten seconds, while the client waits for its first byte.
    static constexpr std::uint64_t kGzippedBytesMax = std::uint64_t{256} << 20;

    // The file's digest. It is made on first use and kept with the job.
    // Fails: not-found, not-finished, no-model, expired, too-large.
    [[nodiscard]] proto::Parsed<std::string> digest(const std::string& id, const ModelFile& file);
    // That of the file coded with gzip, kept as it is.
    // Fails: as above; too-large for files of more than kGzippedBytesMax.
    [[nodiscard]] proto::Parsed<std::string> gzipped_digest(
        const std::string& id, const ModelFile& file
    );
    // The model as far as it is. Fails: not-found, not-finished before the first accepted block.
    [[nodiscard]] proto::Parsed<std::string> preview(const std::string& id);
    // Which: as for a ModelFile. Fails: as digest(); not-found where the model has no cells.
    [[nodiscard]] proto::Parsed<std::string> labels_json(
        const std::string& id, const std::optional<std::uint32_t>& alternative
    );

    // The state of a job at an event or later, for whoever missed frames: labels and the seq up
    // to which they include everything. Nothing when there is no such state (yet).
    [[nodiscard]] std::optional<LiveJob::State> whole_state(
        const std::string& id, std::uint64_t seq
    );

    // A job that has a model. Fails: not-found, not-finished, no-model, expired.
    [[nodiscard]] proto::Parsed<proto::Job> find_finished(const std::string& id);
    // A job's request as it was accepted; its example is found even when it was deleted since.
    [[nodiscard]] proto::Parsed<proto::JobRequest> read_request(const proto::Job& job);

  private:
    struct LoadedModel {
        Example example;
        Model model;
    };

    [[nodiscard]] proto::Parsed<proto::Job> find(const std::string& id);
    // The job, when it has that model.
    [[nodiscard]] proto::Parsed<proto::Job> find_with_model(
        const std::string& id, const std::optional<std::uint32_t>& alternative
    );
    [[nodiscard]] proto::Parsed<LoadedModel> load_model(
        const proto::Job& job, const Stored<std::string>& encoded_labels
    );
    [[nodiscard]] Stored<std::string> load_artifact(const std::string& id, const std::string& name);
    // Keeps the bytes as an artifact of the job and returns their digest.
    [[nodiscard]] proto::Parsed<std::string> keep(
        const std::string& id, const std::string& name, std::string_view bytes
    );
    // A stored artifact coded with gzip.
    [[nodiscard]] proto::Parsed<std::string> gzip_artifact(const std::string& digest);
    // The newest labels, as far as the store tells them; see newest_model() for jobs that run.
    [[nodiscard]] Stored<std::string> load_newest_labels(const proto::Job& job);
    // Fails: not-finished before the first accepted block.
    [[nodiscard]] proto::Parsed<Model> newest_model(const proto::Job& job);

    JobStore& jobs_;
    ArtifactStore& artifacts_;
    ExampleLibrary& examples_;
    LiveJobs& live_;
    Preparations& preparations_;
    const proto::RequestLimits& limits_;
};

}  // namespace modelsynth::server
