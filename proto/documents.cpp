#include "proto/documents.h"

#include "proto/json.h"
#include "proto/problem.h"
#include "proto/schemas.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

namespace {

constexpr std::string_view kSchemaPlace = "#/components/schemas/";
constexpr std::string_view kResponsePlace = "#/components/responses/";

// job_request -> JobRequest, discrete.from -> DiscreteFrom
std::string component_name(std::string_view schema) {
    std::string name;
    bool begins = true;
    for (const char c : schema) {
        if (c == '_' || c == '.') {
            begins = true;
            continue;
        }
        name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = false;
    }
    return name;
}

// The schema whose $defs one of these means by #/$defs: how to start from a job is told in the
// words of the parameters.
std::string home_of_definitions(std::string_view schema) {
    constexpr std::string_view kFrom = ".from";
    return schema.ends_with(kFrom)
               ? std::string(schema.substr(0, schema.size() - kFrom.size())) + ".parameters"
               : std::string(schema);
}

// Puts schemas into a document as far as it refers to them.
class SchemaPlacer {
  public:
    explicit SchemaPlacer(OrderedJson& document) : document_(document) {}

    void place() {
        point_to_components(document_, "");
        OrderedJson& placed = document_["components"]["schemas"];
        while (!wanted_.empty()) {
            const std::string name = wanted_.back();
            wanted_.pop_back();
            OrderedJson schema = OrderedJson::parse(text_of(name));
            schema.erase("$schema");
            point_to_components(schema, home_of_definitions(name));
            if (name == "problem") {
                schema["properties"]["type"]["enum"] = problem_types();
            }
            placed[component_name(name)] = std::move(schema);
        }
    }

  private:
    static const char* text_of(std::string_view name) {
        const auto* found =
            std::find_if(kSchemas.begin(), kSchemas.end(), [name](const SchemaText& schema) {
                return schema.name == name;
            });
        check(found != kSchemas.end(), "a document refers to an unknown schema");
        return found->text;
    }

    static OrderedJson problem_types() {
        OrderedJson types = OrderedJson::array({"about:blank"});
        for (const ProblemKind& kind : problem_kinds()) {
            types.push_back("/problems/" + std::string(kind.name));
        }
        return types;
    }

    // `home`: the schema that a reference to # means; none: the document itself.
    void point_to_components(OrderedJson& json, const std::string& home) {
        if (json.is_object() && json.contains("$ref")) {
            json["$ref"] = target_of(json["$ref"], home);
        }
        if (json.is_structured()) {
            for (OrderedJson& part : json) {
                point_to_components(part, home);
            }
        }
    }

    std::string target_of(const std::string& reference, const std::string& home) {
        const std::size_t hash = std::min(reference.find('#'), reference.size());
        if (hash == 0 && home.empty()) {
            return reference;
        }
        const std::string schema = hash == 0 ? home : without_suffix(reference.substr(0, hash));
        const std::string place = hash < reference.size() ? reference.substr(hash + 1) : "";
        if (known_.insert(schema).second) {
            wanted_.push_back(schema);
        }
        return std::string(kSchemaPlace) + component_name(schema) + place;
    }

    // ../schemas/job.json -> job
    static std::string without_suffix(const std::string& file) {
        const std::size_t slash = file.rfind('/');
        const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
        return file.substr(begin, file.rfind(".json") - begin);
    }

