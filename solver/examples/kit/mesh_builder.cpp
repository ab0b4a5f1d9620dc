#include "solver/examples/kit/mesh_builder.h"

#include "solver/core/random.h"
#include "solver/mesh/turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <tuple>

namespace modelsynth::examples {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

float length(const Vec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

Vec3 normalised(const Vec3& v) {
    const float size = length(v);
    return {v.x / size, v.y / size, v.z / size};
}

float to_linear(float value) {
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

// Coordinates are rounded to a grid, so that what meets in theory meets to the bit, and so that
// the last bit of a sine, which may differ from machine to machine, does not show.
Vec3 rounded(const Vec3& v, float steps) {
    const auto round = [steps](float value) { return std::round(value * steps) / steps + 0.0F; };
    return {round(v.x), round(v.y), round(v.z)};
}

std::uint8_t to_byte(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255));
}

}  // namespace

Color srgb(std::uint32_t hex) {
    const auto part = [hex](int shift) {
        return to_linear(static_cast<float>(hex >> shift & 0xFF) / 255.0F);
    };
    return {part(16), part(8), part(0)};
}

float scatter(std::uint32_t seed, std::uint32_t index) {
    const auto drawn = philox4x32({index, 0, 0, 0}, {seed, 0});
    return static_cast<float>(drawn[0] >> 8) / static_cast<float>(1U << 24);
}

MeshBuilder& MeshBuilder::material(MaterialId material) {
    material_ = material;
    return *this;
}

MeshBuilder& MeshBuilder::tint(float brightness) {
    return tint(brightness, brightness, brightness);
}

MeshBuilder& MeshBuilder::tint(float red, float green, float blue) {
    tint_ = {red, green, blue};
    return *this;
}

void MeshBuilder::add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = cross(b - a, c - a);
    if (length(normal) < 1e-9F) {
        return;  // no area, nothing to see
    }
    const Vec3 unit = normalised(normal);
    add_smooth({a, b, c}, {unit, unit, unit});
}

void MeshBuilder::add_smooth(
    const std::array<Vec3, 3>& positions, const std::array<Vec3, 3>& normals
) {
    if (length(cross(positions[1] - positions[0], positions[2] - positions[0])) < 1e-9F) {
        return;
    }
    Triangle triangle = {{}, material_};
    for (std::size_t i = 0; i < 3; ++i) {
        triangle.corners[i] = {positions[i], normals[i], tint_};
    }
    triangles_.push_back(triangle);
}

MeshBuilder& MeshBuilder::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    add(a, b, c);
    return *this;
}

MeshBuilder& MeshBuilder::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    add(a, b, c);
    add(a, c, d);
    return *this;
}

MeshBuilder& MeshBuilder::box(const Extent& extent) { return open_box(extent, "EWUDSN"); }

MeshBuilder& MeshBuilder::open_box(const Extent& extent, const char* faces) {
    const auto& [x0, y0, z0] = extent.min;
    const auto& [x1, y1, z1] = extent.max;
    const auto wants = [faces](char face) { return std::strchr(faces, face) != nullptr; };
    if (wants('E')) {
        quad({x1, y0, z1}, {x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1});
    }
    if (wants('W')) {
        quad({x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}, {x0, y1, z0});
    }
    if (wants('U')) {
        quad({x0, y1, z1}, {x1, y1, z1}, {x1, y1, z0}, {x0, y1, z0});
    }
    if (wants('D')) {
        quad({x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1});
    }
    if (wants('S')) {
        quad({x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1});
    }
    if (wants('N')) {
        quad({x1, y0, z0}, {x0, y0, z0}, {x0, y1, z0}, {x1, y1, z0});
    }
    return *this;
}

