#include "server/jobs/store_problem.h"

namespace modelsynth::server {

proto::Problem problem_of(const StoreError& error) {
    switch (error.code) {
        case StoreErrorCode::kNotFound:
            return proto::make_problem("not-found", error.message);
        case StoreErrorCode::kConflict:
            return proto::make_problem("idempotency-conflict", error.message);
        case StoreErrorCode::kQueueFull:
            return proto::make_problem("queue-full", error.message);
        case StoreErrorCode::kOwnerFull:
            return proto::make_problem("too-many-jobs", error.message);
        case StoreErrorCode::kWebhooksFull:
            return proto::make_problem("too-many-webhooks", error.message);
        case StoreErrorCode::kInvalid:
            return proto::make_problem("malformed-request", error.message);
        case StoreErrorCode::kUnavailable:
        case StoreErrorCode::kClosed:
            // The reason is the operator's; it may name paths.
            return proto::make_problem("unavailable", "the store cannot be used right now");
        case StoreErrorCode::kLeaseLost:
        case StoreErrorCode::kCorrupt:
            return proto::make_problem("internal", "the store has lost or damaged this");
    }
    return proto::make_problem("internal", "");
}

}  // namespace modelsynth::server
