#include "proto/decoration_codec.h"

#include "proto/continuous_codec.h"
#include "proto/shape_codec.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace modelsynth::proto {

namespace {

using continuous::CornerDecoration;
using continuous::Decoration;
using continuous::EdgeDecoration;
using continuous::Example;
using continuous::FaceChoice;
using continuous::FaceKind;
using continuous::ProfilePoint;
using continuous::Turn;

// In the order of the enumerators; an edge turns one way or the other.
constexpr std::array<const char*, 6> kFaceKinds = {
    "any", "up", "down", "side", "slope", "overhang"};
constexpr std::array<const char*, 3> kTurns = {"convex", "concave", "any"};

using NoValues = std::vector<Value>;

FaceChoice read_face(const Value& value) {
    if (value.json().is_array()) {
        return {FaceKind::kNormal, read_normal(value).value_or(std::array<double, 3>())};
    }
    return {static_cast<FaceKind>(value.one_of(kFaceKinds).value_or(0))};
}

template <std::size_t kCount>
void read_faces(const Value& value, std::array<FaceChoice, kCount>& faces) {
    const auto values = value.array(kCount, kCount);
    for (std::size_t i = 0; values && i < kCount; ++i) {
        faces.at(i) = read_face((*values)[i]);
    }
}

continuous::ObjectId read_look(ObjectReader& reader, const Example& example) {
    const auto value = reader.optional("material");
    if (!value) {
        return continuous::kEmpty;
    }
    const auto name = value->string(std::string::npos);
    const auto object = name ? continuous::find_object(example, *name) : continuous::kEmpty;
    if (name && object == continuous::kEmpty) {
        value->fault("the example has no object \"" + *name + "\"");
    }
    return object;
}

std::vector<ProfilePoint> read_profile(const Value& value) {
    std::vector<ProfilePoint> profile;
    bool is_whole = true;
    const auto points = value.array(3, continuous::kProfilePointsMax);
    for (const Value& point : points.value_or(NoValues())) {
        const auto offsets = point.array(2, 2);
        const auto offset = [&](std::size_t i) {
            constexpr double kMax = continuous::kProfileOffsetMax;
            const auto metres = offsets ? (*offsets)[i].number(-kMax, kMax) : std::nullopt;
            is_whole = is_whole && metres.has_value();
            return metres.value_or(0);
        };
        const double p = offset(0);
        profile.push_back({p, offset(1)});
    }
    if (points && is_whole && !continuous::is_simple(profile)) {
        value.fault("must enclose an area, and neither cross nor touch itself");
    }
    return profile;
}

EdgeDecoration read_edges(const Value& faces, ObjectReader& reader, const Example& example) {
    EdgeDecoration decoration;
    read_faces(faces, decoration.faces);
    if (const auto turn = reader.optional("turn")) {
        decoration.turn = static_cast<Turn>(turn->one_of(std::span(kTurns).first(2)).value_or(0));
    }
    if (const auto profile = reader.required("profile")) {
        decoration.profile = read_profile(*profile);
    }
    decoration.look = read_look(reader, example);
    return decoration;
}

CornerDecoration read_corners(const Value& faces, ObjectReader& reader, const Example& example) {
    CornerDecoration decoration;
    read_faces(faces, decoration.faces);
    if (const auto turn = reader.optional("turn")) {
        decoration.turn = static_cast<Turn>(turn->one_of(kTurns).value_or(0));
    }
    if (const auto mesh = reader.required("mesh")) {
        decoration.mesh = read_mesh(*mesh);
    }
    if (const auto turned = reader.optional("turned")) {
        decoration.is_turned = turned->boolean().value_or(false);
    }
    decoration.look = read_look(reader, example);
    return decoration;
}

Decoration read_decoration(const Value& value, const Example& example) {
    ObjectReader reader(value);
    const auto edges = reader.optional("edges");
    const auto corners = reader.optional("corners");
    Decoration decoration;
    if (edges.has_value() == corners.has_value()) {
        if (value.json().is_object()) {
            value.fault("must have \"edges\" or \"corners\"");
        }
        return decoration;  // what else is wrong depends on which it is
    }
    if (edges) {
        decoration = read_edges(*edges, reader, example);
    } else {
        decoration = read_corners(*corners, reader, example);
    }
    reader.finish();
    return decoration;
}

template <std::size_t kCount>
OrderedJson write_faces(const std::array<FaceChoice, kCount>& faces) {
    OrderedJson written = OrderedJson::array();
    for (const FaceChoice& face : faces) {
        if (face.kind == FaceKind::kNormal) {
            written.push_back(face.normal);
        } else {
            written.push_back(kFaceKinds.at(static_cast<std::size_t>(face.kind)));
        }
    }
    return written;
}

const char* name_of(Turn turn) { return kTurns.at(static_cast<std::size_t>(turn)); }

OrderedJson write(const EdgeDecoration& decoration) {
    return {
        {"edges", write_faces(decoration.faces)},
        {"turn", name_of(decoration.turn)},
        {"profile", decoration.profile}};
}

OrderedJson write(const CornerDecoration& decoration) {
    return {
        {"corners", write_faces(decoration.faces)},
        {"turn", name_of(decoration.turn)},
        {"mesh", write_shape(*decoration.mesh)},
        {"turned", decoration.is_turned}};
}

}  // namespace

std::vector<Decoration> read_decorations(const Value& given, const Example& example) {
    std::vector<Decoration> decorations;
    for (const Value& value : given.array(0, continuous::kDecorationsMax).value_or(NoValues())) {
        decorations.push_back(read_decoration(value, example));
    }
    return decorations;
}

OrderedJson write_decorations(const std::vector<Decoration>& decorations, const Example& example) {
    OrderedJson written = OrderedJson::array();
    for (const Decoration& decoration : decorations) {
        std::visit(
            [&](const auto& one) {
                OrderedJson& added = written.emplace_back(write(one));
                if (one.look != continuous::kEmpty) {
                    added["material"] = example.objects[one.look - 1U].name;
                }
            },
            decoration
        );
    }
    return written;
}

}  // namespace modelsynth::proto
