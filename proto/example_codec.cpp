#include "proto/example_codec.h"

#include "proto/base64.h"
#include "proto/continuous_codec.h"
#include "proto/discrete_codec.h"
#include "proto/json.h"
#include "solver/discrete/default_kit.h"
#include "solver/mesh/glb_reader.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace modelsynth::proto {

namespace {

using continuous::ExampleReading;
using discrete::Piece;

using LabelOfName = std::unordered_map<std::string, Label>;

std::optional<Kit> read_meshes(const Value& value, const RequestLimits& limits) {
    const auto text = value.string(limits.json.string_bytes_max);
    if (!text) {
        return std::nullopt;
    }
    static constexpr std::array<std::string_view, 2> kPrefixes = {
        "data:model/gltf-binary;base64,", "data:application/octet-stream;base64,"};
    for (const std::string_view prefix : kPrefixes) {
        if (!text->starts_with(prefix)) {
            continue;
        }
        const auto bytes = decode_base64(std::string_view(*text).substr(prefix.size()));
        if (!bytes) {
            value.fault("the data: URI is not base64");
            return std::nullopt;
        }
        GlbReadLimits glb_limits;
        glb_limits.bytes_max = limits.glb_bytes_max;
        auto kit = read_glb(*bytes, glb_limits);
        if (!kit) {
            value.fault(kit.error().message);
            return std::nullopt;
        }
        return std::move(*kit);
    }
    value.fault("must be a data: URI of type model/gltf-binary in base64");
    return std::nullopt;
}

std::optional<std::uint32_t> find_mesh(const Kit& kit, const std::string& name) {
    for (std::size_t i = 0; i < kit.meshes.size(); ++i) {
        if (kit.meshes[i].name == name) {
            return static_cast<std::uint32_t>(i);
        }
    }
    return std::nullopt;
}

Piece read_piece(
    const Value& value, const RequestLimits& limits, const Kit& kit, LabelOfName& labels
) {
    Piece piece;
    ObjectReader reader(value);
    if (const auto name = reader.required("name")) {
        piece.name = name->string(limits.name_characters_max).value_or("");
        if (name->json().is_string() && piece.name.empty()) {
            name->fault("must not be empty");
        } else if (!piece.name.empty() &&
                   !labels.emplace(piece.name, static_cast<Label>(labels.size())).second) {
            name->fault("another piece has this name");
        }
    }
    if (const auto mesh = reader.optional("mesh")) {
        if (const auto name = mesh->string(limits.name_characters_max)) {
            piece.mesh = find_mesh(kit, *name);
            if (!piece.mesh) {
                mesh->fault("the meshes have no node with this name");
            }
        }
    }
    if (const auto turns = reader.optional("turns")) {
        piece.quarter_turns = static_cast<std::uint8_t>(turns->integer(0, 3).value_or(0));
    }
    if (const auto weight = reader.optional("weight")) {
        piece.weight = weight->number(0, 1e6).value_or(1);
    }
    reader.finish();
    return piece;
}

void read_cells(const Value& value, const RequestLimits& limits, discrete::Example& example) {
    const auto values = value.array(1, limits.example_cells_max);
    if (!values) {
        return;
    }
    if (example.size.cell_count() > 0 && values->size() != example.size.cell_count()) {
        value.fault(
            "has " + std::to_string(values->size()) + " cells where the size asks for " +
            std::to_string(example.size.cell_count())
        );
        return;
    }
    for (const Value& cell : *values) {
        const auto label = cell.integer(
            0, static_cast<std::int64_t>(std::max<std::size_t>(1, example.pieces.size())) - 1
        );
        example.cells.push_back(static_cast<Label>(label.value_or(0)));
    }
}

// {"x": [["lower", "upper"], ...], "y": ..., "z": ...}
void read_adjacency(
    const Value& value,
    const RequestLimits& limits,
    const LabelOfName& labels,
    discrete::Example& example
) {
    static constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
    ObjectReader reader(value);
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
        const auto listed = reader.optional(kAxes[axis]);
        const auto pairs = listed ? listed->array(0, 1'000'000) : std::nullopt;
        for (std::size_t i = 0; pairs && i < pairs->size(); ++i) {
            const auto names = (*pairs)[i].strings(2, 2, limits.name_characters_max);
            if (!names) {
                continue;
            }
            const auto lower = labels.find((*names)[0]);
            const auto upper = labels.find((*names)[1]);
            if (lower == labels.end() || upper == labels.end()) {
                (*pairs)[i].fault("names a piece that the example does not have");
                continue;
            }
            example.adjacency.push_back({axis, lower->second, upper->second});
        }
    }
    reader.finish();
}

