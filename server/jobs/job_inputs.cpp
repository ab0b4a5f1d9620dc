#include "server/jobs/job_inputs.h"

#include "proto/frame.h"
#include "server/jobs/store_problem.h"

#include <utility>

namespace modelsynth::server {

std::optional<ExampleLibrary::Entry> find_example(
    JobStore& jobs, ExampleLibrary& examples, const std::string& job_id, const std::string& id
) {
    if (auto entry = examples.find(id)) {
        return entry;
    }
    const auto kept = jobs.artifact(job_id, kExampleArtifact);
    auto example = kept ? examples.load(*kept) : std::nullopt;
    if (!example) {
        return std::nullopt;
    }
    return ExampleLibrary::Entry{id, false, std::move(*example), *kept};
}

proto::Parsed<std::shared_ptr<const discrete::Origin>> load_origin(
    JobStore& jobs, ArtifactStore& artifacts, const std::string& job_id, discrete::Origin origin
) {
    const auto bytes =
        jobs.artifact(job_id, kOriginArtifact).and_then([&artifacts](const std::string& digest) {
            return artifacts.load(digest);
        });
    if (!bytes) {
        return tl::unexpected(problem_of(bytes.error()));
    }
    auto labels = proto::decode_labels(*bytes);
    if (!labels || labels->size() != origin.size.cell_count()) {
        return tl::unexpected(
            proto::make_problem("internal", "the labels that the job starts from are damaged")
        );
    }
    origin.labels = std::move(*labels);
    return std::make_shared<const discrete::Origin>(std::move(origin));
}

}  // namespace modelsynth::server
