// Examples of the continuous solver.

#include "proto/continuous_codec.h"
#include "proto/decoration_codec.h"
#include "proto/example_codec.h"
#include "proto/image_codec.h"
#include "proto/shape_codec.h"
#include "proto/solid_constraint_codec.h"
#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/faults.h"
#include "solver/continuous/import/default_spacing.h"
#include "solver/continuous/shapes/cut_boxes.h"

#include <algorithm>
#include <utility>

namespace modelsynth::proto {

namespace {

using continuous::Bounds;
using continuous::ExampleReading;
using continuous::Face;
using continuous::ObjectId;
using continuous::ObjectType;
using continuous::Point;
using continuous::Polyhedron;

constexpr std::size_t kPolyhedraMax = 4096;
constexpr std::size_t kCornersMax = 65536;  // of one solid
constexpr std::size_t kFacesMax = 20000;    // of one solid
constexpr std::size_t kFaceCornersMax = 256;

std::optional<Color> read_color(const Value& value) {
    const auto parts = value.array(3, 3);
    if (!parts) {
        return std::nullopt;
    }
    const auto part = [&parts](std::size_t i) {
        return static_cast<float>((*parts)[i].number(0, 1).value_or(1));
    };
    return Color{part(0), part(1), part(2)};
}

class SolidsReader {
  public:
    SolidsReader(const Value& value, const RequestLimits& limits)
        : value_(value), limits_(limits), reader_(value) {}

    std::optional<continuous::Example> read() {
        static_cast<void>(reader_.required("kind"));
        if (const auto name = reader_.required("name")) {
            example_.name = text(*name);
        }
        if (const auto title = reader_.optional("title")) {
            example_.title = text(*title);
        }
        if (const auto description = reader_.optional("description")) {
            example_.description = description->string(1024).value_or("");
        }
        if (const auto images = reader_.optional("images")) {
            images_ = read_images(*images, limits_);
        }
        read_list("objects", continuous::kObjectTypesMax, [this](const Value& object) {
            read_object(object);
        });
        for (const auto& [object, decorations] : decorations_) {
            example_.objects[object].decorations = read_decorations(decorations, example_);
        }
        read_list("polyhedra", kPolyhedraMax, [this](const Value& solid) { read_solid(solid); });
        if (const auto ground = reader_.optional("ground")) {
            example_.ground = object_named(*ground);
        }
        if (const auto bounds = reader_.optional("bounds")) {
            read_bounds(*bounds);
        }
        read_defaults();
        reader_.finish();
        if (!value_.faults().empty()) {
            return std::nullopt;
        }
        for (const auto& find_faults :
             {continuous::find_solid_faults, continuous::find_shape_faults}) {
            value_.faults().add_all(value_.pointer(), find_faults(example_));
            if (!value_.faults().empty()) {
                return std::nullopt;
            }
        }
        if (!is_spacing_given_) {
            example_.spacing = continuous::default_spacing(example_);
        }
        if (!is_size_given_) {
            const double spacing = example_.spacing;
            example_.size = {24 * spacing, 10 * spacing, 24 * spacing};
        }
        continuous::cut_boxes(example_);
        return std::move(example_);
    }

  private:
    [[nodiscard]] std::string text(const Value& value) const {
        return value.string(limits_.name_characters_max).value_or("");
    }

    template <class Read>
    void read_list(const char* name, std::size_t count_max, Read read) {
        if (const auto list = reader_.required(name)) {
            if (const auto values = list->array(1, count_max)) {
                std::for_each(values->begin(), values->end(), read);
            }
        }
    }

    std::optional<Texture> read_texture(const Value& value) {
        ObjectReader reader(value);
        Texture texture;
        if (const auto image = reader.required("image")) {
            const auto last = static_cast<std::int64_t>(images_.size()) - 1;
            if (images_.empty()) {
                image->fault("the example has no images");
            } else if (const auto number = image->integer(0, last)) {
                texture.image = images_[static_cast<std::size_t>(*number)];
            }
        }
        if (const auto metres = reader.optional("metres")) {
            texture.repeat_m = metres->number(kRepeatMin, kRepeatMax).value_or(1);
        }
        reader.finish();
        // Without an image there is a fault.
        return texture.image == nullptr ? std::nullopt : std::optional(std::move(texture));
    }

