#include "proto/analysis_codec.h"
#include "proto/example_codec.h"
#include "proto/job.h"
#include "server/http/handlers.h"
#include "server/http/query_reader.h"
#include "server/http/representation.h"
#include "server/http/request_fields.h"
#include "solver/mesh/glb_writer.h"

#include <utility>

namespace modelsynth::server {

using proto::make_problem;

namespace {

Response no_example(const Call& call) {
    return refuse(call, make_problem("not-found", "there is no example " + call.id.substr(0, 64)));
}

Response example_glb(const Call& call, const Scene& scene, bool named_nodes, const char* suffix) {
    GlbOptions options;
    options.named_nodes = named_nodes;
    auto glb = write_glb(scene, options);
    if (!glb) {
        return refuse(call, proto::problem_of(glb.error()));
    }
    return respond_with(call.request, glb_in_memory(std::move(*glb), call.id + suffix));
}

template <class Answer>
Response with_analysis(const Call& call, Answer answer) {
    const auto entry = call.service.examples().find(call.id, call.request.caller);
    if (!entry) {
        return no_example(call);
    }
    const auto analysis = call.service.analyses().find_or_make(entry->id, entry->example);
    return analysis ? answer(*entry, **analysis) : refuse(call, analysis.error());
}

}  // namespace

Response list_examples(const Call& call) {
    const auto entries = call.service.examples().list(call.request.caller);
    if (!entries) {
        return refuse(call, entries.error());
    }
    std::vector<std::string> items;
    for (const auto& entry : *entries) {
        items.push_back(proto::example_summary(entry.example, entry.id, entry.built_in));
    }
    return respond_with_json(call.request, proto::list_json(items, std::nullopt));
}

Response upload_example(const Call& call) {
    if (const auto room = call.service.check_room(); !room) {
        return refuse(call, room.error());
    }
    const auto form = media_type(call.request) == "model/gltf-binary" ? ExampleLibrary::Form::kGlb
                                                                      : ExampleLibrary::Form::kJson;
    const auto entry = call.service.examples().upload(call.request.body, form, call.request.caller);
    if (!entry) {
        return refuse(call, entry.error());
    }
    Response response =
        json_response(201, proto::example_resource(entry->example, entry->id, entry->built_in));
    response.headers.emplace_back("Location", "/v1/examples/" + entry->id);
    return response;
}

Response get_example(const Call& call) {
    const auto entry = call.service.examples().find(call.id, call.request.caller);
    if (!entry) {
        return no_example(call);
    }
    return respond_with_json(
        call.request, proto::example_resource(entry->example, entry->id, entry->built_in)
    );
}

Response delete_example(const Call& call) {
    const auto erased = call.service.examples().erase(call.id, call.request.caller);
    if (!erased) {
        return refuse(call, erased.error());
    }
    return {204, {}, std::string()};
}

Response get_example_model(const Call& call) {
    const auto entry = call.service.examples().find(call.id, call.request.caller);
    if (!entry) {
        return no_example(call);
    }
    return example_glb(call, example_scene(entry->example), false, ".glb");
}

Response get_example_pieces(const Call& call) {
    const auto entry = call.service.examples().find(call.id, call.request.caller);
    if (!entry) {
        return no_example(call);
    }
    const auto pieces = pieces_scene(entry->example);
    if (!pieces) {
        return refuse(call, make_problem("not-found", "an example made of solids has no pieces"));
    }
    return example_glb(call, *pieces, true, ".pieces.glb");
}

Response get_example_analysis(const Call& call) {
    return with_analysis(call, [&call](const auto& entry, const Analysis& analysis) {
        return respond_with_json(
            call.request, proto::analysis_json(entry.example, entry.id, analysis)
        );
    });
}

Response get_example_success(const Call& call) {
    return with_analysis(call, [&call](const auto& entry, const Analysis& analysis) -> Response {
        auto drawing = proto::success_drawing(entry.example, analysis);
        if (!drawing) {
            return refuse(
                call, make_problem("not-found", "how often such examples succeed is not measured")
            );
        }
        return respond_with(call.request, in_memory("image/svg+xml", std::move(*drawing)));
    });
}

Response get_example_figures(const Call& call) {
    const auto entry = call.service.examples().find(call.id, call.request.caller);
    if (!entry) {
        return no_example(call);
    }
    const auto count = proto::figure_count(entry->example);
    if (!count) {
        return refuse(call, make_problem("not-found", "an example on a grid has no figures"));
    }
    QueryReader query(call.request);
    const auto number = query.number("figure", 0, *count - 1);
    if (auto problem = query.finish()) {
        return refuse(call, *problem);
    }
    if (number) {
        return respond_with(
            call.request, in_memory("image/svg+xml", proto::figure_drawing(entry->example, *number))
        );
    }
    const auto sheet = call.service.analyses().find_or_draw_figures(entry->id, entry->example);
    if (!sheet) {
        return refuse(call, sheet.error());
    }
    return respond_with(call.request, in_memory("image/svg+xml", **sheet));
}

}  // namespace modelsynth::server
