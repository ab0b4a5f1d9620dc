#pragma once

#include "clients/cli/request_body.h"

#include <string>

namespace modelsynth::cli {

// `modelsynth run`: a request, and where its model goes.
struct RunOptions {
    RequestOptions request;
    std::string output;   // a file, "-" for standard output
    std::string profile;  // nodes, instanced or merged; empty: nodes
    bool is_local = false;
};

}  // namespace modelsynth::cli
