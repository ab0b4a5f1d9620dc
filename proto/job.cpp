#include "proto/job.h"

#include "proto/discrete_codec.h"
#include "proto/json.h"
#include "proto/limits.h"
#include "proto/schemas.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <utility>

namespace modelsynth::proto {

namespace {

constexpr std::array<std::string_view, 5> kStateNames = {
    "queued", "running", "succeeded", "failed", "cancelled"};

OrderedJson embed(const std::string& text) {
    return text.empty() ? OrderedJson(nullptr) : OrderedJson::parse(text, nullptr, false);
}

OrderedJson optional_time(const std::optional<UnixMillis>& time) {
    return time ? OrderedJson(to_rfc3339(*time)) : OrderedJson(nullptr);
}

// A share rounded to six places: enough for a progress bar, short on the wire.
double fraction(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) {
        return 0;
    }
    const double share = static_cast<double>(part) / static_cast<double>(whole);
    return static_cast<double>(static_cast<std::int64_t>(share * 1e6 + 0.5)) / 1e6;
}

// How a job may start from a finished one: places in the model as the parameters tell them.
OrderedJson from_schema(
    const char* schema_text,
    std::initializer_list<const char*> definitions,
    const OrderedJson& parameters
) {
    OrderedJson schema = OrderedJson::parse(schema_text);
    for (const char* name : definitions) {
        schema["$defs"][name] = parameters.at("$defs").at(name);
    }
    return schema;
}

OrderedJson alternatives_schema() {
    return {
        {"description",
         "So many different models of one request in one job, each with a result of its own."},
        {"type", "integer"},
        {"minimum", 1},
        {"maximum", RequestLimits{}.alternatives_max}};
}

OrderedJson discrete_document() {
    const OrderedJson parameters = OrderedJson::parse(schema_text("discrete.parameters"));
    return {
        {"name", "discrete"},
        {"title", "Discrete model synthesis"},
        {"description",
         "Labels on a grid: any two neighbours in the model are neighbours in the example "
         "(Merrell 2009, chapter 3)."},
        {"parameters", parameters},
        {"from",
         from_schema(
             schema_text("discrete.from"), {"box", "cells", "mask", "voxels", "cell"}, parameters
         )},
        {"alternatives", alternatives_schema()},
        {"urls", {{"self", "/v1/solvers/discrete"}}}};
}

OrderedJson continuous_document() {
    const OrderedJson parameters = OrderedJson::parse(schema_text("continuous.parameters"));
    return {
        {"name", "continuous"},
        {"title", "Continuous model synthesis"},
        {"description",
         "Solids with faces of any slope: what stands around every corner, edge and face of the "
         "model stands so in the example (Merrell 2009, chapter 4)."},
        {"parameters", parameters},
        {"from",
         from_schema(
             schema_text("continuous.from"), {"point", "box", "mask", "voxels"}, parameters
         )},
        {"alternatives", alternatives_schema()},
        {"urls", {{"self", "/v1/solvers/continuous"}}}};
}

}  // namespace

std::string_view state_name(JobState state) {
    return kStateNames.at(static_cast<std::size_t>(state));
}

std::optional<JobState> state_of(std::string_view name) {
    for (std::size_t i = 0; i < kStateNames.size(); ++i) {
        if (kStateNames.at(i) == name) {
            return static_cast<JobState>(i);
        }
    }
    return std::nullopt;
}

bool is_ended(JobState state) { return state != JobState::kQueued && state != JobState::kRunning; }

std::string to_json(const Job& job) {
    const std::string self = "/v1/jobs/" + job.id;
    // A running job's seq tells more than a share could; a finished one is whole by definition.
    const double done =
        job.state == JobState::kSucceeded ? 1.0 : fraction(job.blocks_done, job.blocks_total);
    OrderedJson document = {
        {"id", job.id},
        {"state", state_name(job.state)},
        {"seq", job.head},
        {"solver", job.solver},
        {"seed", job.seed},
        {"created", to_rfc3339(job.created)},
        {"started", optional_time(job.started)},
        {"finished", optional_time(job.finished)},
        {"expires", optional_time(job.expires)},
        {"progress",
         {{"blocks_done", job.blocks_done},
          {"blocks_total", job.blocks_total},
          {"fraction", done}}},
        {"request", embed(job.request)},
        {"result", embed(job.result)},
        {"queue", nullptr},
        {"urls",
         {{"self", self},
          {"events", self + "/events"},
          {"stream", self + "/stream"},
          {"model", self + "/model.glb"},
          {"preview", self + "/preview.glb"},
          {"labels", self + "/labels.json"},
          {"cancel", self + "/cancel"}}},
        {"error", embed(job.error)}};
    if (!solver_has_cells(job.solver)) {
        document["urls"].erase("labels");
    }
    if (job.queue_position) {
        document["queue"] = {{"position", *job.queue_position}};
    }
    return dump(document);
}