    void read_object(const Value& value) {
        ObjectReader reader(value);
        ObjectType object;
        Material material;
        if (const auto name = reader.required("name")) {
            object.name = text(*name);
            if (continuous::find_object(example_, object.name) != continuous::kEmpty) {
                name->fault("two objects have this name");
            }
        }
        if (const auto color = reader.optional("color")) {
            material.base_color = read_color(*color).value_or(material.base_color);
        }
        if (const auto emissive = reader.optional("emissive")) {
            material.emissive = read_color(*emissive).value_or(material.emissive);
        }
        if (const auto metallic = reader.optional("metallic")) {
            material.metallic = static_cast<float>(metallic->number(0, 1).value_or(0));
        }
        if (const auto roughness = reader.optional("roughness")) {
            material.roughness = static_cast<float>(roughness->number(0, 1).value_or(1));
        }
        if (const auto texture = reader.optional("texture")) {
            material.texture = read_texture(*texture);
        }
        if (const auto weight = reader.optional("weight")) {
            object.weight = weight->number(0, 1e6).value_or(1);
        }
        if (const auto shape = reader.optional("shape")) {
            object.shape = read_shape(*shape);
        }
        if (const auto decorations = reader.optional("decorations")) {
            decorations_.emplace_back(example_.objects.size(), *decorations);
        }
        reader.finish();
        material.name = object.name;
        object.material = static_cast<std::uint32_t>(example_.materials.size());
        example_.materials.push_back(std::move(material));
        example_.objects.push_back(std::move(object));
    }

    ObjectId object_named(const Value& value) {
        const std::string name = text(value);
        const ObjectId object = continuous::find_object(example_, name);
        if (object == continuous::kEmpty && value.json().is_string()) {
            value.fault("the example has no object \"" + name + "\"");
        }
        return object == continuous::kEmpty ? ObjectId{1} : object;
    }

    void read_solid(const Value& value) {
        ObjectReader reader(value);
        Polyhedron solid;
        if (const auto name = reader.optional("name")) {
            solid.name = text(*name);
        }
        if (const auto object = reader.required("object")) {
            solid.object = object_named(*object);
        }
        if (const auto vertices = reader.required("vertices")) {
            for (const Value& vertex : vertices->array(4, kCornersMax).value_or(NoValues())) {
                solid.corners.push_back(read_point(vertex, kMetresMax).value_or(Point::Zero()));
            }
        }
        if (const auto faces = reader.required("faces")) {
            const auto last = static_cast<std::int64_t>(solid.corners.size()) - 1;
            for (const Value& face : faces->array(4, kFacesMax).value_or(NoValues())) {
                Face& corners = solid.faces.emplace_back();
                for (const Value& corner : face.array(3, kFaceCornersMax).value_or(NoValues())) {
                    corners.push_back(static_cast<std::uint32_t>(corner.integer(0, last).value_or(0)
                    ));
                }
            }
        }
        reader.finish();
        example_.polyhedra.push_back(std::move(solid));
    }

    void read_bounds(const Value& value) {
        ObjectReader reader(value);
        Bounds bounds;
        const auto min = reader.required("min");
        const auto max = reader.required("max");
        reader.finish();
        const auto low = min ? read_point(*min, kMetresMax) : std::nullopt;
        const auto high = max ? read_point(*max, kMetresMax) : std::nullopt;
        if (low && high) {
            if ((low->array() >= high->array()).any()) {
                value.fault("max must be beyond min along every axis");
            }
            example_.bounds = Bounds{*low, *high};
        }
    }

