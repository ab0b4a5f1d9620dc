#include "server/jobs/job_models.h"

#include "proto/frame.h"
#include "server/jobs/gzip.h"
#include "server/jobs/job_inputs.h"
#include "server/jobs/store_problem.h"
#include "server/store/artifact_names.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

namespace {

using proto::Job;
using proto::JobState;
using proto::make_problem;
using proto::Parsed;

const char* profile_name(GlbProfile profile) {
    switch (profile) {
        case GlbProfile::kNodes:
            return "nodes";
        case GlbProfile::kInstanced:
            return "instanced";
        case GlbProfile::kMerged:
            return "merged";
    }
    return "nodes";
}

std::string artifact_name(const ModelFile& file) {
    const char* suffix = file.compression == GlbCompression::kMeshopt ? ".meshopt" : "";
    return model_artifact(
        std::string(profile_name(file.profile)) + suffix, file.alternative.value_or(0)
    );
}

bool has_expired(const Job& job) { return job.expires && *job.expires < proto::now_millis(); }

}  // namespace

JobModels::JobModels(
    JobStore& jobs,
    ArtifactStore& artifacts,
    ExampleLibrary& examples,
    LiveJobs& live,
    Preparations& preparations,
    const proto::RequestLimits& limits
)
    : jobs_(jobs),
      artifacts_(artifacts),
      examples_(examples),
      live_(live),
      preparations_(preparations),
      limits_(limits) {}

Parsed<Job> JobModels::find(const std::string& id) { return parsed(jobs_.find(id)); }

Parsed<Job> JobModels::find_finished(const std::string& id) {
    auto job = find(id);
    if (!job) {
        return job;
    }
    if (!proto::is_ended(job->state)) {
        return tl::unexpected(
            make_problem("not-finished", "the job is " + std::string(proto::state_name(job->state)))
        );
    }
    if (has_expired(*job)) {
        return tl::unexpected(make_problem("expired", "the job's model is no longer kept"));
    }
    if (job->state != JobState::kSucceeded) {
        return tl::unexpected(make_problem(
            "no-model",
            "the job " + std::string(job->state == JobState::kFailed ? "failed" : "was cancelled") +
                "; its preview may be there"
        ));
    }
    return job;
}

Parsed<Job> JobModels::find_with_model(
    const std::string& id, const std::optional<std::uint32_t>& alternative
) {
    if (!alternative) {
        return find_finished(id);
    }
    auto job = find(id);
    if (!job) {
        return job;
    }
    const bool is_never_made = job->state == JobState::kSucceeded ||
                               *alternative >= proto::alternatives_of_request(job->request);
    if (!has_expired(*job) && jobs_.artifact(id, labels_artifact(*alternative))) {
        return job;
    }
    if (has_expired(*job) || !is_never_made) {
        return find_finished(id);  // tells why it is not there
    }
    return tl::unexpected(
        make_problem("not-found", "the job has no alternative " + std::to_string(*alternative))
    );
}

Stored<std::string> JobModels::load_artifact(const std::string& id, const std::string& name) {
    return jobs_.artifact(id, name).and_then([this](const std::string& digest) {
        return artifacts_.load(digest);
    });
}

Stored<std::string> JobModels::load_newest_labels(const Job& job) {
    if (job.state != JobState::kSucceeded) {
        auto preview = load_artifact(job.id, kPreviewArtifact);
        if (preview || preview.error().code != StoreErrorCode::kNotFound) {
            return preview;
        }
        auto checkpoint = jobs_.checkpoint(job.id);
        if (!checkpoint) {
            return tl::unexpected(std::move(checkpoint.error()));
        }
        if (*checkpoint) {
            return std::move((*checkpoint)->labels);
        }
    }
    const std::uint32_t made = proto::alternatives_of_result(job.result);
    return load_artifact(job.id, labels_artifact(made - 1));
}

Parsed<proto::JobRequest> JobModels::read_request(const Job& job) {
    return proto::parse_job_request(
        job.request,
        limits_,
        [this, &job](const std::string& id) -> std::optional<Example> {
            auto entry = find_example(jobs_, examples_, job.id, id);
            return entry ? std::optional(std::move(entry->example)) : std::nullopt;
        },
        nullptr,
        job.seed
    );
}

Parsed<JobModels::LoadedModel> JobModels::load_model(
    const Job& job, const Stored<std::string>& encoded_labels
) {
    if (!encoded_labels) {
        return tl::unexpected(problem_of(encoded_labels.error()));
    }
    auto request = read_request(job);
    if (!request) {
        return tl::unexpected(std::move(request.error()));
    }
    auto labels = proto::decode_labels(*encoded_labels);
    auto space = space_of(request->task.example, request->task.parameters, preparations_);
    if (!space) {
        return tl::unexpected(proto::problem_of(space.error()));
    }
    if (!labels || labels->size() != (*space)->site_count()) {
        return tl::unexpected(make_problem("internal", "the job's labels are damaged"));
    }
    return LoadedModel{request->task.example, {std::move(*space), std::move(*labels)}};
}