MeshBuilder& MeshBuilder::bevelled_box(const Extent& extent, float bevel) {
    const auto& [x0, y0, z0] = extent.min;
    const auto& [x1, y1, z1] = extent.max;
    const float b = std::min({bevel, (x1 - x0) / 2, (z1 - z0) / 2, y1 - y0});
    // An octagon upright, drawn in by the bevel at the top.
    const auto ring = [&](float y, float inset) {
        const float c = b;
        return std::array<Vec3, 8>{
            {{x0 + c, y, z1 - inset},
             {x1 - c, y, z1 - inset},
             {x1 - inset, y, z1 - c},
             {x1 - inset, y, z0 + c},
             {x1 - c, y, z0 + inset},
             {x0 + c, y, z0 + inset},
             {x0 + inset, y, z0 + c},
             {x0 + inset, y, z1 - c}}};
    };
    const auto foot = ring(y0, 0);
    const auto shoulder = ring(y1 - b, 0);
    const auto top = ring(y1, b);
    for (std::size_t i = 0; i < 8; ++i) {
        const std::size_t j = (i + 1) % 8;
        quad(foot[i], foot[j], shoulder[j], shoulder[i]);
        quad(shoulder[i], shoulder[j], top[j], top[i]);
    }
    quad({x0 + b, y1, z1 - b}, {x1 - b, y1, z1 - b}, {x1 - b, y1, z0 + b}, {x0 + b, y1, z0 + b});
    for (std::size_t i = 1; i + 1 < 8; ++i) {
        add(foot[0], foot[i + 1], foot[i]);
    }
    return *this;
}

MeshBuilder& MeshBuilder::prism(std::span<const Point2> outline, float y0, float y1, bool caps) {
    // Counter-clockwise from above: (x, z) turns from +x to -z.
    const std::size_t count = outline.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 a = outline[i];
        const Point2 b = outline[(i + 1) % count];
        quad({a.u, y0, a.v}, {b.u, y0, b.v}, {b.u, y1, b.v}, {a.u, y1, a.v});
    }
    for (std::size_t i = 1; caps && i + 1 < count; ++i) {
        const Point2 a = outline[0];
        const Point2 b = outline[i];
        const Point2 c = outline[i + 1];
        add({a.u, y1, a.v}, {b.u, y1, b.v}, {c.u, y1, c.v});
        add({a.u, y0, a.v}, {c.u, y0, c.v}, {b.u, y0, b.v});
    }
    return *this;
}

MeshBuilder& MeshBuilder::extrude(std::span<const Point2> outline, float z0, float z1, bool caps) {
    const std::size_t count = outline.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 a = outline[i];
        const Point2 b = outline[(i + 1) % count];
        quad({a.u, a.v, z0}, {b.u, b.v, z0}, {b.u, b.v, z1}, {a.u, a.v, z1});
        // The quad above looks outward for a counter-clockwise outline seen from +z.
    }
    for (std::size_t i = 1; caps && i + 1 < count; ++i) {
        const Point2 a = outline[0];
        const Point2 b = outline[i];
        const Point2 c = outline[i + 1];
        add({a.u, a.v, z1}, {b.u, b.v, z1}, {c.u, c.v, z1});
        add({a.u, a.v, z0}, {c.u, c.v, z0}, {b.u, b.v, z0});
    }
    return *this;
}

MeshBuilder& MeshBuilder::lathe(
    float x, float z, std::span<const Point2> profile, int segments, bool smooth
) {
    const auto at = [&](const Point2& point, int segment) {
        const float angle =
            2 * kPi * static_cast<float>(segment % segments) / static_cast<float>(segments);
        return Vec3{x + point.u * std::cos(angle), point.v, z - point.u * std::sin(angle)};
    };
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const Point2 low = profile[i];
        const Point2 high = profile[i + 1];
        const Vec3 slope = normalised({high.v - low.v, low.u - high.u, 0});
        const auto normal = [&](int segment) {
            const float angle =
                2 * kPi * static_cast<float>(segment % segments) / static_cast<float>(segments);
            return Vec3{slope.x * std::cos(angle), slope.y, -slope.x * std::sin(angle)};
        };
        for (int s = 0; s < segments; ++s) {
            const Vec3 a = at(low, s);
            const Vec3 b = at(low, s + 1);
            const Vec3 c = at(high, s + 1);
            const Vec3 d = at(high, s);
            if (smooth) {
                add_smooth({a, b, c}, {normal(s), normal(s + 1), normal(s + 1)});
                add_smooth({a, c, d}, {normal(s), normal(s + 1), normal(s)});
            } else {
                quad(a, b, c, d);
            }
        }
    }
    return *this;
}