    void read_defaults() {
        const auto spacing = reader_.optional("spacing");
        if (spacing) {
            example_.spacing = spacing->number_above(0, kMetresMax).value_or(1);
        }
        const auto size = reader_.optional("size");
        if (size) {
            const auto lengths = size->array(3, 3);
            for (std::size_t axis = 0; lengths && axis < 3; ++axis) {
                example_.size[axis] = (*lengths)[axis].number_above(0, kMetresMax).value_or(1);
            }
        }
        is_size_given_ = size.has_value();
        is_spacing_given_ = spacing.has_value();
        if (const auto density = reader_.optional("density")) {
            example_.density = density->number(0.001, 1).value_or(1);
        }
        if (const auto dimensions = reader_.optional("dimensions")) {
            for (const Value& value : dimensions->array(0, 256).value_or(NoValues())) {
                read_dimension(value);
            }
        }
        if (const auto constraints = reader_.optional("constraints")) {
            example_.constraints = read_solid_constraints(*constraints, limits_);
        }
        if (const auto connected = reader_.optional("connected")) {
            for (const Value& value : connected->array(0, 256).value_or(NoValues())) {
                std::vector<ObjectId>& together = example_.connected.emplace_back();
                for (const Value& object :
                     value.array(1, continuous::kObjectTypesMax).value_or(NoValues())) {
                    together.push_back(object_named(object));
                }
            }
        }
    }

    void read_dimension(const Value& value) {
        ObjectReader reader(value);
        continuous::Dimension dimension;
        if (const auto object = reader.required("object")) {
            dimension.object = object_named(*object);
        }
        if (const auto normal = reader.required("normal")) {
            const auto point = read_point(*normal, kMetresMax);
            dimension.normal = point.value_or(dimension.normal);
            if (dimension.normal.norm() < 1e-9) {
                normal->fault("must have a length");
            }
        }
        reader.finish();
        example_.dimensions.push_back(dimension);
    }

    using NoValues = std::vector<Value>;

