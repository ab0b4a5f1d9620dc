// Texts that the user gives are checked to be JSON but spliced as they are, never rewritten: what
// is wrong with them, such as a field that stands there twice, is then refused with its place.

#include "clients/cli/request_body.h"

#include "clients/cli/input_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace modelsynth::cli {

namespace {

using Json = nlohmann::ordered_json;

bool is_example_file(const std::string& example) {
    return example.ends_with(".json") || example.find('/') != std::string::npos;
}

std::string quote(const std::string& text) {
    return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

Outcome<std::string> example_text(const std::string& example) {
    if (!is_example_file(example)) {
        return quote(example);
    }
    return read_example_file(example);
}

// The solver that an example says it is for, or the one that most are for: what it really is, the
// server finds out.
std::string solver_of_example(const std::string& text) {
    const Json example = Json::parse(text, nullptr, false);
    const auto kind = example.is_object() ? example.find("kind") : example.end();
    return kind != example.end() && kind->is_string() ? kind->get<std::string>() : "discrete";
}

// The object's text with a field put before the others.
std::string with_field(const std::string& object, const std::string& field) {
    const std::size_t open = object.find('{');
    const bool is_empty = Json::parse(object).empty();
    return object.substr(0, open + 1) + field + (is_empty ? "" : ",") + object.substr(open + 1);
}

Outcome<std::string> parameters_text(const RequestOptions& options) {
    std::string text = options.parameters.empty() ? "{}" : options.parameters;
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos || text[first] != '{') {
        auto file = read_input(text);
        if (!file) {
            return file;
        }
        text = std::move(*file);
    }
    if (!Json::parse(text, nullptr, false).is_object()) {
        return wrong_usage("the parameters are not a JSON object");
    }
    if (options.size.empty()) {
        return text;
    }
    const auto size = parse_size(options.size);
    if (!size) {
        return wrong_usage("the size \"" + options.size + "\" is not like 40x10x40");
    }
    return with_field(text, "\"size\":" + Json(*size).dump());
}

// Three counts with a separator between them.
std::optional<std::array<std::uint32_t, 3>> parse_three(std::string_view text, char separator) {
    std::array<std::uint32_t, 3> three = {};
    const char* next = text.data();
    const char* const end = text.data() + text.size();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis > 0 && (next == end || *next++ != separator)) {
            return std::nullopt;
        }
        const auto [stop, error] = std::from_chars(next, end, three[axis]);
        if (error != std::errc()) {
            return std::nullopt;
        }
        next = stop;
    }
    return next == end ? std::optional(three) : std::nullopt;
}

Outcome<std::string> from_text(const RequestOptions& options) {
    Json from = {{"job", options.from}};
    if (!options.at.empty()) {
        const auto at = parse_three(options.at, ',');
        if (!at) {
            return wrong_usage("the place \"" + options.at + "\" is not like 10,0,10");
        }
        from["at"] = *at;
    }
    if (!options.box.empty()) {
        const std::string_view box = options.box;
        const std::size_t colon = std::min(box.find(':'), box.size());
        const auto min = parse_three(box.substr(0, colon), ',');
        const auto max = parse_three(box.substr(std::min(colon + 1, box.size())), ',');
        if (!min || !max) {
            return wrong_usage("the box \"" + options.box + "\" is not like 0,0,0:8,10,8");
        }
        from["box"] = {{"min", *min}, {"max", *max}};
    }
    return from.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Outcome<std::string> tags_text(const std::vector<std::string>& tags) {
    Json object = Json::object();
    for (const std::string& tag : tags) {
        const std::size_t equals = tag.find('=');
        if (equals == 0 || equals == std::string::npos) {
            return wrong_usage("the tag \"" + tag + "\" is not like name=value");
        }
        object[tag.substr(0, equals)] = tag.substr(equals + 1);
    }
    return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Outcome<std::string> make_request_body(const RequestOptions& options) {
    if (!options.request_file.empty()) {
        return read_input(options.request_file);
    }
    std::string body = "{";
    const auto add = [&body](const char* name, const std::string& text) {
        body += std::string(body.size() > 1 ? "," : "") + "\"" + name + "\":" + text;
    };
    std::string example;
    if (!options.example.empty()) {
        auto text = example_text(options.example);
        if (!text) {
            return text;
        }
        example = std::move(*text);
    }
    if (!options.solver.empty() || options.from.empty()) {
        add("solver", quote(options.solver.empty() ? solver_of_example(example) : options.solver));
    }
    if (!example.empty()) {
        add("example", example);
    }
    if (!options.from.empty()) {
        const auto from = from_text(options);
        if (!from) {
            return from;
        }
        add("from", *from);
    }
    if (options.seed) {
        add("seed", std::to_string(*options.seed));
    }
    if (options.alternatives) {
        add("alternatives", std::to_string(*options.alternatives));
    }
    if (!options.parameters.empty() || !options.size.empty()) {
        const auto parameters = parameters_text(options);
        if (!parameters) {
            return parameters;
        }
        add("parameters", *parameters);
    }
    if (options.priority) {
        add("priority", std::to_string(*options.priority));
    }
    if (options.deadline_seconds) {
        if (!std::isfinite(*options.deadline_seconds)) {
            return wrong_usage("the deadline is no number of seconds");
        }
        add("deadline", Json(*options.deadline_seconds).dump());
    }
    if (!options.tags.empty()) {
        const auto tags = tags_text(options.tags);
        if (!tags) {
            return tags;
        }
        add("tags", *tags);
    }
    return body + "}";
}

std::optional<std::array<std::uint32_t, 3>> parse_size(std::string_view text) {
    return parse_three(text, 'x');
}

}  // namespace modelsynth::cli
