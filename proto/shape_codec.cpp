#include "proto/shape_codec.h"

#include "proto/continuous_codec.h"
#include "solver/continuous/check/solid_check.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::proto {

namespace {

using continuous::Face;
using continuous::Point;
using continuous::Shape;

constexpr std::size_t kShapeCornersMax = 4096;
constexpr std::size_t kShapeFacesMax = 2048;
constexpr std::size_t kShapeFaceCornersMax = 64;

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

const std::vector<Point> kCube = {
    {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<Face> kCubeFaces = {
    {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

using NoValues = std::vector<Value>;

// Whether it encloses something, told at the places of the request.
void check_closed(const Value& value, const Shape& shape) {
    continuous::Example alone;
    alone.materials = {{}};
    alone.objects = {{"shape"}};
    alone.polyhedra = {{"shape", 1, shape.corners, shape.faces}};
    constexpr std::string_view kSolid = "/polyhedra/0";
    for (const Fault& fault : continuous::find_solid_faults(alone)) {
        std::string pointer = value.pointer();
        if (fault.pointer.starts_with(kSolid)) {
            pointer += std::string_view(fault.pointer).substr(kSolid.size());
        }
        value.faults().add(std::move(pointer), fault.detail, fault.over_limit);
    }
}

std::shared_ptr<const Shape> read(
    const Value& given, bool has_axes, std::initializer_list<const char*> other_fields
) {
    auto shape = std::make_shared<Shape>();
    Faults faults;
    const Value value(given.json(), given.pointer(), faults);
    ObjectReader reader(value);
    for (const char* name : other_fields) {
        static_cast<void>(reader.optional(name));
    }
    // What is even alone is the box.
    const bool is_box = has_axes && value.json().is_object() && value.json().contains("even") &&
                        !value.json().contains("vertices") && !value.json().contains("faces");
    if (is_box) {
        shape->corners = kCube;
        shape->faces = kCubeFaces;
    } else if (const auto vertices = reader.required("vertices")) {
        for (const Value& vertex : vertices->array(4, kShapeCornersMax).value_or(NoValues())) {
            shape->corners.push_back(read_point(vertex, kMetresMax).value_or(Point::Zero()));
        }
    }
    if (const auto faces = is_box ? std::nullopt : reader.required("faces")) {
        const auto last = static_cast<std::int64_t>(shape->corners.size()) - 1;
        for (const Value& face : faces->array(4, kShapeFacesMax).value_or(NoValues())) {
            Face& corners = shape->faces.emplace_back();
            for (const Value& corner : face.array(3, kShapeFaceCornersMax).value_or(NoValues())) {
                corners.push_back(static_cast<std::uint32_t>(corner.integer(0, last).value_or(0)));
            }
        }
    }
    if (const auto smooth = reader.optional("smooth")) {
        shape->smooth_degrees = smooth->number(0, 180).value_or(0);
    }
    if (const auto even = has_axes ? reader.optional("even") : std::nullopt) {
        for (const Value& axis : even->array(2, 3).value_or(NoValues())) {
            if (const auto number = axis.one_of(kAxes)) {
                shape->is_even.at(*number) = true;
            }
        }
    }
    reader.finish();
    if (faults.empty()) {
        check_closed(value, *shape);
    }
    given.faults().add_all("", faults.take());
    return shape;
}

}  // namespace

std::shared_ptr<const Shape> read_shape(const Value& given) { return read(given, true, {}); }

std::shared_ptr<const Shape> read_shape(
    const Value& given, std::initializer_list<const char*> other_fields
) {
    return read(given, true, other_fields);
}

std::shared_ptr<const Shape> read_mesh(const Value& given) { return read(given, false, {}); }

OrderedJson write_shape(const Shape& shape) {
    OrderedJson vertices = OrderedJson::array();
    for (const Point& corner : shape.corners) {
        vertices.push_back(write_point(corner));
    }
    OrderedJson written = {
        {"vertices", std::move(vertices)},
        {"faces", shape.faces},
        {"smooth", shape.smooth_degrees}};
    OrderedJson even = OrderedJson::array();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (shape.is_even.at(axis)) {
            even.push_back(kAxes.at(axis));
        }
    }
    if (!even.empty()) {
        written["even"] = std::move(even);
    }
    return written;
}

}  // namespace modelsynth::proto