MeshBuilder& MeshBuilder::cylinder(
    float x, float z, float radius, float y0, float y1, int segments
) {
    const std::array<Point2, 4> profile = {{{0, y0}, {radius, y0}, {radius, y1}, {0, y1}}};
    return lathe(x, z, profile, segments);
}

MeshBuilder& MeshBuilder::cone(float x, float z, float radius, float y0, float y1, int segments) {
    const std::array<Point2, 3> profile = {{{0, y0}, {radius, y0}, {0, y1}}};
    return lathe(x, z, profile, segments, false);
}

MeshBuilder& MeshBuilder::ball(const Vec3& centre, const Vec3& radii, int segments) {
    const int rings = std::max(3, segments / 2);
    const auto direction = [&](int ring, int segment) {
        const float up = kPi * (static_cast<float>(ring) / static_cast<float>(rings) - 0.5F);
        const float round =
            2 * kPi * static_cast<float>(segment % segments) / static_cast<float>(segments);
        const float reach = ring == 0 || ring == rings ? 0.0F : std::cos(up);
        return Vec3{reach * std::cos(round), std::sin(up), -reach * std::sin(round)};
    };
    const auto place = [&](const Vec3& d) {
        return Vec3{centre.x + d.x * radii.x, centre.y + d.y * radii.y, centre.z + d.z * radii.z};
    };
    const auto normal = [&](const Vec3& d) {
        return normalised({d.x / radii.x, d.y / radii.y, d.z / radii.z});
    };
    for (int ring = 0; ring < rings; ++ring) {
        for (int s = 0; s < segments; ++s) {
            const Vec3 a = direction(ring, s);
            const Vec3 b = direction(ring, s + 1);
            const Vec3 c = direction(ring + 1, s + 1);
            const Vec3 d = direction(ring + 1, s);
            add_smooth({place(a), place(b), place(c)}, {normal(a), normal(b), normal(c)});
            add_smooth({place(a), place(c), place(d)}, {normal(a), normal(c), normal(d)});
        }
    }
    return *this;
}

MeshBuilder& MeshBuilder::gable_roof(const Extent& extent, float overhang, float thickness) {
    const auto& [x0, y0, z0] = extent.min;
    const auto& [x1, y1, z1] = extent.max;
    const float middle = (z0 + z1) / 2;
    const float drop = overhang * (y1 - y0) / (z1 - middle);
    // Seen from the east, as (z, y): outer slopes, then back along the inner ones.
    const std::array<Point2, 6> outline = {
        {{z1 + overhang, y0 - drop},
         {middle, y1},
         {z0 - overhang, y0 - drop},
         {z0 - overhang, y0 - drop - thickness},
         {middle, y1 - thickness},
         {z1 + overhang, y0 - drop - thickness}}};
    const auto at = [&](float x, std::size_t i) { return Vec3{x, outline[i].v, outline[i].u}; };
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::size_t j = (i + 1) % outline.size();
        quad(at(x0, i), at(x1, i), at(x1, j), at(x0, j));
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {  // the ends of the slopes
        const std::size_t ridge = 1;
        const std::size_t under_ridge = 4;
        const std::size_t foot = i == 0 ? 5 : 3;
        if (i == 0) {
            quad(at(x1, foot), at(x1, under_ridge), at(x1, ridge), at(x1, i));
            quad(at(x0, i), at(x0, ridge), at(x0, under_ridge), at(x0, foot));
        } else {
            quad(at(x1, foot), at(x1, i), at(x1, ridge), at(x1, under_ridge));
            quad(at(x0, under_ridge), at(x0, ridge), at(x0, i), at(x0, foot));
        }
    }
    triangle({x1, y0, z1}, {x1, y0, z0}, {x1, y1 - thickness, middle});
    triangle({x0, y0, z0}, {x0, y0, z1}, {x0, y1 - thickness, middle});
    return *this;
}

