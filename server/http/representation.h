#pragma once

#include "server/http/message.h"

#include <functional>
#include <memory>
#include <string>
#include <variant>

namespace modelsynth::server {

using Content = std::variant<std::string, std::shared_ptr<ArtifactStore::Reader>>;

// One representation of a resource: its bytes, in memory or in a file, and its strong tag.
struct Representation {
    std::string media_type;
    std::string etag;  // quoted, of the content as it is
    std::string file_name;
    Content content;
    // The content coded with gzip, where that is kept. Without it, what is in memory is coded for
    // this answer and a file is only had as it is.
    std::function<proto::Parsed<Content>()> gzipped = {};
};

// Answers a GET or HEAD for it as RFC 9110 (12.5.3, 13.2.2, 14) says: Accept-Encoding, then
// If-Match, If-None-Match, Range with If-Range. 304, 206, 406, 412, 416 or 200. What is coded has
// a tag of its own and no ranges; several ranges are answered with the whole.
[[nodiscard]] Response respond_with(const Request& request, Representation representation);

// Bytes that are made for this answer alone.
[[nodiscard]] Representation in_memory(std::string media_type, std::string content);
[[nodiscard]] Representation glb_in_memory(std::string glb, std::string file_name);

// A JSON text with its tag.
[[nodiscard]] Response respond_with_json(const Request& request, std::string json);

}  // namespace modelsynth::server
