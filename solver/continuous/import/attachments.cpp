#include "solver/continuous/import/attachments.h"

#include "solver/continuous/import/import_objects.h"
#include "solver/continuous/import/node_meshes.h"
#include "solver/continuous/import/node_places.h"
#include "solver/continuous/import/object_fields.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

namespace modelsynth::continuous {

namespace {

// As JSON examples have them.
constexpr std::array<std::string_view, 2> kShapeFields = {"smooth", "even"};
constexpr std::array<std::string_view, 2> kEdgeFields = {"edges", "turn"};
constexpr std::array<std::string_view, 3> kCornerFields = {"corners", "turn", "turned"};
constexpr std::array<std::string_view, 1> kMeshFields = {"smooth"};

std::string text_of(const Extra& extras, std::string_view name) {
    const Extra* extra = extras.find(name);
    const auto* text = extra == nullptr ? nullptr : std::get_if<std::string>(&extra->value);
    return text == nullptr ? std::string() : *text;
}

std::string pointer_to(ObjectId object) { return "/objects/" + std::to_string(object - 1); }

}  // namespace

std::string shaped_object(const GlbNode& node) {
    std::string name = text_of(node.extras, "shape");
    return name.starts_with('{') ? std::string() : name;
}

std::string decorated_object(const GlbNode& node) { return text_of(node.extras, "decorates"); }

void Attachments::give_to(ImportedExample& made) const {
    for (const Attachment& shape : shapes_) {
        give_shape(shape.node, made);
    }
    for (const Attachment& decoration : decorations_) {
        give_decoration(decoration, made);
    }
}

ObjectId Attachments::object_named(
    const std::string& name, std::size_t node, const char* property, const Example& example
) const {
    const ObjectId object = find_object(example, name);
    if (object == kEmpty) {
        Source place = extras_of(*scene_, node);
        place.in_file += std::string("/") + property;
        refuse_(place, ": no other node is of object " + quoted(name));
    }
    return object;
}

void Attachments::say(
    std::size_t node,
    std::span<const std::string_view> fields,
    const std::string& of,
    ImportedExample& made
) const {
    const SharedExtra extras(scene_, &scene_->nodes[node].extras);
    for (SaidField& field : said_fields(extras, fields, extras_of(*scene_, node, of))) {
        made.said.push_back(std::move(field));
    }
}

void Attachments::give_shape(std::size_t node, ImportedExample& made) const {
    const std::string name = shaped_object(scene_->nodes[node]);
    const ObjectId object = object_named(name, node, "shape", made.example);
    if (object == kEmpty) {
        return;
    }
    ObjectType& type = made.example.objects[object - 1U];
    const std::string in_example = pointer_to(object) + "/shape";
    const Source place = source_of(*scene_, node, in_example);
    if (type.shape != nullptr) {
        refuse_(place, " is another shape of object " + quoted(name));
        return;
    }
    auto shape = shape_of_mesh(places_of(*scene_, node));
    if (!shape) {
        refuse_(place, shape.error());
        return;
    }
    type.shape = std::make_shared<const Shape>(std::move(*shape));
    made.sources.push_back(place);
    say(node, kShapeFields, in_example, made);
}

void Attachments::give_decoration(const Attachment& attachment, ImportedExample& made) const {
    const std::size_t node = attachment.node;
    const std::string name = decorated_object(scene_->nodes[node]);
    const ObjectId object = object_named(name, node, "decorates", made.example);
    if (object == kEmpty) {
        return;
    }
    std::vector<Decoration>& decorations = made.example.objects[object - 1U].decorations;
    const std::string in_example =
        pointer_to(object) + "/decorations/" + std::to_string(decorations.size());
    const Source place = source_of(*scene_, node, in_example);
    const Extra& extras = scene_->nodes[node].extras;
    const bool is_edge = extras.find("edges") != nullptr;
    if (is_edge == (extras.find("corners") != nullptr)) {
        refuse_(place, " decorates " + quoted(name) + ", and must have \"edges\" or \"corners\"");
        return;
    }
    std::vector<Point> places = places_of(*scene_, node);
    const auto& origin = scene_->nodes[node].frame[3];
    for (Point& corner : places) {
        corner -= Point(origin[0], origin[1], origin[2]);
    }
    if (is_edge) {
        auto profile = profile_of_mesh(std::move(places));
        if (!profile) {
            refuse_(place, profile.error());
            return;
        }
        decorations.emplace_back(EdgeDecoration{
            {}, Turn::kConvex, std::move(*profile), attachment.look});
        say(node, kEdgeFields, in_example, made);
    } else {
        auto mesh = shape_of_mesh(std::move(places));
        if (!mesh) {
            refuse_(place, mesh.error());
            return;
        }
        decorations.emplace_back(CornerDecoration{
            {},
            Turn::kConvex,
            std::make_shared<const Shape>(std::move(*mesh)),
            false,
            attachment.look});
        say(node, kCornerFields, in_example, made);
        say(node, kMeshFields, in_example + "/mesh", made);
    }
    made.sources.push_back(place);
}

}  // namespace modelsynth::continuous
