#pragma once

#include "clients/cli/request_body.h"

#include <string>

namespace modelsynth::cli {

// How a model is written, each empty for the server's default.
struct ModelForm {
    std::string profile;      // nodes, instanced or merged
    std::string compression;  // none or meshopt
};

// `modelsynth run`: a request, and where its model goes.
struct RunOptions {
    RequestOptions request;
    std::string output;  // a file, "-" for standard output
    ModelForm form;
    bool is_local = false;
};

}  // namespace modelsynth::cli
