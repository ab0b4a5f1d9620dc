#pragma once

#include <string>

namespace modelsynth::server {

// What the server tells about itself, made once at its start.
struct Documents {
    struct Document {
        std::string text;
        std::string etag = {};    // quoted
        std::string policy = {};  // Content-Security-Policy of a page
    };

    std::string limits;  // JSON
    Document openapi;
    Document asyncapi;
    Document docs;   // page
    Document start;  // page
};

// `limits`: the resource /v1/limits.
[[nodiscard]] Documents make_documents(std::string limits);

}  // namespace modelsynth::server