Parsed<std::string> JobModels::keep(
    const std::string& id, const std::string& name, std::string_view bytes
) {
    const auto pin = artifacts_.put(bytes);
    if (!pin) {
        return tl::unexpected(problem_of(pin.error()));
    }
    const auto linked = jobs_.link(id, {name, (*pin)->digest()});
    if (!linked) {
        return tl::unexpected(problem_of(linked.error()));
    }
    return (*pin)->digest();
}

Parsed<std::string> JobModels::digest(const std::string& id, const ModelFile& file) {
    const auto job = find_with_model(id, file.alternative);
    if (!job) {
        return tl::unexpected(job.error());
    }
    const std::string name = artifact_name(file);
    const auto known = jobs_.artifact(id, name);
    if (known) {
        return *known;
    }
    const auto loaded =
        load_model(*job, load_artifact(id, labels_artifact(file.alternative.value_or(0))));
    if (!loaded) {
        return tl::unexpected(loaded.error());
    }
    GlbOptions options;
    options.profile = file.profile;
    options.compression = file.compression;
    const auto glb = write_glb(whole_scene(loaded->model), options);
    return glb ? keep(id, name, *glb) : tl::unexpected(proto::problem_of(glb.error()));
}

Parsed<std::string> JobModels::gzipped_digest(const std::string& id, const ModelFile& file) {
    const auto plain = digest(id, file);
    if (!plain) {
        return plain;
    }
    const std::string name = gzipped_artifact(artifact_name(file));
    const auto known = jobs_.artifact(id, name);
    if (known) {
        return *known;
    }
    return gzip_artifact(*plain).and_then([&](const std::string& bytes) {
        return keep(id, name, bytes);
    });
}

Parsed<std::string> JobModels::gzip_artifact(const std::string& digest) {
    constexpr std::uint64_t kPiece = 256 * 1024;
    const auto reader = artifacts_.open(digest);
    if (!reader) {
        return tl::unexpected(problem_of(reader.error()));
    }
    const std::uint64_t size = (*reader)->size();
    if (size > kGzippedBytesMax) {
        return tl::unexpected(make_problem("too-large", "the file is too large to be coded"));
    }
    GzipWriter writer;
    std::string piece;
    for (std::uint64_t at = 0; at < size; at += piece.size()) {
        piece.resize(std::min(kPiece, size - at));
        if (const auto read = (*reader)->read(at, piece); !read) {
            return tl::unexpected(problem_of(read.error()));
        }
        writer.append(piece);
    }
    return writer.finish();
}

std::optional<LiveJob::State> JobModels::whole_state(const std::string& id, std::uint64_t seq) {
    if (const auto live = live_.find(id)) {
        return live->state_at(seq);
    }
    const auto job = jobs_.find(id);
    if (!job || !proto::is_ended(job->state)) {
        return std::nullopt;
    }
    auto loaded = load_model(*job, load_newest_labels(*job));
    // Of the steps in between nothing is kept, so there is one state, and it stands at the end.
    if (!loaded || job->head - 1 != seq) {
        return std::nullopt;
    }
    return LiveJob::State{job->head - 1, std::move(loaded->model), true};
}

Parsed<Model> JobModels::newest_model(const Job& job) {
    if (const auto live = live_.find(job.id)) {
        auto state = live->state();
        if (state.any_block) {
            return std::move(state.model);
        }
    }
    const auto labels = load_newest_labels(job);
    if (!labels && labels.error().code == StoreErrorCode::kNotFound) {
        return tl::unexpected(
            proto::is_ended(job.state)
                ? make_problem("no-model", "the job ended before a block was accepted")
                : make_problem("not-finished", "no block of the job was accepted yet")
        );
    }
    return load_model(job, labels).map([](LoadedModel loaded) { return std::move(loaded.model); });
}

Parsed<std::string> JobModels::preview(const std::string& id) {
    const auto job = find(id);
    if (!job) {
        return tl::unexpected(job.error());
    }
    if (has_expired(*job)) {
        return tl::unexpected(make_problem("expired", "the job's model is no longer kept"));
    }
    const auto model = newest_model(*job);
    if (!model) {
        return tl::unexpected(model.error());
    }
    auto glb = write_glb(whole_scene(*model));
    if (!glb) {
        return tl::unexpected(proto::problem_of(glb.error()));
    }
    return std::move(*glb);
}

Parsed<std::string> JobModels::labels_json(
    const std::string& id, const std::optional<std::uint32_t>& alternative
) {
    const auto job = find_with_model(id, alternative);
    if (!job) {
        return tl::unexpected(job.error());
    }
    const auto loaded =
        load_model(*job, load_artifact(id, labels_artifact(alternative.value_or(0))));
    if (!loaded) {
        return tl::unexpected(loaded.error());
    }
    if (!loaded->model.space->is_grid()) {
        return tl::unexpected(
            make_problem("not-found", "the job's model has no cells that labels could stand in")
        );
    }
    return proto::labels_json(loaded->example, loaded->model);
}

}  // namespace modelsynth::server