std::string list_json(
    const std::vector<std::string>& items, const std::optional<std::string>& next
) {
    std::string text = "{\"items\":[";
    for (std::size_t i = 0; i < items.size(); ++i) {
        text += i == 0 ? "" : ",";
        text += items[i];
    }
    text += "],\"next\":";
    text += next ? dump(OrderedJson(*next)) : "null";
    return text + "}";
}

std::string to_json(const JobResult& result) {
    const std::string self = "/v1/jobs/" + result.job_id;
    const SearchTally& blocks = result.stats.blocks;
    OrderedJson solved_by = OrderedJson::object();
    for (std::size_t i = 0; i < kSolvedByCount; ++i) {
        solved_by[kSolvedByNames[i]] = blocks.solved_by[i];
    }
    OrderedJson stats = {
        {"blocks_accepted", blocks.accepted()},
        {"blocks_reverted", blocks.reverted},
        {"blocks_declined", blocks.declined},
        {"solved_by", solved_by},
        {"backtracks", blocks.backtracks},
        {"changed", result.stats.changed},
        {"solve_seconds", result.solve_seconds}};
    if (result.stats.order) {
        stats["order"] = order_name({*result.stats.order});
    }
    if (result.stats.objective) {
        stats["objective"] = *result.stats.objective;
    }
    if (result.stats.polygons) {
        stats["polygons"] = *result.stats.polygons;
    }
    if (!result.stats.warnings.empty()) {
        stats["warnings"] = result.stats.warnings;
    }
    if (!result.stats.candidates.empty()) {
        OrderedJson candidates = OrderedJson::array();
        for (const auto& value : result.stats.candidates) {
            candidates.push_back(value ? OrderedJson(*value) : OrderedJson(nullptr));
        }
        stats["candidates"] = std::move(candidates);
    }
    OrderedJson document = OrderedJson::object();
    std::string query;
    if (result.place) {
        document["alternative"] = result.place->alternative;
        document["seed"] = result.place->seed;
        query = "?alternative=" + std::to_string(result.place->alternative);
    }
    document["model"] = self + "/model.glb" + query;
    if (result.has_cells) {
        document["labels"] = self + "/labels.json" + query;
    }
    document["bytes"] = result.bytes;
    document["sha256"] = result.sha256;
    document["size"] = OrderedJson::array({result.size.x, result.size.y, result.size.z});
    document["stats"] = std::move(stats);
    return dump(document);
}

std::string result_digest(const std::string& result) {
    return OrderedJson::parse(result).at("sha256");
}

std::string to_json(const std::vector<std::string>& alternatives) {
    OrderedJson all = OrderedJson::array();
    for (const std::string& alternative : alternatives) {
        all.push_back(OrderedJson::parse(alternative));
    }
    OrderedJson document = all.front();
    document.erase("alternative");
    document.erase("seed");
    for (const char* name : {"model", "labels"}) {
        if (document.contains(name)) {
            const std::string url = document.at(name);
            document[name] = url.substr(0, url.find('?'));
        }
    }
    document["alternatives"] = std::move(all);
    return dump(document);
}

std::uint32_t alternatives_of_request(const std::string& request) {
    const OrderedJson json = OrderedJson::parse(request, nullptr, false);
    return json.is_object() ? json.value("alternatives", std::uint32_t{1}) : 1;
}

std::uint32_t alternatives_of_result(const std::string& result) {
    const OrderedJson json = OrderedJson::parse(result, nullptr, false);
    const auto found = json.is_object() ? json.find("alternatives") : json.end();
    return found == json.end() ? 1 : static_cast<std::uint32_t>(found->size());
}

std::string encode_tally(const SearchTally& tally) {
    OrderedJson numbers = OrderedJson::array();
    for (const std::uint32_t blocks : tally.solved_by) {
        numbers.push_back(blocks);
    }
    numbers.push_back(tally.reverted);
    numbers.push_back(tally.declined);
    numbers.push_back(tally.backtracks);
    return dump(numbers);
}

std::optional<SearchTally> decode_tally(std::string_view text) {
    const OrderedJson numbers = OrderedJson::parse(text, nullptr, false);
    if (!numbers.is_array() || numbers.size() != kSolvedByCount + 3) {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        constexpr std::uint64_t kBlocksMax = 0xFFFFFFFF;
        if (!numbers[i].is_number_unsigned() ||
            (i <= kSolvedByCount + 1 && numbers[i].get<std::uint64_t>() > kBlocksMax)) {
            return std::nullopt;
        }
    }
    SearchTally tally;
    for (std::size_t i = 0; i < kSolvedByCount; ++i) {
        tally.solved_by[i] = numbers[i].get<std::uint32_t>();
    }
    tally.reverted = numbers[kSolvedByCount].get<std::uint32_t>();
    tally.declined = numbers[kSolvedByCount + 1].get<std::uint32_t>();
    tally.backtracks = numbers[kSolvedByCount + 2].get<std::uint64_t>();
    return tally;
}

