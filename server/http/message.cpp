#include "server/http/message.h"

#include <algorithm>
#include <cstddef>

namespace modelsynth::server {

namespace {

std::optional<std::string> find_field(const Fields& fields, std::string_view name) {
    const auto found = std::find_if(fields.begin(), fields.end(), [name](const auto& field) {
        return field.first == name;
    });
    return found == fields.end() ? std::nullopt : std::optional(found->second);
}

int hex_value(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

bool decode(std::string_view text, bool plus_is_space, std::string& decoded) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\0') {
            return false;
        }
        if (text[i] == '+' && plus_is_space) {
            decoded += ' ';
        } else if (text[i] != '%') {
            decoded += text[i];
        } else {
            const int high = i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
            const int low = i + 2 < text.size() ? hex_value(text[i + 2]) : -1;
            if (high < 0 || low < 0 || (high == 0 && low == 0)) {
                return false;
            }
            decoded += static_cast<char>(high * 16 + low);
            i += 2;
        }
    }
    return true;
}

// Schemes are of any case (RFC 3986 3.1).
bool is_absolute(std::string_view target) {
    static constexpr std::string_view kScheme = "http://";
    return std::equal(
        kScheme.begin(),
        kScheme.end(),
        target.begin(),
        target.begin() + static_cast<std::ptrdiff_t>(std::min(target.size(), kScheme.size())),
        [](char scheme, char c) { return scheme == (c >= 'A' && c <= 'Z' ? c + 32 : c); }
    );
}

}  // namespace

std::optional<std::string> Request::header(std::string_view name) const {
    return find_field(headers, name);
}

std::optional<std::string> Request::header_list(std::string_view name) const {
    std::optional<std::string> list;
    for (const auto& [field, value] : headers) {
        if (field == name) {
            list = list ? *list + ", " + value : value;
        }
    }
    return list;
}

std::optional<std::string> Request::query_field(std::string_view name) const {
    return find_field(query, name);
}

Response json_response(int status, std::string body) {
    return {status, {{"Content-Type", "application/json"}}, std::move(body)};
}

Response problem_response(const proto::Problem& problem, const Request& request) {
    proto::Problem placed = problem;
    if (placed.instance.empty()) {
        placed.instance = request.target.substr(0, request.target.find('?'));
    }
    Response response = {
        problem.status, {{"Content-Type", "application/problem+json"}}, proto::to_json(placed)};
    if (problem.status == 503 || problem.status == 429) {
        response.headers.emplace_back("Retry-After", std::to_string(problem.retry_after_seconds));
    }
    if (const std::size_t slash = problem.type.rfind('/'); slash != std::string::npos) {
        response.problem = problem.type.substr(slash + 1);
    }
    return response;
}

bool parse_target(std::string_view target, Request& request) {
    request.target.clear();
    if (is_absolute(target)) {  // which names the same resource
        const std::size_t end = std::min(target.find_first_of("/?", 7), target.size());
        const std::string_view authority = target.substr(7, end - 7);
        if (authority.empty() || authority.find('@') != std::string_view::npos) {
            return false;  // of no host, or a password that nobody should send
        }
        target.remove_prefix(end);
        request.target = target.starts_with('/') ? "" : "/";
    }
    request.target += target;
    target = request.target;
    if (target.empty() || target.front() != '/') {
        return false;
    }
    const std::size_t question = target.find('?');
    std::string_view path = target.substr(
        1, question == std::string_view::npos ? std::string_view::npos : question - 1
    );
    while (!path.empty()) {
        const std::size_t slash = path.find('/');
        std::string segment;
        if (!decode(path.substr(0, slash), false, segment)) {
            return false;
        }
        request.path.push_back(std::move(segment));
        path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
        if (slash != std::string_view::npos && path.empty()) {
            request.path.emplace_back();  // "/v1/jobs/" is not "/v1/jobs"
        }
    }
    std::string_view query =
        question == std::string_view::npos ? std::string_view() : target.substr(question + 1);
    while (!query.empty()) {
        const std::size_t ampersand = query.find('&');
        const std::string_view field = query.substr(0, ampersand);
        const std::size_t equals = field.find('=');
        std::string name;
        std::string value;
        if (!decode(field.substr(0, equals), true, name) ||
            (equals != std::string_view::npos && !decode(field.substr(equals + 1), true, value))) {
            return false;
        }
        if (!field.empty()) {
            request.query.emplace_back(std::move(name), std::move(value));
        }
        query =
            ampersand == std::string_view::npos ? std::string_view() : query.substr(ampersand + 1);
    }
    return true;
}

}  // namespace modelsynth::server
