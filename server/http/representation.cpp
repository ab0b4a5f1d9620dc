#include "server/http/representation.h"

#include "server/http/content_coding.h"
#include "server/jobs/gzip.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

namespace modelsynth::server {

namespace {

struct ByteRange {
    std::uint64_t first = 0;
    std::uint64_t length = 0;
};

enum class RangeVerdict : std::uint8_t { kWhole, kPart, kUnsatisfiable };

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) {
        text.remove_prefix(1);
    }
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) {
        text.remove_suffix(1);
    }
    return text;
}

// Whether a list of tags has this one. `weak`: W/ counts as equal, as If-None-Match wants.
bool lists_tag(std::string_view list, std::string_view etag, bool weak) {
    while (!list.empty()) {
        const std::size_t comma = list.find(',');
        std::string_view tag = trimmed(list.substr(0, comma));
        if (tag == "*") {
            return true;
        }
        if (weak && tag.starts_with("W/")) {
            tag.remove_prefix(2);
        }
        if (tag == etag) {
            return true;
        }
        list = comma == std::string_view::npos ? std::string_view() : list.substr(comma + 1);
    }
    return false;
}

bool parse_number(std::string_view text, std::uint64_t& value) {
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    return !text.empty() && parsed.ec == std::errc() && parsed.ptr == end;
}

// A Range that is malformed or of another unit is ignored, as the RFC says.
RangeVerdict parse_range(std::string_view text, std::uint64_t size, ByteRange& range) {
    if (!text.starts_with("bytes=")) {
        return RangeVerdict::kWhole;
    }
    text = trimmed(text.substr(6));
    const std::size_t dash = text.find('-');
    if (dash == std::string_view::npos || text.find(',') != std::string_view::npos) {
        return RangeVerdict::kWhole;
    }
    const std::string_view first_text = trimmed(text.substr(0, dash));
    const std::string_view last_text = trimmed(text.substr(dash + 1));
    std::uint64_t first = 0;
    std::uint64_t last = size - 1;
    if (first_text.empty()) {
        std::uint64_t suffix = 0;
        if (!parse_number(last_text, suffix)) {
            return RangeVerdict::kWhole;
        }
        if (suffix == 0 || size == 0) {
            return RangeVerdict::kUnsatisfiable;
        }
        first = size - std::min(size, suffix);
    } else if (!parse_number(first_text, first) ||
               (!last_text.empty() && !parse_number(last_text, last)) ||
               (!last_text.empty() && last < first)) {
        return RangeVerdict::kWhole;
    }
    if (first >= size) {
        return RangeVerdict::kUnsatisfiable;
    }
    range = {first, std::min(last, size - 1) - first + 1};
    return RangeVerdict::kPart;
}

std::uint64_t size_of(const Content& content) {
    if (const auto* text = std::get_if<std::string>(&content)) {
        return text->size();
    }
    return std::get<std::shared_ptr<ArtifactStore::Reader>>(content)->size();
}

void set_body(Response& response, Content& content, const ByteRange& range) {
    if (auto* text = std::get_if<std::string>(&content)) {
        response.body = text->substr(range.first, range.length);
        return;
    }
    response.body = FileBody{
        std::get<std::shared_ptr<ArtifactStore::Reader>>(content), range.first, range.length};
}

// The tag of the content in that coding.
std::string coded_tag(const std::string& etag, ContentCoding coding) {
    return coding == ContentCoding::kGzip ? etag.substr(0, etag.size() - 1) + "-gzip\"" : etag;
}

proto::Parsed<Content> gzip_content(const Representation& representation) {
    return representation.gzipped ? representation.gzipped()
                                  : Content(gzipped(std::get<std::string>(representation.content)));
}

