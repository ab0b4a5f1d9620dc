#pragma once

#include "solver/core/result.h"

#include <tl/expected.hpp>

#include <any>
#include <cstdint>
#include <string>
#include <vector>

namespace modelsynth::proto {

// A problem document (RFC 9457): the body of every error answer and the `error` of a failed job.
struct Problem {
    std::string type;  // a path served by the server, such as /problems/invalid-request
    std::string title;
    int status = 500;
    std::string detail;
    std::string instance = {};  // path of the resource it is about
    std::vector<Fault> errors = {};
    std::any explanation = {};  // as of Error, or nothing; told by extension members
    // When asking again may help, for a status that says so (429, 503); no member of the document.
    std::uint64_t retry_after_seconds = 2;
};

template <class T>
using Parsed = tl::expected<T, Problem>;

// One kind of problem; the table of all of them is problem_kinds().
struct ProblemKind {
    const char* name;  // the last part of the type
    const char* title;
    int status;
    const char* explanation;  // for the page that the type's path shows
};

[[nodiscard]] const std::vector<ProblemKind>& problem_kinds();

// A problem of a kind of the table. Requires: the name is in it (checked).
[[nodiscard]] Problem make_problem(const std::string& name, std::string detail);

// The problem that a solver's error means.
[[nodiscard]] Problem problem_of(const Error& error);

// A problem without a kind of its own: type about:blank, the title of the HTTP status.
[[nodiscard]] Problem plain_problem(int status, std::string detail);

// The document as JSON. Text that is not UTF-8 is replaced, at most kFaultsMax faults are listed.
[[nodiscard]] std::string to_json(const Problem& problem);

}  // namespace modelsynth::proto
