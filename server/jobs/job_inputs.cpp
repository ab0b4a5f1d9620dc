#include "server/jobs/job_inputs.h"

#include "proto/frame.h"
#include "server/jobs/store_problem.h"

#include <utility>
#include <variant>

namespace modelsynth::server {

Stored<void> InheritedInputs::take(
    JobStore& jobs,
    ArtifactStore& artifacts,
    const std::string& earlier_id,
    std::uint32_t alternative
) {
    const auto hold = [&](const std::string& artifact, const char* name) {
        return jobs.artifact(earlier_id, artifact).and_then([&](const std::string& digest) {
            return artifacts.pin(digest).map([&](std::unique_ptr<ArtifactStore::Pin> pin) {
                links_.push_back({name, digest});
                pins_.push_back(std::move(pin));
            });
        });
    };
    if (auto held = hold(labels_artifact(alternative), kOriginArtifact); !held) {
        return held;
    }
    auto held = hold(kExampleArtifact, kExampleArtifact);
    const bool has_none = !held && held.error().code == StoreErrorCode::kNotFound;
    return has_none ? Stored<void>() : held;
}

std::vector<ArtifactLink> InheritedInputs::links(const std::string& example_id) const {
    std::vector<ArtifactLink> links = links_;
    std::erase_if(links, [&example_id](const ArtifactLink& link) {
        return link.name == kExampleArtifact && ExampleLibrary::id_of(link.digest) != example_id;
    });
    return links;
}

std::optional<ExampleLibrary::Entry> find_example(
    JobStore& jobs, ExampleLibrary& examples, const std::string& job_id, const std::string& id
) {
    if (auto entry = examples.find(id, {})) {
        return entry;
    }
    const auto kept = jobs.artifact(job_id, kExampleArtifact);
    auto example = kept ? examples.load(*kept) : std::nullopt;
    if (!example) {
        return std::nullopt;
    }
    return ExampleLibrary::Entry{id, false, std::move(*example), *kept};
}

proto::Parsed<std::shared_ptr<const Origin>> load_origin(
    JobStore& jobs, ArtifactStore& artifacts, const std::string& job_id, Origin origin
) {
    const auto bytes =
        jobs.artifact(job_id, kOriginArtifact).and_then([&artifacts](const std::string& digest) {
            return artifacts.load(digest);
        });
    if (!bytes) {
        return tl::unexpected(problem_of(bytes.error()));
    }
    auto labels = proto::decode_labels(*bytes);
    const auto* grid = std::get_if<discrete::Origin>(&origin);
    if (!labels || (grid != nullptr && labels->size() != grid->size.cell_count())) {
        return tl::unexpected(
            proto::make_problem("internal", "the labels that the job starts from are damaged")
        );
    }
    std::visit([&](auto& of_solver) { of_solver.labels = std::move(*labels); }, origin);
    return std::make_shared<const Origin>(std::move(origin));
}

}  // namespace modelsynth::server
