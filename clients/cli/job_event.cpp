#include "clients/cli/job_event.h"

#include <nlohmann/json.hpp>

namespace modelsynth::cli {

namespace {

// With the order of the fields kept, so that an event is shown as it came.
using Json = nlohmann::ordered_json;

const Json& field(const Json& object, const char* name) {
    static const Json nothing;
    const auto found = object.is_object() ? object.find(name) : object.end();
    return found == object.end() ? nothing : *found;
}

std::uint64_t count_field(const Json& object, const char* name) {
    const Json& value = field(object, name);
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
}

std::string text_field(const Json& object, const char* name) {
    const Json& value = field(object, name);
    return value.is_string() ? value.get<std::string>() : "";
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string embedded(const Json& object, const char* name) {
    const Json& value = field(object, name);
    return value.is_object() ? dump(value) : "";
}

std::vector<std::string> texts_field(const Json& object, const char* name) {
    std::vector<std::string> texts;
    const Json& list = field(object, name);
    for (const Json& text : list.is_array() ? list : Json::array()) {
        if (text.is_string()) {
            texts.push_back(text);
        }
    }
    return texts;
}

// How many models a result tells of; 0: there is none.
std::uint32_t model_count(const Json& result) {
    const Json& alternatives = field(result, "alternatives");
    if (alternatives.is_array() && !alternatives.empty()) {
        return static_cast<std::uint32_t>(alternatives.size());
    }
    return result.is_object() ? 1 : 0;
}

}  // namespace

std::optional<JobEvent> parse_job_event(std::string_view text) {
    const Json json = Json::parse(text, nullptr, false);
    JobEvent event;
    event.seq = count_field(json, "seq");
    event.type = text_field(json, "type");
    if (event.seq == 0 || event.type.empty()) {
        return std::nullopt;
    }
    const Json& job_progress = field(field(json, "job"), "progress");
    const Json& progress = event.type == "snapshot" ? job_progress : json;
    event.blocks_done = count_field(progress, "blocks_done");
    event.blocks_total = count_field(progress, "blocks_total");
    event.warnings =
        event.type == "started" ? texts_field(json, "warnings") : std::vector<std::string>();
    event.is_accepted = text_field(json, "outcome") == "accepted";
    event.position = count_field(json, "position");
    const Json& stats = field(field(json, "result"), "stats");
    event.accepted = count_field(stats, "blocks_accepted");
    event.reverted = count_field(stats, "blocks_reverted");
    event.models = event.type == "succeeded" ? model_count(field(json, "result")) : 0;
    event.error = embedded(json, "error");
    event.text = dump(json);
    return event;
}

std::optional<JobEnd> end_of_job(std::string_view job_json) {
    const Json job = Json::parse(job_json, nullptr, false);
    const std::string state = text_field(job, "state");
    if (state != "succeeded" && state != "failed" && state != "cancelled") {
        return std::nullopt;
    }
    return JobEnd{state, embedded(job, "error"), model_count(field(job, "result"))};
}

std::optional<JobEnd> end_of_event(const JobEvent& event) {
    if (event.type != "succeeded" && event.type != "failed" && event.type != "cancelled") {
        return std::nullopt;
    }
    return JobEnd{event.type, event.error, event.models};
}

}  // namespace modelsynth::cli
