#pragma once

#include "proto/problem.h"
#include "server/http/admission.h"
#include "server/http/documents.h"
#include "server/http/message.h"
#include "server/jobs/job_service.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

// A function per method and resource of the contract. All may block; all are thread-safe.

namespace modelsynth::server {

// Of one page of GET /v1/jobs.
inline constexpr std::size_t kJobsPerPageDefault = 20;
inline constexpr std::size_t kJobsPerPageMax = 100;
// How long the answer to a cancellation waits for the job's end.
inline constexpr std::uint32_t kCancelWaitSecondsMax = 1;

// A request in the hands of its handler.
struct Call {
    JobService& service;
    Admission& admission;
    const std::function<std::string()>& metrics;
    const Request& request;
    std::string id;  // the {id} of the path, if it has one
    const Documents& documents;
};

[[nodiscard]] Response refuse(const Call& call, const proto::Problem& problem);

// job_handlers.cpp
[[nodiscard]] Response submit_job(const Call& call);
[[nodiscard]] Response list_jobs(const Call& call);
[[nodiscard]] Response get_job(const Call& call);
[[nodiscard]] Response cancel_job(const Call& call);
[[nodiscard]] Response delete_job(const Call& call);
[[nodiscard]] Response get_model(const Call& call);
[[nodiscard]] Response get_preview(const Call& call);
[[nodiscard]] Response get_labels(const Call& call);

// event_handlers.cpp
[[nodiscard]] Response get_events(const Call& call);
[[nodiscard]] Response get_stream(const Call& call);
[[nodiscard]] Response get_shared_stream(const Call& call);
// The events of a job from the one after `after` on, as an answer.
[[nodiscard]] Response event_stream_response(EventStreamBody body);

// example_handlers.cpp
[[nodiscard]] Response list_examples(const Call& call);
[[nodiscard]] Response upload_example(const Call& call);
[[nodiscard]] Response get_example(const Call& call);
[[nodiscard]] Response delete_example(const Call& call);
[[nodiscard]] Response get_example_model(const Call& call);
[[nodiscard]] Response get_example_pieces(const Call& call);
[[nodiscard]] Response get_example_analysis(const Call& call);
[[nodiscard]] Response get_example_success(const Call& call);
[[nodiscard]] Response get_example_figures(const Call& call);

// service_handlers.cpp
[[nodiscard]] Response list_solvers(const Call& call);
[[nodiscard]] Response get_solver(const Call& call);
[[nodiscard]] Response give_ticket(const Call& call);
[[nodiscard]] Response healthz(const Call& call);
[[nodiscard]] Response readyz(const Call& call);
[[nodiscard]] Response get_metrics(const Call& call);
[[nodiscard]] Response get_problem(const Call& call);
[[nodiscard]] Response get_limits(const Call& call);
[[nodiscard]] Response get_openapi(const Call& call);
[[nodiscard]] Response get_asyncapi(const Call& call);
[[nodiscard]] Response get_docs_page(const Call& call);
[[nodiscard]] Response get_start_page(const Call& call);

}  // namespace modelsynth::server
