#include "proto/problem.h"

#include "proto/explanation_codec.h"
#include "proto/json.h"
#include "proto/limits.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace modelsynth::proto {

const std::vector<ProblemKind>& problem_kinds() {
    static const std::vector<ProblemKind> kinds = {
        {"malformed-json",
         "The body is not JSON",
         400,
         "The body could not be read as JSON. The detail gives the byte at which reading stopped."},
        {"malformed-request",
         "The request cannot be read",
         400,
         "The request is not well-formed HTTP, or a header or query parameter is malformed."},
        {"invalid-request",
         "The request cannot be done",
         422,
         "The request was read but asks for something that is unknown, out of range or "
         "impossible. Each entry of errors points to the place with a JSON Pointer."},
        {"too-large",
         "The request is too large",
         422,
         "The request passes a limit of this server. The detail names the limit."},
        {"body-too-large",
         "The body is too large",
         413,
         "The body has more bytes than this server takes."},
        {"unsupported-media-type",
         "The media type is not taken here",
         415,
         "The Content-Type of the body is not one that this resource takes."},
        {"not-found",
         "There is nothing here",
         404,
         "The path or the id is unknown, or was deleted."},
        {"expired", "This is gone", 410, "It was here and is no longer kept."},
        {"method-not-allowed",
         "The method is not allowed here",
         405,
         "The Allow header lists the methods that this path takes."},
        {"not-finished",
         "The job has not finished",
         409,
         "What was asked for exists only once the job has succeeded. Its events tell when."},
        {"no-model",
         "The job has no model",
         409,
         "The job failed or was cancelled, so that it has no finished model. A preview may be "
         "there."},
        {"idempotency-conflict",
         "The key was used for another request",
         422,
         "An Idempotency-Key names one request for good; another body needs another key."},
        {"example-in-use",
         "The example is in use",
         409,
         "An unfinished job still needs the example."},
        {"forbidden", "This is not allowed", 403, "What was asked for is never allowed here."},
        {"unauthorized",
         "A key is needed",
         401,
         "This server takes requests with a key alone, as Authorization: Bearer KEY; a browser's "
         "stream may carry a ticket from POST /v1/tickets instead, once."},
        {"missing-scope",
         "The key is not for this",
         403,
         "The key is known, but what was asked for needs a scope that it does not have."},
        {"forbidden-origin",
         "Pages from there may not ask this",
         403,
         "The Origin of the request is not one that this server's operator allows."},
        {"unknown-host",
         "This server has another name",
         421,
         "The Host of the request is not a name of this server. The operator allows further "
         "names."},
        {"too-fast",
         "Too many requests",
         429,
         "The key asks more often than it may. Retry-After tells when to come back."},
        {"too-many-jobs",
         "Too many unfinished jobs",
         429,
         "As many jobs of the key are unfinished as it may have. Retry-After tells when to come "
         "back."},
        {"too-many-webhooks",
         "Too many undelivered webhooks",
         429,
         "As many webhooks of the key have not been delivered as may wait: their receivers do not "
         "answer with 2xx, or not as fast as jobs end. Jobs without webhook are taken, others "
         "once some have arrived or are given up."},
        {"queue-full",
         "The queue is full",
         503,
         "As many jobs are waiting as this server takes. Retry-After tells when to come back."},
        {"busy",
         "The server is busy with this",
         503,
         "Others asked for the same kind of work before. Retry-After tells when to come back."},
        {"draining",
         "The server is stopping",
         503,
         "The server finishes what it has and takes no new work."},
        {"unavailable",
         "The store cannot be written",
         503,
         "Nothing was changed; the same request may be sent again."},
        {"contradiction",
         "No such model exists",
         422,
         "It was proved that no model of this size can satisfy the example, the boundary and the "
         "constraints together. The member conflict has the fewest sides, constraints (by their "
         "index), periodic axes and removed pieces found that cannot hold together, and cells with "
         "the labels that these leave to them at which it shows. It is minimal when there is a "
         "model without any one of them."},
        {"gave-up",
         "No model was found",
         422,
         "No model was found within the attempts; one may exist. Smaller blocks, free sides or "
         "another seed help. The member hottest has the cells where the attempts met dead ends, "
         "the most often first, and how many times."},
        {"deadline-exceeded",
         "The deadline passed",
         422,
         "The job was solving for longer than its deadline allows. Its preview is kept."},
        {"crashed",
         "The job could not be finished",
         500,
         "The server stopped several times at the same place of this job and does not try it "
         "again."},
        {"internal",
         "The server made a mistake",
         500,
         "Something that should not happen did. It is in the server's log."}};
    return kinds;
}

Problem make_problem(const std::string& name, std::string detail) {
    const auto& kinds = problem_kinds();
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&name](const ProblemKind& k) {
        return name == k.name;
    });
    check(kind != kinds.end(), "a problem of an unknown kind");
    return {"/problems/" + name, kind->title, kind->status, std::move(detail), {}, {}};
}

Problem problem_of(const Error& error) {
    const auto kind = [&error]() -> const char* {
        switch (error.code) {
            case ErrorCode::kMalformed:
                return "malformed-request";
            case ErrorCode::kInvalidArgument:
                return "invalid-request";
            case ErrorCode::kTooLarge:
                return "too-large";
            case ErrorCode::kContradiction:
                return "contradiction";
            case ErrorCode::kGaveUp:
                return "gave-up";
            case ErrorCode::kCancelled:
            case ErrorCode::kInternal:
                return "internal";
        }
        return "internal";
    };
    Problem problem = make_problem(kind(), error.message);
    problem.errors = error.faults;
    problem.explanation = error.explanation;
    return problem;
}

Problem plain_problem(int status, std::string detail) {
    const char* title = "Error";
    switch (status) {
        case 406:
            title = "Not Acceptable";
            break;
        case 408:
            title = "Request Timeout";
            break;
        case 414:
            title = "URI Too Long";
            break;
        case 416:
            title = "Range Not Satisfiable";
            break;
        case 417:
            title = "Expectation Failed";
            break;
        case 431:
            title = "Request Header Fields Too Large";
            break;
        case 501:
            title = "Not Implemented";
            break;
        case 505:
            title = "HTTP Version Not Supported";
            break;
        default:
            break;
    }
    return {"about:blank", title, status, std::move(detail), {}, {}};
}

std::string to_json(const Problem& problem) {
    OrderedJson document = {
        {"type", problem.type},
        {"title", problem.title},
        {"status", problem.status},
        {"detail", problem.detail}};
    if (!problem.instance.empty()) {
        document["instance"] = problem.instance;
    }
    if (!problem.errors.empty()) {
        OrderedJson errors = OrderedJson::array();
        for (const Fault& fault : problem.errors) {
            if (errors.size() == kFaultsMax) {
                break;
            }
            errors.push_back({{"pointer", fault.pointer}, {"detail", fault.detail}});
        }
        document["errors"] = std::move(errors);
    }
    add_explanation(document, problem.explanation);
    return dump(document);
}

}  // namespace modelsynth::proto
