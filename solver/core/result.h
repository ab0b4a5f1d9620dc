#pragma once

#include <tl/expected.hpp>

#include <any>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth {

// What went wrong, for a program to branch on.
enum class ErrorCode : std::uint8_t {
    kMalformed,        // the input is not what it is said to be
    kInvalidArgument,  // the input cannot be done as it stands
    kTooLarge,         // a named limit is passed
    kContradiction,    // proved impossible
    kGaveUp,           // not found within the budget; may exist
    kCancelled,        // the stop token was requested
    kInternal,         // a fault of ours
};

// One fault of an input and its place: an RFC 6901 JSON Pointer relative to the input checked,
// so that a caller can put its own prefix before it. Empty: the whole input.
struct Fault {
    std::string pointer;
    std::string detail;
    bool over_limit = false;  // it passes a limit of whoever checks, not a rule
};

// An error with one sentence for a person and, for bad input, every fault that was found.
struct Error {
    ErrorCode code = ErrorCode::kInternal;
    std::string message;
    std::vector<Fault> faults = {};
    // What a program can make use of beyond that: a plain type of the solver that failed, or
    // nothing.
    std::any explanation = {};
};

// What a stop token that was requested makes of whatever was under way.
[[nodiscard]] Error cancelled();

// A name as part of a JSON Pointer (RFC 6901).
[[nodiscard]] std::string pointer_part(std::string_view name);

template <class T>
using Result = tl::expected<T, Error>;

// Throws std::logic_error when `condition` does not hold. For faults of our own code only; input is
// answered with a Result. Always on: a wrong model is worse than none, and costs the job or the
// request that met it, not the others.
void check(bool condition, const char* why);

}  // namespace modelsynth
