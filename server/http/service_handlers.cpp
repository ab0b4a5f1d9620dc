#include "proto/example_codec.h"
#include "proto/job.h"
#include "server/http/handlers.h"
#include "server/http/representation.h"
#include "server/http/request_fields.h"

#include <utility>

namespace modelsynth::server {

using proto::make_problem;

Response refuse(const Call& call, const proto::Problem& problem) {
    return problem_response(problem, call.request);
}

Response list_solvers(const Call& call) {
    return respond_with_json(call.request, proto::solver_list_json());
}

Response get_solver(const Call& call) {
    std::string solver = proto::solver_json(call.id);
    if (solver.empty()) {
        return refuse(
            call, make_problem("not-found", "there is no solver " + call.id.substr(0, 64))
        );
    }
    return respond_with_json(call.request, std::move(solver));
}

Response give_ticket(const Call& call) {
    const auto job_id = proto::parse_ticket_request(call.request.body);
    if (!job_id) {
        return refuse(call, job_id.error());
    }
    if (!job_id->empty()) {
        if (const auto job = call.service.find(*job_id, call.request.caller); !job) {
            return refuse(call, job.error());
        }
    }
    return call.admission.give_ticket(call.request, *job_id);
}

Response healthz(const Call& /*call*/) { return json_response(200, R"({"status":"alive"})"); }

Response readyz(const Call& call) {
    if (const auto ready = call.service.check_ready(); !ready) {
        return refuse(call, ready.error());
    }
    return json_response(200, R"({"status":"ready"})");
}

Response get_metrics(const Call& call) {
    return {
        200,
        {{"Content-Type", "text/plain; version=0.0.4; charset=utf-8"},
         {"Cache-Control", "no-store"}},
        call.metrics()};
}

Response get_problem(const Call& call) {
    for (const proto::ProblemKind& kind : proto::problem_kinds()) {
        if (call.id == kind.name) {
            return {
                200,
                {{"Content-Type", "text/plain; charset=utf-8"}},
                std::string(kind.title) + "\n\n" + kind.explanation + "\n"};
        }
    }
    return refuse(call, make_problem("not-found", "there is no such problem"));
}

Response get_limits(const Call& call) { return json_response(200, call.documents.limits); }

namespace {

Response respond_with_document(
    const Call& call, const Documents::Document& document, const char* media_type
) {
    Representation representation;
    representation.media_type = media_type;
    representation.etag = document.etag;
    representation.content = document.text;
    Response response = respond_with(call.request, std::move(representation));
    const bool has_content = response.status == 200 || response.status == 206;
    if (has_content && !document.policy.empty()) {
        response.headers.emplace_back("Content-Security-Policy", document.policy);
    }
    return response;
}

}  // namespace

Response get_openapi(const Call& call) {
    return respond_with_document(call, call.documents.openapi, "application/json");
}

Response get_asyncapi(const Call& call) {
    return respond_with_document(call, call.documents.asyncapi, "application/json");
}

Response get_docs_page(const Call& call) {
    return respond_with_document(call, call.documents.docs, "text/html; charset=utf-8");
}

Response get_start_page(const Call& call) {
    return respond_with_document(call, call.documents.start, "text/html; charset=utf-8");
}

}  // namespace modelsynth::server