    const Value& value_;
    const RequestLimits& limits_;
    ObjectReader reader_;
    continuous::Example example_;
    std::vector<SharedImage> images_;  // null: there is a fault
    // By object; they are read after all objects, which they may name.
    std::vector<std::pair<std::size_t, Value>> decorations_;
    bool is_size_given_ = false;
    bool is_spacing_given_ = false;
};

// False when its models could not keep to them. They come first in those of its models.
bool check_constraints(const std::shared_ptr<const ExampleReading>& plain, const Value& value) {
    const std::size_t count = plain->example().constraints.size();
    if (count == 0) {
        return true;
    }
    continuous::Parameters usual = continuous::fill_defaults({}, plain->example());
    const auto reading = ExampleReading::read_for(plain, usual);
    if (!reading) {
        const Error& error = reading.error();
        value.faults().add_all(value.pointer(), error.faults);
        if (error.faults.empty()) {
            value.fault(error.message, error.code == ErrorCode::kTooLarge);
        }
        return false;
    }
    usual.constraints->resize(count);
    std::vector<Fault> faults = continuous::find_faults(**reading, usual);
    std::erase_if(faults, [](const Fault& fault) {
        return !fault.pointer.starts_with("/constraints/");
    });
    value.faults().add_all(value.pointer(), faults);
    return faults.empty();
}

// Without their textures.
OrderedJson write_objects(const continuous::Example& example) {
    const auto triple = [](const Color& color) {
        return OrderedJson::array({color.r, color.g, color.b});
    };
    OrderedJson objects = OrderedJson::array();
    for (const ObjectType& object : example.objects) {
        if (object.rest_of != continuous::kEmpty) {
            continue;
        }
        const Material& material = example.materials[object.material];
        objects.push_back(
            {{"name", object.name},
             {"color", triple(material.base_color)},
             {"emissive", triple(material.emissive)},
             {"metallic", material.metallic},
             {"roughness", material.roughness},
             {"weight", object.weight}}
        );
    }
    return objects;
}

}  // namespace

std::shared_ptr<const ExampleReading> read_solids(const Value& value, const RequestLimits& limits) {
    auto example = SolidsReader(value, limits).read();
    if (!example) {
        return nullptr;
    }
    auto reading = ExampleReading::make(std::move(*example));
    if (!reading) {
        if (reading.error().faults.empty()) {
            value.fault(reading.error().message, reading.error().code == ErrorCode::kTooLarge);
        }
        value.faults().add_all(value.pointer(), reading.error().faults);
        return nullptr;
    }
    if (!check_constraints(*reading, value)) {
        return nullptr;
    }
    return std::move(*reading);
}

OrderedJson write_solids(const continuous::Example& given) {
    const continuous::Example example = continuous::with_whole_boxes(given);
    OrderedJson objects = write_objects(example);
    const ImageList images(example);
    for (std::size_t i = 0; i < example.objects.size(); ++i) {
        const auto& texture = example.materials[example.objects[i].material].texture;
        if (texture) {
            objects[i]["texture"] = {
                {"image", images.number_of(*texture)}, {"metres", texture->repeat_m}};
        }
        if (const auto& shape = example.objects[i].shape) {
            objects[i]["shape"] = write_shape(*shape);
        }
        if (!example.objects[i].decorations.empty()) {
            objects[i]["decorations"] = write_decorations(example.objects[i].decorations, example);
        }
    }
    OrderedJson polyhedra = OrderedJson::array();
    for (const Polyhedron& solid : example.polyhedra) {
        OrderedJson vertices = OrderedJson::array();
        for (const Point& corner : solid.corners) {
            vertices.push_back(write_point(corner));
        }
        polyhedra.push_back(
            {{"name", solid.name},
             {"object", example.objects[solid.object - 1U].name},
             {"vertices", std::move(vertices)},
             {"faces", solid.faces}}
        );
    }
    OrderedJson dimensions = OrderedJson::array();
    for (const continuous::Dimension& dimension : example.dimensions) {
        dimensions.push_back(
            {{"object", example.objects[dimension.object - 1U].name},
             {"normal", write_point(dimension.normal)}}
        );
    }
    OrderedJson connected = OrderedJson::array();
    for (const std::vector<ObjectId>& together : example.connected) {
        OrderedJson& names = connected.emplace_back(OrderedJson::array());
        for (const ObjectId object : together) {
            names.push_back(example.objects[object - 1U].name);
        }
    }
    OrderedJson written = {
        {"kind", "continuous"},
        {"name", example.name},
        {"title", example.title},
        {"description", example.description},
        {"objects", std::move(objects)},
        {"polyhedra", std::move(polyhedra)},
        {"dimensions", std::move(dimensions)},
        {"connected", std::move(connected)},
        {"constraints", write_constraints(example.constraints)},
        {"spacing", example.spacing},
        {"size", example.size},
        {"density", example.density}};
    if (!images.empty()) {
        written["images"] = images.write();
    }
    if (example.ground) {
        written["ground"] = example.objects[*example.ground - 1U].name;
    }
    if (example.bounds) {
        written["bounds"] = {
            {"min", write_point(example.bounds->min)}, {"max", write_point(example.bounds->max)}};
    }
    return written;
}

OrderedJson solids_summary(const ExampleReading& reading, const std::string& id, bool built_in) {
    const continuous::Example& example = reading.example();
    const std::string self = "/v1/examples/" + id;
    return {
        {"id", id},
        {"kind", "continuous"},
        {"name", example.name},
        {"title", example.title},
        {"description", example.description},
        {"built_in", built_in},
        {"labels", reading.figures().count()},
        {"objects", write_objects(example)},
        {"spacing", example.spacing},
        {"size", example.size},
        {"default_size", example.size},
        {"urls", {{"self", self}, {"model", self + "/model.glb"}}}};
}

OrderedJson solids_resource(const ExampleReading& reading, const std::string& id, bool built_in) {
    OrderedJson resource = solids_summary(reading, id, built_in);
    resource.update(write_solids(reading.example()));
    return resource;
}

}  // namespace modelsynth::proto