std::string queued_fields(std::uint64_t position) {
    return dump(OrderedJson{{"position", position}});
}

std::string started_fields(
    std::uint32_t blocks_total, bool resumed, const std::vector<std::string>& warnings
) {
    OrderedJson fields = {{"blocks_total", blocks_total}};
    if (resumed) {
        fields["resumed"] = true;
    }
    if (!warnings.empty()) {
        fields["warnings"] = warnings;
    }
    return dump(fields);
}

// By far the most frequent event, so without a document in between.
std::string block_fields(
    const BlockReport& report, const std::optional<std::uint32_t>& alternative
) {
    const std::uint32_t done = report.index + 1;
    const auto& [min, max] = report.region;
    std::string fields = fmt::format(
        R"({{"index":{},"region":{{"min":[{},{},{}],"max":[{},{},{}]}},"outcome":"{}",)"
        R"("attempts":{},"blocks_done":{},"blocks_total":{},"fraction":{})",
        report.index,
        min.x,
        min.y,
        min.z,
        max.x,
        max.y,
        max.z,
        report.accepted ? "accepted" : "reverted",
        report.attempts,
        done,
        report.blocks_total,
        dump(OrderedJson(fraction(done, report.blocks_total)))
    );
    if (alternative) {
        fmt::format_to(std::back_inserter(fields), R"(,"alternative":{})", *alternative);
    }
    fields += '}';
    return fields;
}

std::string alternative_fields(const CandidateEnd& end) {
    OrderedJson fields = {
        {"alternative", end.alternative}, {"candidate", end.candidate}, {"seed", end.seed}};
    if (!end.result.empty()) {
        fields["result"] = OrderedJson::parse(end.result);
    } else if (end.same) {
        fields["same_as"] = *end.same;
    } else {
        fields["error"] = OrderedJson::parse(end.error);
    }
    return dump(fields);
}

std::optional<CandidateEnd> parse_alternative_fields(std::string_view text) {
    const OrderedJson fields = OrderedJson::parse(text, nullptr, false);
    const auto number = [&fields](const char* name) {
        const auto found = fields.is_object() ? fields.find(name) : fields.end();
        return found != fields.end() && found->is_number_unsigned()
                   ? std::optional(found->get<std::uint64_t>())
                   : std::nullopt;
    };
    const auto embedded = [&fields](const char* name) {
        const auto found = fields.find(name);
        return found != fields.end() && found->is_object() ? dump(*found) : std::string();
    };
    const auto alternative = number("alternative");
    const auto candidate = number("candidate");
    const auto seed = number("seed");
    if (!alternative || !candidate || !seed) {
        return std::nullopt;
    }
    CandidateEnd end;
    end.alternative = static_cast<std::uint32_t>(*alternative);
    end.candidate = static_cast<std::uint32_t>(*candidate);
    end.seed = *seed;
    end.result = embedded("result");
    if (const auto same = number("same_as")) {
        end.same = static_cast<std::uint32_t>(*same);
    }
    end.error = embedded("error");
    const int ways =
        (end.result.empty() ? 0 : 1) + (end.same ? 1 : 0) + (end.error.empty() ? 0 : 1);
    return ways == 1 ? std::optional(std::move(end)) : std::nullopt;
}

std::string succeeded_fields(const std::string& result_json) {
    return "{\"result\":" + result_json + "}";
}

std::string failed_fields(const std::string& problem_json) {
    return "{\"error\":" + problem_json + "}";
}

std::string snapshot_fields(const std::string& job_json) { return "{\"job\":" + job_json + "}"; }

std::string event_json(
    std::uint64_t seq, std::string_view type, UnixMillis time, std::string_view fields
) {
    std::string text = "{\"seq\":" + std::to_string(seq) + ",\"type\":\"";
    text += type;
    text += "\",\"time\":\"" + to_rfc3339(time) + "\"";
    if (fields.size() > 2) {
        text += ',';
        text += fields.substr(1);
        return text;
    }
    return text + "}";
}

std::string labels_json(const Example& example, const Model& model) {
    const GridSize size = model.space->size();
    const OrderedJson head = {
        {"size", OrderedJson::array({size.x, size.y, size.z})}, {"pieces", label_names(example)}};
    std::string text = dump(head);
    text.pop_back();
    text += ",\"cells\":[";
    for (std::size_t i = 0; i < model.labels.size(); ++i) {
        if (i > 0) {
            text += ',';
        }
        text += std::to_string(model.labels[i]);
    }
    return text + "]}";
}

std::string solver_list_json() {
    return list_json({dump(discrete_document()), dump(continuous_document())}, std::nullopt);
}

std::string solver_json(std::string_view name) {
    return name == "discrete"     ? dump(discrete_document())
           : name == "continuous" ? dump(continuous_document())
                                  : "";
}

}  // namespace modelsynth::proto
