#include "server/http/excuse.h"

#include "proto/problem.h"
#include "server/log/event_line.h"

#include <exception>

namespace modelsynth::server {

Response answer_or_excuse(
    const Request& request, spdlog::logger& log, const std::function<Response()>& answer
) {
    try {
        return answer();
    } catch (const std::exception& error) {
        log_event(
            log,
            spdlog::level::err,
            "a request threw",
            {{"request", request.id}, {"target", request.target}, {"what", error.what()}}
        );
        return problem_response(
            proto::make_problem("internal", "the request ran into a fault of the server"), request
        );
    }
}

}  // namespace modelsynth::server
