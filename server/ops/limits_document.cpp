#include "server/ops/limits_document.h"

#include "proto/limit_codec.h"
#include "proto/limits.h"
#include "proto/stream_message.h"
#include "server/access/tickets.h"
#include "server/http/content_coding.h"
#include "server/http/handlers.h"
#include "server/http/request_fields.h"
#include "server/stream/snapshot.h"
#include "solver/mesh/glb_writer.h"

#include <vector>

namespace modelsynth::server {

namespace {

using proto::Limit;

template <class Number>
Limit limit(const char* name, Number value, const char* unit, const char* description) {
    return {name, static_cast<double>(value), unit, description};
}

void append(std::vector<Limit>& limits, std::vector<Limit> more) {
    limits.insert(limits.end(), more.begin(), more.end());
}

std::vector<Limit> limits_of_connections(const HttpLimits& http) {
    return {
        limit("connections_max", http.connections_max, "connections", "Open at once; 503 beyond."),
        {"connections_per_address_max",
         http.connections_per_address_max > 0
             ? std::optional(static_cast<double>(http.connections_per_address_max))
             : std::nullopt,
         "connections",
         "Open at once from one address; 503 beyond."},
        limit(
            "requests_per_connection_max",
            http.requests_per_connection_max,
            "requests",
            "After so many the connection is closed."
        ),
        limit(
            "request_line_bytes_max",
            http.target_bytes_max,
            "bytes",
            "Of a request line with its target; 414 beyond."
        ),
        limit("head_bytes_max", http.head_bytes_max, "bytes", "Of a request's head; 431 beyond."),
        limit("fields_max", http.fields_max, "header fields", "Of a request; 431 beyond."),
        limit("head_seconds", http.head_seconds, "seconds", "For a request's head to come; 408."),
        limit("body_seconds", http.body_seconds, "seconds", "For a request's body to come; 408."),
        limit("idle_seconds", http.idle_seconds, "seconds", "Between two requests."),
        limit(
            "write_seconds",
            http.write_seconds,
            "seconds",
            "For a client to take a piece of an answer; then the connection is closed."
        ),
        limit(
            "job_body_bytes_max",
            http.job_body_bytes_max,
            "bytes",
            "Of the body of POST /v1/jobs; 413 beyond."
        ),
        limit(
            "upload_body_bytes_max",
            http.upload_body_bytes_max,
            "bytes",
            "Of the body of POST /v1/examples; 413 beyond."
        ),
        limit(
            "other_body_bytes_max",
            http.other_body_bytes_max,
            "bytes",
            "Of any other body; 413 beyond."
        ),
        limit(
            "coded_bytes_min",
            kCodedBytesMin,
            "bytes",
            "Of what is sent with gzip; less is sent as it is."
        ),
    };
}

std::vector<Limit> limits_of_streams(const HttpLimits& http) {
    return {
        limit(
            "socket_message_bytes_max",
            proto::kStreamMessageBytesMax,
            "bytes",
            "Of a message to a WebSocket; closed with 1009 beyond."
        ),
        limit(
            "socket_idle_seconds",
            http.stream_idle_seconds,
            "seconds",
            "Without a sign of a WebSocket's client; pings are sent before."
        ),
        limit(
            "event_stream_heartbeat_seconds",
            http.stream_idle_seconds / 4,
            "seconds",
            "Between two signs of life of an event stream."
        ),
        limit(
            "stream_subscriptions_max",
            http.stream_subscriptions_max,
            "jobs",
            "That one WebSocket of /v1/stream follows at once."
        ),
        limit(
            "stream_pending_max",
            http.stream_pending_max,
            "messages",
            "To /v1/stream that wait for answers; more are not read meanwhile."
        ),
        limit(
            "stream_lag_max",
            kLagMax,
            "events",
            "That a client which takes too long for one write may be behind; a snapshot beyond."
        ),
        limit(
            "stream_slow_write_seconds",
            kSlowWrite.count(),
            "seconds",
            "For one write, before a client counts as slow."
        ),
    };
}

std::vector<Limit> limits_of_keys() {
    return {
        {"key_requests_per_second_max",
         std::nullopt,
         "requests/second",
         "As the entry of the key gives it; 429 too-fast beyond. RateLimit-Policy tells."},
        {"key_unfinished_jobs_max",
         std::nullopt,
         "jobs",
         "As the entry of the key gives it; 429 too-many-jobs beyond."},
        limit(
            "tickets_max",
            Tickets::kCountMax,
            "tickets",
            "Given and not used yet; 503 unavailable beyond."
        ),
        limit("ticket_seconds", Tickets::kLifetime.count(), "seconds", "For a ticket to be used."),
    };
}

std::vector<Limit> limits_of_running_jobs(const JobServiceConfig& jobs) {
    const CapacityLimits capacity = capacity_of(jobs);
    return {
        limit("workers", jobs.workers, "jobs", "That are solved at the same time."),
        limit(
            "memory_bytes_max",
            capacity.memory_bytes,
            "bytes",
            "That running jobs are thought to need, others wait; 422 too-large for one that needs "
            "more."
        ),
        limit("large_choices", jobs.large_choices, "labels", "A job that chooses more is large."),
        limit(
            "large_jobs_max",
            capacity.large_jobs,
            "jobs",
            "Large ones that are solved at the same time; others wait."
        ),
    };
}

std::vector<Limit> limits_of_service(const JobServiceConfig& jobs, const WebhookConfig& webhooks) {
    return {
        limit("queue_max", jobs.queue_max, "jobs", "That wait; 503 queue-full beyond."),
        limit(
            "examples_max",
            jobs.examples_max,
            "examples",
            "Uploaded and kept; 422 too-large beyond."
        ),
        limit(
            "prefer_wait_seconds_max",
            kWaitSecondsMax,
            "seconds",
            "That Prefer: wait, and wait of GET /v1/jobs/{id}, is granted; more is taken for this."
        ),
        limit(
            "cancel_wait_seconds_max",
            kCancelWaitSecondsMax,
            "seconds",
            "That the answer to a cancellation waits for the end."
        ),
        limit(
            "idempotency_key_characters_max",
            kIdempotencyKeyCharactersMax,
            "characters",
            "Of an Idempotency-Key."
        ),
        limit("page_items_max", kJobsPerPageMax, "jobs", "Of one page of GET /v1/jobs."),
        limit(
            "page_items_default",
            kJobsPerPageDefault,
            "jobs",
            "Of one page of GET /v1/jobs without limit."
        ),
        limit(
            "analysis_seconds_max",
            ExampleAnalyses::kSecondsMax,
            "seconds",
            "That an example is analysed; 422 too-large beyond."
        ),
        limit(
            "webhook_tries_max",
            webhooks.tries_max,
            "tries",
            "Of a webhook; then its message is dropped."
        ),
        limit(
            "webhooks_waiting_max",
            jobs.webhooks_waiting_max,
            "webhooks",
            "Of one key, or of all where there are none, that are not delivered; 429 "
            "too-many-webhooks beyond."
        ),
        limit("webhook_seconds", webhooks.try_seconds, "seconds", "For a webhook to be answered."),
        limit("problem_errors_max", proto::kFaultsMax, "errors", "Listed in one problem document."),
    };
}

std::vector<Limit> limits_of_documents(const proto::RequestLimits& requests) {
    return {
        limit("json_depth_max", requests.json.depth_max, "levels", "Of JSON; 400 beyond."),
        limit("json_nodes_max", requests.json.nodes_max, "values", "Of JSON; 400 beyond."),
        limit(
            "json_string_bytes_max",
            requests.json.string_bytes_max,
            "bytes",
            "Of a string in JSON; 400 beyond."
        ),
        limit("seed_max", proto::kSeedMax, "", "The greatest seed."),
        limit("tags_max", requests.tags_max, "tags", "Of a job."),
        limit(
            "webhook_url_characters_max",
            requests.webhook_url_characters_max,
            "characters",
            "Of a webhook's URL."
        ),
        limit("name_characters_max", requests.name_characters_max, "characters", "Of a name."),
        limit(
            "deadline_seconds_max", requests.deadline_seconds_max, "seconds", "Of a job's deadline."
        ),
        limit("constraints_max", requests.constraints_max, "constraints", "Of one request."),
        limit(
            "member_rules_max",
            requests.member_rules_max,
            "constraints",
            "Of count, separation, max_run, connected, acyclic and path in one request."
        ),
        limit(
            "symmetries_max", requests.symmetries_max, "constraints", "Of symmetry in a request."
        ),
        limit("masks_max", requests.masks_max, "constraints", "With a mask in one request."),
        limit("mask_bytes_max", requests.mask.text_bytes_max, "bytes", "Of a mask's data: URI."),
        limit(
            "mask_side_pixels_max", requests.mask.side_pixels_max, "pixels", "A mask wide and high."
        ),
        limit("voxels_max", requests.voxels_max, "values", "Of voxels in one constraint."),
        limit("separation_max", requests.separation_max, "steps", "Of a separation."),
        limit(
            "resemblance_window_max", requests.resemblance_window_max, "cells", "Of a resemblance."
        ),
        limit("terms_max", requests.terms_max, "terms", "Of one objective."),
        limit("best_of_max", requests.best_of_max, "models", "That one is chosen from."),
    };
}

std::vector<Limit> limits_of_models(const proto::RequestLimits& requests) {
    return {
        limit(
            "model_cells_max",
            requests.model_cells_max,
            "cells",
            "Of a model, all its alternatives together; 422 too-large beyond."
        ),
        limit("extent_max", requests.extent_max, "cells", "Of a model or example along an axis."),
        limit(
            "blocks_max",
            requests.blocks_max,
            "blocks",
            "Of a schedule, for all alternatives together; 422 too-large beyond."
        ),
        limit("block_extent_max", requests.block_extent_max, "cells", "Of a block along an axis."),
        limit("alternatives_max", requests.alternatives_max, "models", "Of one job."),
        limit("pieces_max", requests.pieces_max, "pieces", "Of one example."),
        limit("example_cells_max", requests.example_cells_max, "cells", "Of one example."),
        limit("glb_bytes_max", requests.glb_bytes_max, "bytes", "Of a GLB within a request."),
        limit(
            "model_bytes_max",
            GlbOptions{}.bytes_max,
            "bytes",
            "Of a GLB that is made; 422 too-large beyond."
        ),
        limit(
            "gzipped_model_bytes_max",
            JobModels::kGzippedBytesMax,
            "bytes",
            "Of a GLB that is sent with gzip; larger ones are had as they are alone."
        ),
    };
}

std::vector<Limit> retention_times(const Config& config) {
    return {
        {"model_seconds",
         static_cast<double>(config.retention_ms) / 1000,
         "seconds",
         "Models, previews and labels, from the end of their job; it tells when in expires. 410 "
         "then."},
        {"job_seconds",
         static_cast<double>(config.retention_ms + config.jobs.forget_after_expiry_ms) / 1000,
         "seconds",
         "A job and its events, from its end. 404 then."},
        {"idempotency_key_seconds",
         std::nullopt,
         "seconds",
         "As long as the job that it named. It is known to the key that it came with alone, or to "
         "all where there are no keys, and is looked at on POST /v1/jobs."},
        {"example_seconds", std::nullopt, "seconds", "An uploaded example: until it is deleted."},
    };
}

}  // namespace

std::string limits_document(const Config& config) {
    std::vector<Limit> limits = limits_of_models(config.jobs.limits);
    append(limits, limits_of_documents(config.jobs.limits));
    append(limits, limits_of_service(config.jobs, config.webhooks));
    append(limits, limits_of_running_jobs(config.jobs));
    append(limits, limits_of_keys());
    append(limits, limits_of_connections(config.http.limits));
    append(limits, limits_of_streams(config.http.limits));
    return proto::limits_json(limits, retention_times(config));
}

}  // namespace modelsynth::server