MeshBuilder& MeshBuilder::hip_roof(const Extent& extent, float overhang) {
    const float x0 = extent.min.x - overhang;
    const float x1 = extent.max.x + overhang;
    const float z0 = extent.min.z - overhang;
    const float z1 = extent.max.z + overhang;
    const float y0 = extent.min.y;
    const float y1 = extent.max.y;
    const float inset = std::min(x1 - x0, z1 - z0) / 2;
    const Vec3 ridge_a = {x0 + inset, y1, z0 + inset};
    const Vec3 ridge_b = {x1 - inset, y1, z1 - inset};
    if (x1 - x0 >= z1 - z0) {
        quad({x0, y0, z1}, {x1, y0, z1}, ridge_b, ridge_a);
        quad({x1, y0, z0}, {x0, y0, z0}, ridge_a, ridge_b);
        triangle({x1, y0, z1}, {x1, y0, z0}, ridge_b);
        triangle({x0, y0, z0}, {x0, y0, z1}, ridge_a);
    } else {
        quad({x1, y0, z1}, {x1, y0, z0}, ridge_a, ridge_b);
        quad({x0, y0, z0}, {x0, y0, z1}, ridge_b, ridge_a);
        triangle({x0, y0, z1}, {x1, y0, z1}, ridge_b);
        triangle({x1, y0, z0}, {x0, y0, z0}, ridge_a);
    }
    return quad({x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1});
}

MeshBuilder& MeshBuilder::stairs(const Extent& extent, int steps) {
    const float rise = (extent.max.y - extent.min.y) / static_cast<float>(steps);
    const float run = (extent.max.z - extent.min.z) / static_cast<float>(steps);
    for (int step = 0; step < steps; ++step) {
        const auto index = static_cast<float>(step);
        open_box(
            {{extent.min.x, extent.min.y, extent.min.z},
             {extent.max.x, extent.min.y + rise * (index + 1), extent.max.z - run * index}},
            "EWUS"
        );
    }
    return open_box(extent, "N");
}

MeshBuilder& MeshBuilder::arch(const Extent& extent, float width, float springing_y, int segments) {
    const auto& [x0, y0, z0] = extent.min;
    const auto& [x1, y1, z1] = extent.max;
    const float middle = (x0 + x1) / 2;
    const float radius = width / 2;
    const float left = middle - radius;
    const float right = middle + radius;
    open_box({{x0, y0, z0}, {left, y1, z1}}, "WSNU");
    open_box({{right, y0, z0}, {x1, y1, z1}}, "ESNU");
    // The jambs look inward.
    quad({left, y0, z1}, {left, y0, z0}, {left, springing_y, z0}, {left, springing_y, z1});
    quad({right, y0, z0}, {right, y0, z1}, {right, springing_y, z1}, {right, springing_y, z0});
    quad({left, y1, z1}, {right, y1, z1}, {right, y1, z0}, {left, y1, z0});
    for (int s = 0; s < segments; ++s) {
        const auto at = [&](int step) {
            const float angle = kPi * static_cast<float>(step) / static_cast<float>(segments);
            return Point2{
                middle - radius * std::cos(angle), springing_y + radius * std::sin(angle)};
        };
        const Point2 a = at(s);
        const Point2 b = at(s + 1);
        quad({a.u, a.v, z1}, {b.u, b.v, z1}, {b.u, y1, z1}, {a.u, y1, z1});
        quad({b.u, b.v, z0}, {a.u, a.v, z0}, {a.u, y1, z0}, {b.u, y1, z0});
        quad({a.u, a.v, z0}, {b.u, b.v, z0}, {b.u, b.v, z1}, {a.u, a.v, z1});
    }
    return *this;
}

MeshBuilder& MeshBuilder::transformed(
    const std::function<Vec3(const Vec3&)>& place,
    const std::function<Vec3(const Vec3&)>& turn,
    bool flips,
    const std::function<void(MeshBuilder&)>& make
) {
    MeshBuilder inner;
    inner.material_ = material_;
    inner.tint_ = tint_;
    make(inner);
    for (Triangle triangle : inner.triangles_) {
        for (Vertex& vertex : triangle.corners) {
            vertex.position = place(vertex.position);
            vertex.normal = turn(vertex.normal);
        }
        if (flips) {
            std::swap(triangle.corners[1], triangle.corners[2]);
        }
        triangles_.push_back(triangle);
    }
    return *this;
}

