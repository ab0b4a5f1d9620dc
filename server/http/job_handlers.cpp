#include "proto/job.h"
#include "proto/limits.h"
#include "server/http/handlers.h"
#include "server/http/representation.h"
#include "server/http/request_fields.h"

#include <utility>

namespace modelsynth::server {

using proto::make_problem;

Response submit_job(const Call& call) {
    if (auto problem = check_query(call.request, {})) {
        return refuse(call, *problem);
    }
    const auto key = idempotency_key(call.request);
    if (!key) {
        return refuse(call, key.error());
    }
    const auto submitted = call.service.submit(call.request.body, *key);
    if (!submitted) {
        return refuse(call, submitted.error());
    }
    // Who gave no key cannot ask for the job again and leaves no work behind by going away.
    const bool cancel_when_left = key->empty();
    const bool as_events = wants_event_stream(call.request);
    Response response = as_events ? event_stream_response({submitted->job.id, 0, cancel_when_left})
                                  : json_response(202, proto::to_json(submitted->job));
    response.headers.emplace_back("Location", "/v1/jobs/" + submitted->job.id);
    if (submitted->replayed) {
        response.headers.emplace_back("Idempotent-Replayed", "true");
    }
    const auto seconds = preferred_wait(call.request);
    if (seconds && !as_events) {
        response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(*seconds));
        response.wait = WaitForJob{
            submitted->job.id, std::chrono::seconds(*seconds), 200, 202, cancel_when_left};
    }
    return response;
}

Response list_jobs(const Call& call) {
    if (auto problem = check_query(call.request, {"state", "limit", "cursor"})) {
        return refuse(call, *problem);
    }
    JobQuery query;
    if (const auto state = call.request.query_field("state")) {
        query.state = proto::state_of(*state);
        if (!query.state) {
            return refuse(
                call,
                make_problem(
                    "invalid-request",
                    "\"state\" must be queued, running, succeeded, failed or cancelled"
                )
            );
        }
    }
    const auto limit = query_number(call.request, "limit", 20, 1, 100);
    if (!limit) {
        return refuse(call, limit.error());
    }
    query.limit = *limit;
    query.cursor = call.request.query_field("cursor").value_or("");
    const auto page = call.service.list(query);
    if (!page) {
        return refuse(call, page.error());
    }
    std::vector<std::string> items;
    for (const proto::Job& job : page->jobs) {
        items.push_back(proto::to_json(job));
    }
    return json_response(200, proto::list_json(items, page->next));
}

Response get_job(const Call& call) {
    const auto job = call.service.find(call.id);
    return job ? json_response(200, proto::to_json(*job)) : refuse(call, job.error());
}

Response cancel_job(const Call& call) {
    const auto job = call.service.cancel(call.id);
    if (!job) {
        return refuse(call, job.error());
    }
    Response response = json_response(200, proto::to_json(*job));
    if (!proto::is_ended(job->state)) {
        response.wait = WaitForJob{call.id, std::chrono::seconds(1), 200, 200};
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
proto::Parsed<std::optional<std::uint32_t>> wanted_alternative(const Call& call) {
    if (!call.request.query_field("alternative")) {
        return std::nullopt;
    }
    const auto max = static_cast<std::uint64_t>(proto::RequestLimits{}.alternatives_max) - 1;
    return query_number(call.request, "alternative", 0, 0, max).map([](std::uint64_t number) {
        return std::optional(static_cast<std::uint32_t>(number));
    });
}

std::string file_stem(const Call& call, const std::optional<std::uint32_t>& alternative) {
    return alternative ? call.id + "-" + std::to_string(*alternative) : call.id;
}

}  // namespace

Response get_model(const Call& call) {
    if (auto problem = check_query(call.request, {"profile", "compression", "alternative"})) {
        return refuse(call, *problem);
    }
    static constexpr std::array<std::pair<std::string_view, GlbProfile>, 3> kProfiles = {
        {{"nodes", GlbProfile::kNodes},
         {"instanced", GlbProfile::kInstanced},
         {"merged", GlbProfile::kMerged}}};
    const std::string name = call.request.query_field("profile").value_or("nodes");
    const auto profile = std::find_if(kProfiles.begin(), kProfiles.end(), [&](const auto& known) {
        return known.first == name;
    });
    if (profile == kProfiles.end()) {
        return refuse(
            call, make_problem("invalid-request", "\"profile\" must be nodes, instanced or merged")
        );
    }
    if (call.request.query_field("compression").value_or("none") != "none") {
        return refuse(
            call, make_problem("invalid-request", "\"compression\" must be none in this version")
        );
    }
    const auto alternative = wanted_alternative(call);
    if (!alternative) {
        return refuse(call, alternative.error());
    }
    const auto digest = call.service.model_digest(call.id, profile->second, *alternative);
    if (!digest) {
        return refuse(call, digest.error());
    }
    auto reader = call.service.artifacts().open(*digest);
    if (!reader) {
        return refuse(call, make_problem("not-found", "the model was deleted"));
    }
    Representation representation;
    representation.media_type = "model/gltf-binary";
    representation.etag = "\"" + *digest + "\"";
    representation.file_name = file_stem(call, *alternative) + ".glb";
    representation.content = std::shared_ptr<ArtifactStore::Reader>(std::move(*reader));
    return respond_with(call.request, std::move(representation));
}

Response get_preview(const Call& call) {
    auto glb = call.service.preview(call.id);
    if (!glb) {
        return refuse(call, glb.error());
    }
    return respond_with(call.request, glb_in_memory(std::move(*glb), call.id + ".preview.glb"));
}

Response get_labels(const Call& call) {
    if (auto problem = check_query(call.request, {"alternative"})) {
        return refuse(call, *problem);
    }
    const auto alternative = wanted_alternative(call);
    if (!alternative) {
        return refuse(call, alternative.error());
    }
    auto labels = call.service.labels_json(call.id, *alternative);
    if (!labels) {
        return refuse(call, labels.error());
    }
    Representation representation;
    representation.media_type = "application/json";
    representation.etag = "\"" + sha256_hex(*labels) + "\"";
    representation.content = std::move(*labels);
    return respond_with(call.request, std::move(representation));
}

}  // namespace modelsynth::server
