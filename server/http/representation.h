#pragma once

#include "server/http/message.h"

#include <cstdint>
#include <optional>
#include <string>

namespace modelsynth::server {

// One representation of a resource: its bytes, in memory or in a file, and its strong tag.
struct Representation {
    std::string media_type;
    std::string etag;  // quoted
    std::string file_name;
    std::variant<std::string, std::shared_ptr<ArtifactStore::Reader>> content;
};

// Answers a GET or HEAD for it as RFC 9110 (13.2.2, 14) says: If-Match, then If-None-Match, then
// Range with If-Range. 304, 206, 416 or 200. Several ranges are answered with the whole.
[[nodiscard]] Response respond_with(const Request& request, Representation representation);

// Bytes that are made for this answer alone.
[[nodiscard]] Representation glb_in_memory(std::string glb, std::string file_name);

}  // namespace modelsynth::server