MeshBuilder& MeshBuilder::turned(int quarter_turns, const std::function<void(MeshBuilder&)>& make) {
    const auto turn = [quarter_turns](const Vec3& v) {
        return modelsynth::turned(v, quarter_turns);
    };
    return transformed(turn, turn, false, make);
}

MeshBuilder& MeshBuilder::placed(
    const Vec3& offset,
    float angle_radians,
    float scale,
    const std::function<void(MeshBuilder&)>& make
) {
    const float c = std::cos(angle_radians);
    const float s = std::sin(angle_radians);
    const auto turn = [c, s](const Vec3& v) {
        return Vec3{c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
    };
    const auto place = [&](const Vec3& v) {
        const Vec3 turned = turn(v);
        return Vec3{
            offset.x + scale * turned.x, offset.y + scale * turned.y, offset.z + scale * turned.z};
    };
    return transformed(place, turn, false, make);
}

MeshBuilder& MeshBuilder::mirrored(const std::function<void(MeshBuilder&)>& make) {
    const auto mirror = [](const Vec3& v) { return Vec3{-v.x, v.y, v.z}; };
    return transformed(mirror, mirror, true, make);
}

MeshBuilder& MeshBuilder::shade(
    const std::function<float(const Vec3& position, const Vec3& normal)>& brightness
) {
    for (Triangle& triangle : triangles_) {
        for (Vertex& vertex : triangle.corners) {
            const float factor = brightness(vertex.position, vertex.normal);
            for (float& part : vertex.color) {
                part *= factor;
            }
        }
    }
    return *this;
}

MeshBuilder& MeshBuilder::shade_upwards(float dark, float height) {
    return shade([dark, height](const Vec3& position, const Vec3& normal) {
        const float rise = std::clamp(position.y / height, 0.0F, 1.0F);
        const float under = normal.y < -0.5F ? 0.8F : 1.0F;
        return (dark + (1 - dark) * rise) * under;
    });
}

Mesh MeshBuilder::build(std::string name) && {
    Mesh mesh = {std::move(name), {}};
    std::map<MaterialId, std::size_t> primitive_of;
    using Key = std::tuple<float, float, float, float, float, float, int>;
    std::vector<std::map<Key, std::uint32_t>> vertex_of;
    for (const Triangle& triangle : triangles_) {
        const auto [entry, is_new] =
            primitive_of.try_emplace(triangle.material, mesh.primitives.size());
        if (is_new) {
            mesh.primitives.emplace_back().material = triangle.material;
            vertex_of.emplace_back();
        }
        Primitive& primitive = mesh.primitives[entry->second];
        for (const Vertex& corner : triangle.corners) {
            constexpr float kPositionSteps = 4096;
            constexpr float kNormalSteps = 2048;
            const Vertex vertex = {
                rounded(corner.position, kPositionSteps),
                rounded(corner.normal, kNormalSteps),
                corner.color};
            const std::array<std::uint8_t, 3> color = {
                to_byte(vertex.color[0]), to_byte(vertex.color[1]), to_byte(vertex.color[2])};
            const Key key = {
                vertex.position.x,
                vertex.position.y,
                vertex.position.z,
                vertex.normal.x,
                vertex.normal.y,
                vertex.normal.z,
                color[0] << 16 | color[1] << 8 | color[2]};
            const auto [known, is_new_vertex] = vertex_of[entry->second].try_emplace(
                key, static_cast<std::uint32_t>(primitive.positions.size())
            );
            if (is_new_vertex) {
                primitive.positions.push_back(vertex.position);
                primitive.normals.push_back(vertex.normal);
                primitive.colors.push_back(color);
            }
            primitive.indices.push_back(known->second);
        }
    }
    return mesh;
}

std::size_t MeshBuilder::triangle_count() const { return triangles_.size(); }

}  // namespace modelsynth::examples
