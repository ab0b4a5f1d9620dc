#include "proto/job_request.h"

#include "proto/discrete_codec.h"
#include "proto/json.h"

#include <algorithm>
#include <utility>

namespace modelsynth::proto {

namespace {

struct NamedExample {
    std::string id;  // empty: inline
    std::optional<Example> example;
};

NamedExample read_named_example(
    const Value& value, const RequestLimits& limits, const FindExample& find_example
) {
    NamedExample named;
    if (value.json().is_object()) {
        if (auto example = read_example(value, limits)) {
            named.example = std::make_shared<const discrete::Example>(std::move(*example));
        }
        return named;
    }
    if (!value.json().is_string()) {
        value.fault("must be the id of an example or an example object");
        return named;
    }
    named.id = value.string(limits.name_characters_max).value_or("");
    named.example = find_example(named.id);
    if (!named.example) {
        value.fault("there is no example \"" + named.id.substr(0, 64) + "\"");
    }
    return named;
}

OrderedJson read_tags(const Value& value, const RequestLimits& limits) {
    OrderedJson tags = OrderedJson::object();
    if (!value.json().is_object()) {
        value.fault("must be an object of strings");
        return tags;
    }
    if (value.json().size() > limits.tags_max) {
        value.fault("must have at most " + std::to_string(limits.tags_max) + " entries");
        return tags;
    }
    for (const auto& [name, json] : value.json().items()) {
        const Value tag(json, value.pointer() + "/" + pointer_part(name), value.faults());
        if (name.size() > limits.name_characters_max) {
            tag.fault("the name is too long");
        }
        tags[name] = tag.string(1024).value_or("");
    }
    return tags;
}

// A size over model_cells_max or blocks_max passes a limit of the server rather than a rule of
// the contract, and has a type of its own when nothing else is wrong.
bool only_too_large(const std::vector<Fault>& faults) {
    return std::all_of(faults.begin(), faults.end(), [](const Fault& fault) {
        return fault.over_limit;
    });
}

// What only shows once the defaults are filled in: against the example, and against the limits.
void check_complete(
    const Example& example,
    const Parameters& parameters,
    const RequestLimits& limits,
    Faults& faults
) {
    faults.add_all("/parameters", find_faults(example, parameters));
    const auto& discrete = std::get<discrete::Parameters>(parameters);
    if (discrete.size->cell_count() > limits.model_cells_max) {
        faults.add(
            "/parameters/size",
            "the example's default size passes the limit model_cells_max, " +
                std::to_string(limits.model_cells_max),
            true
        );
    } else if (*discrete.blocks && !schedule_blocks(*discrete.size, (*discrete.blocks)->layout,
                                                    limits.blocks_max)) {
        faults.add(
            "/parameters/blocks",
            "the schedule would have more blocks than the limit blocks_max, " +
                std::to_string(limits.blocks_max),
            true
        );
    }
}

Problem refusal(std::vector<Fault> faults) {
    const bool too_large = only_too_large(faults);
    const std::string detail =
        faults.size() == 1 ? faults.front().pointer + ": " + faults.front().detail
                           : std::to_string(faults.size()) + " things are wrong with the request";
    Problem problem = make_problem(too_large ? "too-large" : "invalid-request", detail);
    problem.errors = std::move(faults);
    return problem;
}

}  // namespace

Parsed<JobRequest> parse_job_request(
    std::string_view body,
    const RequestLimits& limits,
    const FindExample& find_example,
    std::uint64_t seed_if_absent
) {
    auto json = parse_json(body, limits.json);
    if (!json) {
        return tl::unexpected(std::move(json.error()));
    }
    Faults faults;
    JobRequest request;
    ObjectReader reader(Value(*json, "", faults));
    if (const auto solver = reader.required("solver")) {
        static_cast<void>(solver->one_of({"discrete"}));
        request.solver = "discrete";
    }
    NamedExample named;
    const auto example = reader.required("example");
    if (example) {
        Faults example_faults;
        named = read_named_example(
            Value(example->json(), example->pointer(), example_faults), limits, find_example
        );
        faults.add_all("", example_faults.take());
    }
    request.example_id = named.id;
    request.task.seed = seed_if_absent;
    if (const auto seed = reader.optional("seed")) {
        request.task.seed = static_cast<std::uint64_t>(
            seed->integer(0, static_cast<std::int64_t>(kSeedMax)).value_or(0)
        );
    }
    discrete::Parameters parameters;
    bool size_is_usable = true;
    if (const auto given = reader.optional("parameters")) {
        parameters = read_parameters(*given, limits);
        const bool asks_size = given->json().is_object() && given->json().contains("size");
        size_is_usable = !asks_size || (parameters.size &&
                                        parameters.size->cell_count() <= limits.model_cells_max);
    }
    if (const auto priority = reader.optional("priority")) {
        request.priority = static_cast<std::int32_t>(priority->integer(-10, 10).value_or(0));
    }
    if (const auto deadline = reader.optional("deadline")) {
        request.deadline_seconds = deadline->number_above(0, limits.deadline_seconds_max);
    }
    OrderedJson tags = OrderedJson::object();
    if (const auto given = reader.optional("tags")) {
        tags = read_tags(*given, limits);
    }
    reader.finish();
    // Without a usable size nothing can be said about places in the model.
    if (named.example && size_is_usable) {
        request.task.example = *named.example;
        request.task.parameters = with_defaults(parameters, *named.example);
        check_complete(*named.example, request.task.parameters, limits, faults);
    }
    if (!faults.empty()) {
        return tl::unexpected(refusal(faults.take()));
    }
    OrderedJson echo = {
        {"solver", request.solver},
        {"example", nullptr},
        {"seed", request.task.seed},
        {"parameters", write_parameters(std::get<discrete::Parameters>(request.task.parameters))},
        {"priority", request.priority}};
    if (request.example_id.empty()) {
        echo["example"] = OrderedJson::parse(dump(example->json()), nullptr, false);
    } else {
        echo["example"] = request.example_id;
    }
    if (request.deadline_seconds) {
        echo["deadline"] = *request.deadline_seconds;
    }
    echo["tags"] = std::move(tags);
    request.echo = dump(echo);
    return request;
}

Parsed<std::string> canonical_json(std::string_view body, const JsonLimits& limits) {
    auto json = parse_json(body, limits);
    if (!json) {
        return tl::unexpected(std::move(json.error()));
    }
    return dump(*json);
}

}  // namespace modelsynth::proto
