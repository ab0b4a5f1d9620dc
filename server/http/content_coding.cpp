#include "server/http/content_coding.h"

#include "server/http/request_fields.h"
#include "server/jobs/gzip.h"

#include <algorithm>
#include <utility>

namespace modelsynth::server {

namespace {

// A weight in thousandths, as RFC 9110 12.4.2 writes it; nothing when it is malformed.
std::optional<int> parse_weight(std::string_view text) {
    if (text.empty() || text.size() > 5 || (text[0] != '0' && text[0] != '1') ||
        (text.size() > 1 && text[1] != '.')) {
        return std::nullopt;
    }
    int weight = text[0] == '1' ? 1000 : 0;
    int unit = 100;
    for (std::size_t i = 2; i < text.size(); ++i, unit /= 10) {
        if (text[i] < '0' || text[i] > '9') {
            return std::nullopt;
        }
        weight += (text[i] - '0') * unit;
    }
    return weight <= 1000 ? std::optional(weight) : std::nullopt;
}

bool is_text(std::string_view media_type) {
    return media_type.starts_with("text/") || media_type == "application/json" ||
           media_type == "application/problem+json" || media_type == "image/svg+xml" ||
           media_type == "application/javascript";
}

bool has_header(const Response& response, std::string_view name) {
    return std::any_of(response.headers.begin(), response.headers.end(), [name](const auto& field) {
        return field.first == name;
    });
}

}  // namespace

AcceptedCodings parse_accept_encoding(const std::optional<std::string>& list) {
    if (!list) {
        return {};
    }
    std::optional<int> gzip;
    std::optional<int> identity;
    std::optional<int> others;
    for (const std::string& item : list_items(*list)) {
        const std::size_t semicolon = item.find(';');
        const std::string name = lower_case(item.substr(0, semicolon));
        std::optional<int> weight = 1000;
        if (semicolon != std::string::npos) {
            const std::string parameter = lower_case(item.substr(semicolon + 1));
            weight = parameter.starts_with("q=") ? parse_weight(parameter.substr(2)) : std::nullopt;
        }
        std::optional<int>& named = name == "gzip" || name == "x-gzip" ? gzip
                                    : name == "identity"               ? identity
                                                                       : others;
        if (weight && !named && (&named != &others || name == "*")) {
            named = weight;
        }
    }
    const int gzip_weight = gzip.value_or(others.value_or(0));
    AcceptedCodings accepted;
    accepted.gzip = gzip_weight > 0;
    accepted.identity = identity.value_or(others.value_or(1)) > 0;
    accepted.prefers_gzip = accepted.gzip && gzip_weight >= identity.value_or(0);
    return accepted;
}

std::optional<ContentCoding> choose_coding(
    const Request& request, std::uint64_t size, bool can_be_coded
) {
    const AcceptedCodings accepted = parse_accept_encoding(request.header_list("accept-encoding"));
    const bool wants_part = request.method == "GET" && request.header("range");
    if (can_be_coded && accepted.gzip &&
        (!accepted.identity || (accepted.prefers_gzip && size >= kCodedBytesMin && !wants_part))) {
        return ContentCoding::kGzip;
    }
    return accepted.identity ? std::optional(ContentCoding::kIdentity) : std::nullopt;
}

void code_body(const Request& request, Response& response) {
    auto* body = std::get_if<std::string>(&response.body);
    const auto type =
        std::find_if(response.headers.begin(), response.headers.end(), [](const auto& field) {
            return field.first == "Content-Type";
        });
    if (body == nullptr || type == response.headers.end() || has_header(response, "Vary") ||
        !is_text(type->second.substr(0, type->second.find(';')))) {
        return;
    }
    response.headers.emplace_back("Vary", "Accept-Encoding");
    if (choose_coding(request, body->size()) == ContentCoding::kGzip) {
        *body = gzipped(*body);
        response.headers.emplace_back("Content-Encoding", "gzip");
    }
}

}  // namespace modelsynth::server
