#include "solver/examples/city_facade.h"

namespace modelsynth::examples {

namespace {

constexpr float kFront = kCityHalf;

void add_front_quad(MeshBuilder& mesh, const Opening& at, float z) {
    if (at.u1 > at.u0 && at.v1 > at.v0) {
        mesh.quad({at.u0, at.v0, z}, {at.u1, at.v0, z}, {at.u1, at.v1, z}, {at.u0, at.v1, z});
    }
}

void add_reveals(MeshBuilder& mesh, const Opening& o, float depth) {
    const float back = kFront - depth;
    mesh.quad({o.u0, o.v0, kFront}, {o.u0, o.v0, back}, {o.u0, o.v1, back}, {o.u0, o.v1, kFront});
    mesh.quad({o.u1, o.v0, back}, {o.u1, o.v0, kFront}, {o.u1, o.v1, kFront}, {o.u1, o.v1, back});
    mesh.quad({o.u0, o.v0, kFront}, {o.u1, o.v0, kFront}, {o.u1, o.v0, back}, {o.u0, o.v0, back});
    mesh.quad({o.u0, o.v1, back}, {o.u1, o.v1, back}, {o.u1, o.v1, kFront}, {o.u0, o.v1, kFront});
}

}  // namespace

void add_wall(
    MeshBuilder& mesh,
    const CityMaterials& materials,
    MaterialId wall,
    const Opening& whole,
    std::span<const Opening> openings,
    float depth
) {
    float u = whole.u0;
    for (const Opening& opening : openings) {
        mesh.material(wall).tint(1);
        add_front_quad(mesh, {u, opening.u0, whole.v0, whole.v1}, kFront);
        add_front_quad(mesh, {opening.u0, opening.u1, whole.v0, opening.v0}, kFront);
        add_front_quad(mesh, {opening.u0, opening.u1, opening.v1, whole.v1}, kFront);
        mesh.tint(0.83F);
        add_reveals(mesh, opening, depth);
        mesh.material(opening.is_lit ? materials.glow : materials.glass).tint(1);
        add_front_quad(mesh, opening, kFront - depth);
        u = opening.u1;
    }
    mesh.material(wall).tint(1);
    add_front_quad(mesh, {u, whole.u1, whole.v0, whole.v1}, kFront);
}

void add_band(MeshBuilder& mesh, float v0, float v1, float reach, RightEnd end) {
    const bool is_corner = end == RightEnd::kCorner;
    const float right = kCityHalf + (is_corner ? reach : 0);
    mesh.open_box(
        {{-kCityHalf, v0, kFront}, {right, v1, kFront + reach}}, is_corner ? "SUDEN" : "SUD"
    );
}

void add_block(MeshBuilder& mesh, float u0, float u1, float v0, float v1, float reach) {
    mesh.open_box({{u0, v0, kFront}, {u1, v1, kFront + reach}}, "SUDEW");
}

void add_window_bars(
    MeshBuilder& mesh,
    const CityMaterials& materials,
    const Opening& opening,
    float depth,
    int columns,
    int rows
) {
    constexpr float kBar = 0.035F;
    const float back = kFront - depth;
    mesh.material(materials.iron).tint(0.89F);
    for (int column = 1; column < columns; ++column) {
        const float u = opening.u0 + (opening.u1 - opening.u0) * static_cast<float>(column) /
                                         static_cast<float>(columns);
        mesh.open_box({{u - kBar, opening.v0, back}, {u + kBar, opening.v1, back + 0.07F}}, "SEW");
    }
    for (int row = 1; row < rows; ++row) {
        const float v = opening.v0 + (opening.v1 - opening.v0) * static_cast<float>(row) /
                                         static_cast<float>(rows);
        mesh.open_box({{opening.u0, v - kBar, back}, {opening.u1, v + kBar, back + 0.05F}}, "SUD");
    }
    mesh.material(materials.stone).tint(0.97F);
    add_block(mesh, opening.u0 - 0.08F, opening.u1 + 0.08F, opening.v0 - 0.1F, opening.v0, 0.1F);
}

MeshBuilder make_side(const std::function<void(MeshBuilder&, RightEnd)>& facade) {
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& part) { facade(part, RightEnd::kGoesOn); });
    return mesh;
}

MeshBuilder make_corner(
    const std::function<void(MeshBuilder&, RightEnd)>& east,
    const std::function<void(MeshBuilder&, RightEnd)>& north
) {
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& part) { east(part, RightEnd::kCorner); });
    mesh.turned(2, [&](MeshBuilder& part) { north(part, RightEnd::kGoesOn); });
    return mesh;
}

}  // namespace modelsynth::examples
