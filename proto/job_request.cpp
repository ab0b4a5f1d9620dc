#include "proto/job_request.h"

#include "proto/continuous_codec.h"
#include "proto/discrete_codec.h"
#include "proto/json.h"
#include "proto/origin_codec.h"

#include <algorithm>
#include <array>
#include <utility>

namespace modelsynth::proto {

namespace {

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
        if (count_characters(name) > limits.name_characters_max) {
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
void check_against_limits(
    const Example& example,
    const Parameters& parameters,
    std::uint32_t models,
    const RequestLimits& limits,
    Faults& faults
) {
    faults.add_all("/parameters", find_faults(example, parameters));
    const GridSize size = model_size(parameters);
    const std::size_t cells = size.cell_count();
    if (cells > limits.model_cells_max) {
        faults.add(
            "/parameters/size",
            "the default size passes the limit model_cells_max, " +
                std::to_string(limits.model_cells_max),
            true
        );
        return;
    }
    if (models * cells > limits.model_cells_max) {
        faults.add(
            "/alternatives",
            "so many models of " + std::to_string(cells) +
                " cells pass the limit model_cells_max, " + std::to_string(limits.model_cells_max),
            true
        );
    }
    const auto layout = block_layout(parameters);
    if (!layout) {
        return;
    }
    const auto schedule = schedule_blocks(size, *layout, limits.blocks_max);
    if (!schedule) {
        faults.add(
            "/parameters/blocks",
            "the schedule would have more blocks than the limit blocks_max, " +
                std::to_string(limits.blocks_max),
            true
        );
    } else if (models * schedule->size() > limits.blocks_max) {
        faults.add(
            "/alternatives",
            "so many models of " + std::to_string(schedule->size()) +
                " blocks pass the limit blocks_max, " + std::to_string(limits.blocks_max),
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

constexpr std::array<const char*, 2> kSolvers = {"discrete", "continuous"};

// One request on its way in: the fields in their order, then what they mean together.
class RequestReader {
  public:
    RequestReader(
        const Json& json,
        const RequestLimits& limits,
        const FindExample& find_example,
        const FindOrigin& find_origin,
        const CheckWebhook& check_webhook
    )
        : limits_(limits),
          find_example_(find_example),
          find_origin_(find_origin),
          check_webhook_(check_webhook),
          fields_(Value(json, "", faults_)) {}

    Parsed<JobRequest> read(std::uint64_t seed_if_absent) {
        read_from();
        read_solver();
        read_places();
        read_example();
        read_seed(seed_if_absent);
        read_parameters();
        read_the_rest();
        fields_.finish();
        check_complete();
        if (!faults_.empty()) {
            // Once these are mended the job may have come to its end.
            faults_.add_all("", origin_problem_ ? origin_problem_->errors : std::vector<Fault>());
            return tl::unexpected(refusal(faults_.take()));
        }
        if (origin_problem_) {
            return tl::unexpected(std::move(*origin_problem_));
        }
        request_.echo = write_echo();
        if (earlier_ && !parse_json(request_.echo, limits_.json)) {
            return tl::unexpected(refusal(
                {{"/from",
                  "that job's request and this one are more than one request may hold",
                  true}}
            ));
        }
        return std::move(request_);
    }

  private:
    void read_solver() {
        request_.solver = kSolvers[0];
        const auto solver = required_or_inherited("solver");
        const auto number = solver ? solver->one_of(kSolvers) : std::nullopt;
        if (number) {
            request_.solver = kSolvers[*number];
        }
        if (earlier_ && !number) {
            request_.solver = earlier_->solver;  // also where another one is meant that is none
        } else if (earlier_ && request_.solver != earlier_->solver) {
            solver->fault("is not that of the job to start from");
            earlier_.reset();
        }
    }

    void read_from() {
        const auto from = fields_.optional("from");
        if (!from) {
            return;
        }
        origin_.emplace(*from, limits_);
        request_.from = origin_->read_job();
        if (!find_origin_ || request_.from->job_id.empty()) {
            return;
        }
        auto earlier = find_origin_(request_.from->job_id, request_.from->alternative);
        if (earlier) {
            earlier_ = std::move(*earlier);
        } else if (earlier.error().status == 404 && request_.from->alternative > 0) {
            faults_.add(
                "/from/alternative",
                "there is no job \"" + request_.from->job_id + "\" with such an alternative"
            );
        } else if (earlier.error().status == 404) {
            faults_.add("/from/job", "there is no job \"" + request_.from->job_id + "\"");
        } else {
            origin_problem_ = std::move(earlier.error());
            origin_problem_->errors = {{"/from/job", origin_problem_->detail}};
        }
    }

    void read_places() {
        if (!origin_) {
            return;
        }
        origin_->read_places(request_.solver, !find_origin_, *request_.from);
        if (earlier_ && !take_size(earlier_->task.parameters, request_.from->origin)) {
            faults_.add("/from/size", "is not the size of that job's model");
        }
    }

    // Whether an earlier job tells what is not given.
    [[nodiscard]] bool inherits() const { return request_.from && find_origin_; }

    std::optional<Value> required_or_inherited(const char* name) {
        return inherits() ? fields_.optional(name) : fields_.required(name);
    }

    void read_example() {
        const auto given = required_or_inherited("example");
        if (!given) {
            if (earlier_) {
                example_ = earlier_->task.example;
                request_.example_id = earlier_->example_id;
                written_example_ = OrderedJson::parse(earlier_->echo).at("example");
            }
            return;
        }
        Faults faults;
        const Value value(given->json(), given->pointer(), faults);
        if (value.json().is_object()) {
            read_inline_example(value);
        } else if (value.json().is_string()) {
            find_named_example(value);
        } else {
            value.fault("must be the id of an example or an example object");
        }
        if (example_ && earlier_ && !has_labels_of(*earlier_)) {
            value.fault(
                solver_has_cells(earlier_->solver)
                    ? "must have the pieces of that job's example, in the same order"
                    : "must be that job's example"
            );
            example_ = earlier_->task.example;  // what else is wrong is told by the right one
        }
        if (example_ && solver_of(*example_) != request_.solver) {
            value.fault(
                "is an example for the solver \"" + std::string(solver_of(*example_)) + "\""
            );
            example_.reset();
        }
        faults_.add_all("", faults.take());
    }

    // Whether the example's labels mean what those of the earlier job mean. Those of solids have no
    // names: it has to be the same example.
    [[nodiscard]] bool has_labels_of(const JobRequest& earlier) const {
        return solver_has_cells(earlier.solver)
                   ? label_names(*example_) == label_names(earlier.task.example)
                   : written_example_ == OrderedJson::parse(earlier.echo).at("example");
    }

    void read_inline_example(const Value& value) {
        if (auto example = read_any_example(value, limits_)) {
            example_ = std::move(*example);
            written_example_ = OrderedJson::parse(dump(value.json()));
        }
    }

    void find_named_example(const Value& value) {
        const std::string id = value.string(limits_.name_characters_max).value_or("");
        // The earlier job's own is known even when it was deleted since.
        const bool is_known = earlier_ && !id.empty() && id == earlier_->example_id;
        example_ = is_known ? earlier_->task.example : find_example_(id);
        if (!example_) {
            value.fault("there is no example \"" + id.substr(0, 64) + "\"");
        }
        request_.example_id = id;
        written_example_ = id;
    }

    void read_seed(std::uint64_t seed_if_absent) {
        request_.task.seed = seed_if_absent;
        if (const auto seed = fields_.optional("seed")) {
            request_.task.seed = static_cast<std::uint64_t>(
                seed->integer(0, static_cast<std::int64_t>(kSeedMax)).value_or(0)
            );
        }
    }

    void read_parameters() {
        if (request_.solver == kSolvers[1]) {
            read_solid_parameters();
            return;
        }
        if (earlier_) {
            parameters_ = std::get<discrete::Parameters>(earlier_->task.parameters);
        }
        const auto given = fields_.optional("parameters");
        if (!given) {
            return;
        }
        const auto gives = [&given](const char* name) {
            return given->json().is_object() && given->json().contains(name);
        };
        if (gives("size")) {
            parameters_.size.reset();
        }
        parameters_ = proto::read_parameters(*given, limits_, std::move(parameters_));
        size_is_usable_ = !gives("size") || (parameters_.size && parameters_.size->cell_count() <=
                                                                     limits_.model_cells_max);
        const auto* origin =
            earlier_ ? &std::get<discrete::Origin>(request_.from->origin) : nullptr;
        if (origin != nullptr && size_is_usable_ && *parameters_.size != origin->size) {
            fit_to_other_size(*origin, gives("blocks"), gives("constraints"));
        }
    }

    void read_solid_parameters() {
        solids_.emplace();
        if (earlier_) {
            solids_ = std::get<continuous::Parameters>(earlier_->task.parameters);
        }
        const auto given = fields_.optional("parameters");
        if (!given) {
            return;
        }
        solids_ = read_continuous_parameters(*given, limits_, std::move(*solids_));
        const auto gives = [&given](const char* name) {
            return given->json().is_object() && given->json().contains(name);
        };
        const auto* origin =
            earlier_ ? &std::get<continuous::Origin>(request_.from->origin) : nullptr;
        if (origin == nullptr || !solids_->size || *solids_->size == origin->size) {
            return;
        }
        continuous::Parameters before = *solids_;
        before.size = origin->size;
        before.blocks.reset();
        const auto usual =
            std::get<continuous::Parameters>(with_defaults(before, earlier_->task.example)).blocks;
        if (!gives("blocks") && solids_->blocks == usual) {
            solids_->blocks.reset();
        }
        if (!gives("constraints") && solids_->constraints) {
            take_moved(*origin, *solids_->constraints);
        }
    }

    // Constraints of the earlier job, for a model of another size.
    template <class OfSolver, class Constraint>
    void take_moved(const OfSolver& origin, std::vector<Constraint>& constraints) {
        auto moved = moved_constraints(std::move(constraints), origin);
        if (moved) {
            constraints = std::move(*moved);
        } else {
            constraints.clear();
            faults_.add(
                "/parameters/constraints",
                "must be given, since constraint " + std::to_string(moved.error()) +
                    " of that job was for a model of its size: it holds in a mask or voxels, or "
                    "about the middle"
            );
        }
    }

    // What the earlier job was asked for was meant for a model of its size.
    void fit_to_other_size(
        const discrete::Origin& origin, bool gives_blocks, bool gives_constraints
    ) {
        discrete::Parameters before;
        before.size = origin.size;
        const auto usual =
            std::get<discrete::Parameters>(with_defaults(before, earlier_->task.example)).blocks;
        if (!gives_blocks && parameters_.blocks == usual) {
            parameters_.blocks.reset();
        }
        if (gives_constraints) {
            return;
        }
        if (!lies_within(origin, *parameters_.size)) {
            parameters_.constraints.clear();  // no places in such a model; a fault will tell
            return;
        }
        take_moved(origin, parameters_.constraints);
    }

    void read_the_rest() {
        if (const auto alternatives = fields_.optional("alternatives")) {
            request_.alternatives = static_cast<std::uint32_t>(
                alternatives->integer(1, limits_.alternatives_max).value_or(1)
            );
        }
        if (const auto priority = fields_.optional("priority")) {
            request_.priority = static_cast<std::int32_t>(priority->integer(-10, 10).value_or(0));
        }
        if (const auto deadline = fields_.optional("deadline")) {
            request_.deadline_seconds = deadline->number_above(0, limits_.deadline_seconds_max);
        }
        if (const auto tags = fields_.optional("tags")) {
            tags_ = read_tags(*tags, limits_);
        }
        if (const auto webhook = fields_.optional("webhook")) {
            read_webhook(*webhook);
        }
    }

    void read_webhook(const Value& value) {
        if (find_origin_ && !check_webhook_) {
            value.fault("this server sends no webhooks (--webhook-secret-file)");
            return;
        }
        ObjectReader fields(value);
        const auto field = fields.required("url");
        fields.finish();
        const auto url = field ? field->string(limits_.webhook_url_characters_max)
                               : std::optional<std::string>();
        if (!url) {
            return;
        }
        if (check_webhook_) {
            if (auto wrong = check_webhook_(*url)) {
                field->fault(std::move(*wrong));
            }
        }
        request_.webhook = *url;
    }

    void check_complete() {
        if (!example_ || (inherits() && !earlier_)) {
            return;
        }
        if (!size_is_usable_) {
            check_names();
            return;
        }
        const Parameters given = solids_ ? Parameters(*solids_) : Parameters(parameters_);
        auto example = example_for(*example_, given);
        if (!example) {
            const bool is_turned = solids_ && solids_->variants != continuous::Variants();
            faults_.add_all("/parameters", example.error().faults);
            if (example.error().faults.empty()) {
                faults_.add(
                    is_turned ? "/parameters/variants" : "/parameters/constraints",
                    example.error().message,
                    true
                );
            }
            return;
        }
        if (earlier_ && !are_read_alike(*example, earlier_->task.example)) {
            faults_.add(
                "/parameters",
                "variants, what has a dimension and so becomes other objects in them, bounding "
                "volumes, symmetries of shapes, and by how much faces are nudged must be those of "
                "that job"
            );
            return;
        }
        request_.task.example = std::move(*example);
        request_.task.parameters = with_defaults(given, request_.task.example);
        check_against_limits(
            request_.task.example,
            request_.task.parameters,
            request_.alternatives.value_or(1),
            limits_,
            faults_
        );
        // The planes of solids can be told once nothing is wrong with them.
        if (request_.from && (!solids_ || faults_.empty())) {
            faults_.add_all(
                "",
                find_origin_faults(
                    request_.task,
                    request_.from->origin,
                    earlier_ ? &earlier_->task.parameters : nullptr
                )
            );
        }
    }

    // Without a usable size nothing can be said about places in the model; names mean the same in
    // one of any size.
    void check_names() {
        parameters_.size.reset();
        for (Fault& fault :
             find_faults(*example_, with_defaults(Parameters(parameters_), *example_))) {
            const auto has = [&fault](std::string_view part) {
                return fault.pointer.find(part) != std::string::npos;
            };
            if (has("/boundary/") || has("/weights/") || has("/pieces/") || has("/mirror/")) {
                faults_.add(
                    "/parameters" + fault.pointer, std::move(fault.detail), fault.over_limit
                );
            }
        }
    }

    [[nodiscard]] std::string write_echo() {
        OrderedJson echo = {
            {"solver", request_.solver},
            {"example", std::move(written_example_)},
            {"seed", request_.task.seed}};
        if (request_.from) {
            echo["from"] = write_origin(*request_.from);
        }
        echo["parameters"] = std::visit(
            [](const auto& parameters) { return write_parameters(parameters); },
            request_.task.parameters
        );
        if (request_.alternatives) {
            echo["alternatives"] = *request_.alternatives;
        }
        echo["priority"] = request_.priority;
        if (request_.deadline_seconds) {
            echo["deadline"] = *request_.deadline_seconds;
        }
        echo["tags"] = std::move(tags_);
        if (!request_.webhook.empty()) {
            echo["webhook"] = {{"url", request_.webhook}};
        }
        return dump(echo);
    }

    const RequestLimits& limits_;
    const FindExample& find_example_;
    const FindOrigin& find_origin_;
    const CheckWebhook& check_webhook_;
    Faults faults_;
    ObjectReader fields_;
    JobRequest request_;
    std::optional<OriginReader> origin_;
    std::optional<JobRequest> earlier_;      // the one that this one starts from
    std::optional<Problem> origin_problem_;  // why there is none, besides the request's faults
    std::optional<Example> example_;
    OrderedJson written_example_;  // as the echo tells it
    discrete::Parameters parameters_;
    std::optional<continuous::Parameters> solids_;  // when the solver is the continuous one
    bool size_is_usable_ = true;
    OrderedJson tags_ = OrderedJson::object();
};

}  // namespace

Parsed<JobRequest> parse_job_request(
    std::string_view body,
    const RequestLimits& limits,
    const FindExample& find_example,
    const FindOrigin& find_origin,
    std::uint64_t seed_if_absent,
    const CheckWebhook& check_webhook
) {
    auto json = parse_json(body, limits.json);
    if (!json) {
        return tl::unexpected(std::move(json.error()));
    }
    return RequestReader(*json, limits, find_example, find_origin, check_webhook)
        .read(seed_if_absent);
}

Parsed<std::string> canonical_json(std::string_view body, const JsonLimits& limits) {
    auto json = parse_json(body, limits);
    if (!json) {
        return tl::unexpected(std::move(json.error()));
    }
    return dump(*json);
}

}  // namespace modelsynth::proto
