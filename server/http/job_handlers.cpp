#include "proto/job.h"
#include "proto/limits.h"
#include "server/http/handlers.h"
#include "server/http/query_reader.h"
#include "server/http/representation.h"
#include "server/http/request_fields.h"

#include <algorithm>
#include <array>
#include <utility>

namespace modelsynth::server {

using proto::make_problem;

Response submit_job(const Call& call) {
    const auto key = idempotency_key(call.request);
    if (!key) {
        return refuse(call, key.error());
    }
    const auto submitted =
        call.service.submit(call.request.body, *key, call.request.caller, call.request.traceparent);
    if (!submitted) {
        return refuse(call, submitted.error());
    }
    // Who gave no key cannot ask for the job again and leaves no work behind by going away.
    const bool cancel_when_left = key->empty();
    const bool as_events = wants_event_stream(call.request);
    Response response = as_events ? event_stream_response({submitted->job.id, 0, cancel_when_left})
                                  : json_response(202, proto::to_json(submitted->job));
    response.headers.emplace_back("Location", "/v1/jobs/" + submitted->job.id);
    response.job_id = submitted->job.id;
    if (submitted->replayed) {
        response.headers.emplace_back("Idempotent-Replayed", "true");
    }
    const auto seconds = preferred_wait(call.request);
    if (seconds && !as_events) {
        response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*seconds));
        response.wait = WaitForJob{
            submitted->job.id, std::chrono::seconds(*seconds), 200, 202, {}, cancel_when_left};
    }
    return response;
}

Response list_jobs(const Call& call) {
    QueryReader given(call.request);
    JobQuery query;
    query.owner = call.request.caller.filter();
    if (const auto state = given.text("state")) {
        query.state = proto::state_of(*state);
        if (!query.state) {
            given.fault("state", "must be queued, running, succeeded, failed or cancelled");
        }
    }
    query.limit = given.number("limit", 1, kJobsPerPageMax).value_or(kJobsPerPageDefault);
    const auto cursor = given.text("cursor");
    query.cursor = cursor.value_or("");
    if (cursor && cursor->empty()) {
        given.fault_malformed("cursor", "is empty");
    }
    if (auto problem = given.finish()) {
        return refuse(call, *problem);
    }
    const auto page = call.service.list(query);
    if (!page) {
        return refuse(call, page.error());
    }
    std::vector<std::string> items;
    for (const proto::Job& job : page->jobs) {
        items.push_back(proto::to_json(job));
    }
    return respond_with_json(call.request, proto::list_json(items, page->next));
}

Response get_job(const Call& call) {
    const auto job = call.service.find(call.id);
    if (!job) {
        return refuse(call, job.error());
    }
    QueryReader given(call.request);
    const std::uint64_t wait = given.number("wait", 0, proto::kSeedMax).value_or(0);
    const std::uint64_t since = given.number("since", 0, job->head).value_or(job->head);
    if (auto problem = given.finish()) {
        return refuse(call, *problem);
    }
    Response response = respond_with_json(call.request, proto::to_json(*job));
    const bool is_news = since < job->head || proto::is_ended(job->state);
    if (wait > 0 && !is_news && response.status < 400) {
        const std::chrono::seconds most(std::min(wait, kWaitSecondsMax));
        response.wait = WaitForJob{call.id, most, 200, 200, since};
    }
    return response;
}

Response cancel_job(const Call& call) {
    const auto job = call.service.cancel(call.id);
    if (!job) {
        return refuse(call, job.error());
    }
    Response response = json_response(200, proto::to_json(*job));
    if (!proto::is_ended(job->state)) {
        response.wait = WaitForJob{call.id, std::chrono::seconds(kCancelWaitSecondsMax), 200, 200};
    }
    return response;
}

Response delete_job(const Call& call) {
    const auto erased = call.service.erase(call.id);
    if (!erased) {
        return refuse(call, erased.error());
    }
    return {204, {}, std::string()};
}

namespace {

// Which of several models; nothing: the first, once the job has succeeded.
std::optional<std::uint32_t> wanted_alternative(QueryReader& query) {
    const auto max = static_cast<std::uint64_t>(proto::RequestLimits{}.alternatives_max) - 1;
    const auto number = query.number("alternative", 0, max);
    return number ? std::optional(static_cast<std::uint32_t>(*number)) : std::nullopt;
}

std::string file_stem(const Call& call, const std::optional<std::uint32_t>& alternative) {
    return alternative ? call.id + "-" + std::to_string(*alternative) : call.id;
}

ModelFile wanted_file(QueryReader& query) {
    static constexpr NamedValues<GlbProfile, 3> kProfiles = {
        {{"nodes", GlbProfile::kNodes},
         {"instanced", GlbProfile::kInstanced},
         {"merged", GlbProfile::kMerged}}};
    static constexpr NamedValues<GlbCompression, 2> kCompressions = {
        {{"none", GlbCompression::kNone}, {"meshopt", GlbCompression::kMeshopt}}};
    return {
        query.one_of("profile", kProfiles).value_or(GlbProfile::kNodes),
        query.one_of("compression", kCompressions).value_or(GlbCompression::kNone),
        wanted_alternative(query)};
}

using Reader = std::shared_ptr<ArtifactStore::Reader>;

proto::Parsed<Reader> open_file(const Call& call, const std::string& digest) {
    auto reader = call.service.artifacts().open(digest);
    if (!reader) {
        return tl::unexpected(make_problem("not-found", "the model was deleted"));
    }
    return Reader(std::move(*reader));
}

}  // namespace

Response get_model(const Call& call) {
    QueryReader query(call.request);
    const ModelFile file = wanted_file(query);
    if (auto problem = query.finish()) {
        return refuse(call, *problem);
    }
    const auto digest = call.service.models().digest(call.id, file);
    if (!digest) {
        return refuse(call, digest.error());
    }
    auto reader = open_file(call, *digest);
    if (!reader) {
        return refuse(call, reader.error());
    }
    const std::uint64_t size = (*reader)->size();
    Representation representation;
    representation.media_type = "model/gltf-binary";
    representation.etag = "\"" + *digest + "\"";
    representation.file_name = file_stem(call, file.alternative) + ".glb";
    representation.content = std::move(*reader);
    if (size <= JobModels::kGzippedBytesMax) {
        representation.gzipped = [&call, &file] {
            return call.service.models()
                .gzipped_digest(call.id, file)
                .and_then([&call](const std::string& gzip) { return open_file(call, gzip); })
                .map([](Reader gzip) { return Content(std::move(gzip)); });
        };
    }
    return respond_with(call.request, std::move(representation));
}

Response get_preview(const Call& call) {
    auto glb = call.service.models().preview(call.id);
    if (!glb) {
        return refuse(call, glb.error());
    }
    return respond_with(call.request, glb_in_memory(std::move(*glb), call.id + ".preview.glb"));
}

Response get_labels(const Call& call) {
    QueryReader query(call.request);
    const auto alternative = wanted_alternative(query);
    if (auto problem = query.finish()) {
        return refuse(call, *problem);
    }
    auto labels = call.service.models().labels_json(call.id, alternative);
    if (!labels) {
        return refuse(call, labels.error());
    }
    return respond_with_json(call.request, std::move(*labels));
}

}  // namespace modelsynth::server