void read_boundary(
    const Value& value,
    const RequestLimits& limits,
    const LabelOfName& labels,
    bool has_cells,
    discrete::Example& example
) {
    ObjectReader reader(value);
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const auto given = reader.optional(discrete::kSideNames[side]);
        const auto boundary = given ? read_side(*given, limits) : std::nullopt;
        if (!boundary) {
            continue;
        }
        for (std::size_t i = 0; i < boundary->pieces.size(); ++i) {
            if (!labels.contains(boundary->pieces[i])) {
                value.faults().add(
                    given->pointer() + (given->json().is_array() ? "/" + std::to_string(i) : ""),
                    "the example has no piece \"" + boundary->pieces[i] + "\""
                );
            }
        }
        if (boundary->kind == discrete::BoundaryKind::kExample && !has_cells) {
            given->fault("there are no cells to take the boundary from");
        }
        example.boundary[side] = *boundary;
    }
    reader.finish();
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        const auto is_periodic = [&example](std::size_t at) {
            return example.boundary[at].kind == discrete::BoundaryKind::kPeriodic;
        };
        if (is_periodic(side) && !is_periodic(side ^ 1U)) {
            value.faults().add(
                value.pointer() + "/" + discrete::kSideNames[side],
                std::string("periodic needs the opposite side, ") +
                    discrete::kSideNames[side ^ 1U] + ", to be periodic too"
            );
        }
    }
}

void set_default_boundary(discrete::Example& example) {
    auto& bottom = example.boundary[static_cast<std::size_t>(Direction::kDown)];
    auto& top = example.boundary[static_cast<std::size_t>(Direction::kUp)];
    if (!example.cells.empty()) {
        bottom.kind = discrete::BoundaryKind::kExample;
    }
    if (example.empty) {
        top = {discrete::BoundaryKind::kPieces, {example.pieces[*example.empty].name}};
    }
}

// What a list shows of an example.
OrderedJson summary(const discrete::Example& example, const std::string& id, bool built_in) {
    const auto triple = [](const GridSize& size) {
        return OrderedJson::array({size.x, size.y, size.z});
    };
    const std::string self = "/v1/examples/" + id;
    return {
        {"id", id},
        {"kind", "discrete"},
        {"name", example.name},
        {"built_in", built_in},
        {"labels", example.pieces.size()},
        {"cell", example.cell},
        {"size", triple(example.size)},
        {"default_size", triple(example.default_size)},
        {"urls",
         {{"self", self}, {"model", self + "/model.glb"}, {"pieces", self + "/pieces.glb"}}}};
}

// As high as the example; of rules alone, one cell along an axis that nothing is neighbours along.
void set_default_size(discrete::Example& example) {
    GridSize& size = example.default_size;
    if (example.size.cell_count() > 0) {
        size.y = example.size.y;
        return;
    }
    const auto has_neighbours = [&example](std::uint8_t axis) {
        return std::any_of(
            example.adjacency.begin(),
            example.adjacency.end(),
            [axis](const discrete::AdjacentPair& pair) { return pair.axis == axis; }
        );
    };
    size = {
        has_neighbours(0) ? size.x : 1,
        has_neighbours(1) ? size.y : 1,
        has_neighbours(2) ? size.z : 1};
}

}  // namespace