    OrderedJson& document_;
    std::set<std::string> known_;
    std::vector<std::string> wanted_;
};

struct HeaderOfStatus {
    int status;
    const char* name;
    const char* component;
};

constexpr std::array<HeaderOfStatus, 6> kHeadersOfProblems = {
    {{401, "WWW-Authenticate", "WwwAuthenticate"},
     {415, "Accept", "Accept"},
     {429, "Retry-After", "RetryAfter"},
     {429, "RateLimit", "RateLimit"},
     {429, "RateLimit-Policy", "RateLimitPolicy"},
     {503, "Retry-After", "RetryAfter"}}};

// What whoever asks may be told before anything is looked at, wherever a key may be needed.
constexpr std::array<const char*, 5> kProblemsOfAccess = {
    "unauthorized", "missing-scope", "forbidden-origin", "unknown-host", "too-fast"};

OrderedJson reference_to(const std::string& kind, const std::string& name) {
    return {{"$ref", "#/components/" + kind + "/" + name}};
}

OrderedJson problem_response(const std::vector<ProblemKind>& kinds) {
    std::string description;
    OrderedJson types = OrderedJson::array();
    for (const ProblemKind& kind : kinds) {
        description += std::string(description.empty() ? "" : " / ") + kind.title;
        types.push_back("/problems/" + std::string(kind.name));
    }
    OrderedJson response = {{"description", description + "."}};
    for (const HeaderOfStatus& header : kHeadersOfProblems) {
        if (header.status == kinds.front().status) {
            response["headers"][header.name] = reference_to("headers", header.component);
        }
    }
    response["content"]["application/problem+json"]["schema"] = {
        {"allOf", OrderedJson::array({{{"$ref", std::string(kSchemaPlace) + "Problem"}}})},
        {"properties", {{"type", {{"enum", std::move(types)}}}}}};
    return response;
}

void add_problems(OrderedJson& operation) {
    std::map<int, std::vector<ProblemKind>> by_status;
    OrderedJson names = operation.value("x-problems", OrderedJson::array());
    if (!operation.contains("security") || !operation["security"].empty()) {
        for (const char* name : kProblemsOfAccess) {
            names.push_back(name);
        }
    }
    for (const std::string name : names) {
        const auto& kinds = problem_kinds();
        const auto kind = std::find_if(kinds.begin(), kinds.end(), [&name](const auto& known) {
            return name == known.name;
        });
        check(kind != kinds.end(), "a document names an unknown problem");
        by_status[kind->status].push_back(*kind);
    }
    operation.erase("x-problems");
    for (const auto& [status, kinds] : by_status) {
        operation["responses"][std::to_string(status)] = problem_response(kinds);
    }
    operation["responses"]["default"] = {{"$ref", std::string(kResponsePlace) + "Problem"}};
}

// The word of a response for what has an entity tag, and so conditions, codings and parts.
constexpr const char* kTagged = "x-tagged";

struct Component {
    const char* name;
    const char* component;
};

constexpr std::array<const char*, 5> kParametersOfTagged = {
    "AcceptEncoding", "IfMatch", "IfNoneMatch", "Range", "IfRange"};

constexpr std::array<Component, 5> kResponsesOfTagged = {
    {{"206", "Part"},
     {"304", "NotModified"},
     {"406", "NotAcceptable"},
     {"412", "PreconditionFailed"},
     {"416", "RangeNotSatisfiable"}}};

constexpr std::array<Component, 5> kHeadersOfTagged = {
    {{"ETag", "ETag"},
     {"Vary", "Vary"},
     {"Cache-Control", "CacheControl"},
     {"Content-Encoding", "ContentEncoding"},
     {"Accept-Ranges", "AcceptRanges"}}};

// Adds what can be asked of a resource that is answered with a tagged representation, and what is
// answered then.
void add_conditions(OrderedJson& operation, const OrderedJson& components) {
    const OrderedJson ok = operation.at("responses").value("200", OrderedJson::object());
    const std::string place = ok.value("$ref", "");
    const OrderedJson& meant =
        place.empty() ? ok : components.at("responses").at(place.substr(kResponsePlace.size()));
    if (!meant.contains(kTagged)) {
        return;
    }
    for (const char* parameter : kParametersOfTagged) {
        operation["parameters"].push_back(reference_to("parameters", parameter));
    }
    for (const Component& response : kResponsesOfTagged) {
        operation["responses"][response.name] = reference_to("responses", response.component);
    }
}

// Puts the headers in place of the word.
void add_headers_of_tagged(OrderedJson& responses) {
    for (OrderedJson& response : responses) {
        if (response.erase(kTagged) == 0) {
            continue;
        }
        for (const Component& header : kHeadersOfTagged) {
            response["headers"][header.name] = reference_to("headers", header.component);
        }
    }
}

// What HEAD does where there is GET: no body, and so no ranges of it.
OrderedJson head_of(const OrderedJson& get, const OrderedJson& components) {
    OrderedJson head = get;
    head["operationId"] = "head" + component_name(get.at("operationId").get<std::string>());
    head["summary"] = "As GET, without the body";
    head.erase("description");
    head.erase("x-codeSamples");
    for (const char* status : {"206", "416"}) {
        head["responses"].erase(status);
    }
    for (auto& [status, response] : head["responses"].items()) {
        if (response.contains("$ref")) {
            const std::string place = response.at("$ref");
            response = components.at("responses").at(place.substr(kResponsePlace.size()));
        }
        response.erase("content");
    }
    if (head.contains("parameters")) {
        OrderedJson parameters = OrderedJson::array();
        for (const OrderedJson& parameter : get.at("parameters")) {
            const std::string place = parameter.value("$ref", "");
            if (!place.ends_with("/Range") && !place.ends_with("/IfRange")) {
                parameters.push_back(parameter);
            }
        }
        head["parameters"] = std::move(parameters);
    }
    return head;
}

}  // namespace

std::string openapi_json() {
    OrderedJson document = OrderedJson::parse(kOpenApiSkeleton);
    OrderedJson& components = document["components"];
    for (OrderedJson& path : document["paths"]) {
        for (OrderedJson& operation : path) {
            if (operation.contains("operationId")) {  // not the path's parameters
                add_conditions(operation, components);
                add_headers_of_tagged(operation["responses"]);
                add_problems(operation);
            }
        }
    }
    add_headers_of_tagged(components["responses"]);
    for (OrderedJson& path : document["paths"]) {
        // A handshake has no HEAD.
        if (path.contains("get") && !path["get"]["responses"].contains("101")) {
            path["head"] = head_of(path["get"], components);
        }
    }
    SchemaPlacer(document).place();
    return dump(document);
}

std::string asyncapi_json() {
    OrderedJson document = OrderedJson::parse(kAsyncApiSkeleton);
    SchemaPlacer(document).place();
    return dump(document);
}

}  // namespace modelsynth::proto