// The answer that the preconditions give in place of the content; nothing: they hold.
std::optional<Response> check_preconditions(const Request& request, const std::string& etag) {
    const auto if_match = request.header_list("if-match");
    if (if_match && !lists_tag(*if_match, etag, false)) {
        return problem_response(
            {"about:blank", "Precondition Failed", 412, "the entity tag is another", {}, {}},
            request
        );
    }
    const auto if_none_match = request.header_list("if-none-match");
    if (if_none_match && lists_tag(*if_none_match, etag, true)) {
        return Response{304, {}, std::string()};
    }
    return std::nullopt;
}

std::string content_range(const ByteRange& range, std::uint64_t size) {
    return "bytes " + std::to_string(range.first) + "-" +
           std::to_string(range.first + range.length - 1) + "/" + std::to_string(size);
}

Response respond_coded(
    const Request& request, Representation& representation, ContentCoding coding
) {
    const std::string etag = coded_tag(representation.etag, coding);
    const Fields headers = {
        {"ETag", etag}, {"Vary", "Accept-Encoding"}, {"Cache-Control", "no-cache"}};
    if (auto answer = check_preconditions(request, etag)) {
        answer->headers.insert(answer->headers.end(), headers.begin(), headers.end());
        return *answer;
    }
    if (coding == ContentCoding::kGzip) {
        auto content = gzip_content(representation);
        if (!content) {
            // What cannot be coded just now is better had as it is than not at all.
            return parse_accept_encoding(request.header_list("accept-encoding")).identity
                       ? respond_coded(request, representation, ContentCoding::kIdentity)
                       : problem_response(content.error(), request);
        }
        representation.content = std::move(*content);
    }
    Response response;
    response.headers = headers;
    const std::uint64_t size = size_of(representation.content);
    ByteRange range = {0, size};
    if (coding == ContentCoding::kGzip) {
        response.headers.emplace_back("Content-Encoding", "gzip");
    } else {
        response.headers.emplace_back("Accept-Ranges", "bytes");
        const auto range_field = request.header("range");
        const auto if_range = request.header("if-range");
        const auto verdict =
            range_field && request.method == "GET" && (!if_range || *if_range == etag)
                ? parse_range(*range_field, size, range)
                : RangeVerdict::kWhole;
        if (verdict == RangeVerdict::kUnsatisfiable) {
            response = problem_response(
                proto::plain_problem(416, "the range lies beyond the file"), request
            );
            response.headers.emplace_back("Vary", "Accept-Encoding");
            response.headers.emplace_back("Content-Range", "bytes */" + std::to_string(size));
            return response;
        }
        if (verdict == RangeVerdict::kPart) {
            response.status = 206;
            response.headers.emplace_back("Content-Range", content_range(range, size));
        }
    }
    response.headers.emplace_back("Content-Type", representation.media_type);
    if (!representation.file_name.empty()) {
        response.headers.emplace_back(
            "Content-Disposition", "inline; filename=\"" + representation.file_name + "\""
        );
    }
    set_body(response, representation.content, range);
    return response;
}

}  // namespace

Response respond_with(const Request& request, Representation representation) {
    const bool can_be_coded =
        representation.gzipped || std::holds_alternative<std::string>(representation.content);
    const auto coding = choose_coding(request, size_of(representation.content), can_be_coded);
    if (!coding) {
        Response response = problem_response(
            proto::plain_problem(406, "this is had as it is, or with gzip unless it is very large"),
            request
        );
        response.headers.emplace_back("Vary", "Accept-Encoding");
        return response;
    }
    return respond_coded(request, representation, *coding);
}

Representation in_memory(std::string media_type, std::string content) {
    Representation representation;
    representation.media_type = std::move(media_type);
    representation.etag = "\"" + sha256_hex(content) + "\"";
    representation.content = std::move(content);
    return representation;
}

Representation glb_in_memory(std::string glb, std::string file_name) {
    Representation representation = in_memory("model/gltf-binary", std::move(glb));
    representation.file_name = std::move(file_name);
    return representation;
}

Response respond_with_json(const Request& request, std::string json) {
    return respond_with(request, in_memory("application/json", std::move(json)));
}

}  // namespace modelsynth::server
