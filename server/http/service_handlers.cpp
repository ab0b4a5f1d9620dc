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

Response healthz(const Call& /*call*/) { return json_response(200, R"({"status":"alive"})"); }

Response readyz(const Call& call) {
    if (call.service.is_ready()) {
        return json_response(200, R"({"status":"ready"})");
    }
    return refuse(
        call,
        call.service.is_draining() ? make_problem("draining", "the server is stopping")
                                   : make_problem("queue-full", "no work is taken right now")
    );
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

}  // namespace modelsynth::server