std::optional<discrete::Example> read_example(const Value& value, const RequestLimits& limits) {
    discrete::Example example;
    LabelOfName labels;
    ObjectReader reader(value);
    static_cast<void>(reader.required("kind"));
    if (const auto name = reader.required("name")) {
        example.name = name->string(limits.name_characters_max).value_or("");
    }
    if (const auto cell = reader.optional("cell")) {
        const auto values = cell->array(3, 3);
        for (std::size_t axis = 0; values && axis < 3; ++axis) {
            example.cell[axis] = (*values)[axis].number_above(0, 1e4).value_or(1);
        }
    }
    Kit kit;
    if (const auto meshes = reader.optional("meshes")) {
        kit = read_meshes(*meshes, limits).value_or(Kit());
    }
    if (const auto pieces = reader.required("pieces")) {
        if (const auto values = pieces->array(1, limits.pieces_max)) {
            for (const Value& piece : *values) {
                example.pieces.push_back(read_piece(piece, limits, kit, labels));
            }
        }
    }
    const auto adjacency = reader.optional("adjacency");
    const auto size = adjacency ? reader.optional("size") : reader.required("size");
    const auto cells = adjacency ? reader.optional("cells") : reader.required("cells");
    if (adjacency && size.has_value() != cells.has_value()) {
        value.fault("size and cells go together");
    }
    if (size) {
        if (const auto extent = size->cell(1, limits.extent_max)) {
            example.size = {extent->x, extent->y, extent->z};
        }
    }
    if (cells) {
        read_cells(*cells, limits, example);
    }
    if (adjacency) {
        read_adjacency(*adjacency, limits, labels, example);
    }
    if (const auto empty = reader.optional("empty")) {
        const auto name = empty->string(limits.name_characters_max);
        if (name && !labels.contains(*name)) {
            empty->fault("the example has no such piece");
        } else if (name) {
            example.empty = labels.at(*name);
        }
    }
    set_default_boundary(example);
    if (const auto boundary = reader.optional("boundary")) {
        read_boundary(*boundary, limits, labels, cells.has_value(), example);
    }
    reader.finish();
    if (!value.faults().empty()) {
        return std::nullopt;
    }
    set_default_size(example);
    example.kit = std::make_shared<const Kit>(std::move(kit));
    discrete::add_missing_meshes(example);
    return example;
}

std::optional<Example> read_any_example(const Value& value, const RequestLimits& limits) {
    const Json& json = value.json();
    const bool has_kind = json.is_object() && json.contains("kind");
    if (has_kind) {
        const Value kind(json.at("kind"), value.pointer() + "/kind", value.faults());
        const auto number = kind.one_of({"discrete", "continuous"});
        if (!number) {
            return std::nullopt;
        }
        if (*number == 1) {
            auto solids = read_solids(value, limits);
            return solids ? std::optional<Example>(std::move(solids)) : std::nullopt;
        }
    }
    auto grid = read_example(value, limits);
    return grid
               ? std::optional<Example>(std::make_shared<const discrete::Example>(std::move(*grid)))
               : std::nullopt;
}

Parsed<ExampleUpload> parse_example(std::string_view text, const RequestLimits& limits) {
    auto json = parse_json(text, limits.json);
    if (!json) {
        return tl::unexpected(std::move(json.error()));
    }
    Faults faults;
    auto example = read_any_example(Value(*json, "", faults), limits);
    if (!example) {
        Problem problem = make_problem("invalid-request", "the example cannot be used");
        problem.errors = faults.take();
        return tl::unexpected(std::move(problem));
    }
    return ExampleUpload{std::move(*example), dump(*json)};
}

std::string example_summary(const Example& any, const std::string& id, bool built_in) {
    if (const auto* solids = std::get_if<std::shared_ptr<const ExampleReading>>(&any)) {
        return dump(solids_summary(**solids, id, built_in));
    }
    return dump(summary(*std::get<std::shared_ptr<const discrete::Example>>(any), id, built_in));
}

std::string example_resource(const Example& any, const std::string& id, bool built_in) {
    if (const auto* solids = std::get_if<std::shared_ptr<const ExampleReading>>(&any)) {
        return dump(solids_resource(**solids, id, built_in));
    }
    const auto& example = *std::get<std::shared_ptr<const discrete::Example>>(any);
    OrderedJson pieces = OrderedJson::array();
    for (const Piece& piece : example.pieces) {
        OrderedJson written = {{"name", piece.name}};
        if (piece.mesh) {
            written["mesh"] = example.kit->meshes[*piece.mesh].name;
        }
        if (piece.quarter_turns != 0) {
            written["turns"] = piece.quarter_turns;
        }
        written["weight"] = piece.weight;
        pieces.push_back(std::move(written));
    }
    OrderedJson boundary = OrderedJson::object();
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
        boundary[discrete::kSideNames[side]] = write_side(example.boundary[side]);
    }
    OrderedJson resource = summary(example, id, built_in);
    resource["pieces"] = std::move(pieces);
    resource["empty"] = nullptr;
    if (example.empty) {
        resource["empty"] = example.pieces[*example.empty].name;
    }
    resource["boundary"] = std::move(boundary);
    resource["cells"] = example.cells;
    return dump(resource);
}

}  // namespace modelsynth::proto
