#include "solver/examples/city_blocks.h"

#include "solver/examples/city_facade.h"

#include <algorithm>
#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr float kPierWidth = 0.3F;  // half of a pier; the next cell has the other half
constexpr float kPierReach = 0.12F;
constexpr Opening kWhole = {-kCityHalf, kCityHalf, 0, kCityStorey};

// Piers at both ends of the cell, from v0 to v1.
void add_piers(MeshBuilder& mesh, float v0, float v1, RightEnd end) {
    constexpr float kFront = kCityHalf;
    mesh.open_box(
        {{-kCityHalf, v0, kFront}, {-kCityHalf + kPierWidth, v1, kFront + kPierReach}}, "SEUD"
    );
    const bool is_corner = end == RightEnd::kCorner;
    mesh.open_box(
        {{kCityHalf - kPierWidth, v0, kFront},
         {kCityHalf + (is_corner ? kPierReach : 0), v1, kFront + kPierReach}},
        is_corner ? "SWUDEN" : "SWUD"
    );
}

// What every ground floor has: plinth, piers, the band under the first storey.
void add_ground_frame(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    mesh.material(m.stone).tint(0.79F, 0.79F, 0.82F);
    add_band(mesh, 0, 0.4F, 0.16F, end);
    mesh.material(m.stone).tint(0.96F);
    add_piers(mesh, 0.4F, 2.72F, end);
    mesh.material(m.stone).tint(1);
    add_band(mesh, 2.72F, kCityStorey, 0.2F, end);
}

// Cloth in stripes over a shop window.
void add_awning(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kLeft = -1.6F;
    constexpr int kStripes = 8;
    constexpr float kWidth = 0.4F;
    constexpr Point2 kHigh = {kCityHalf, 2.3F};  // (z, y)
    constexpr Point2 kLow = {kCityHalf + 0.75F, 1.95F};
    for (int stripe = 0; stripe < kStripes; ++stripe) {
        const float u0 = kLeft + kWidth * static_cast<float>(stripe);
        const float u1 = u0 + kWidth;
        mesh.material(stripe % 2 == 0 ? m.accent : m.stone).tint(1);
        mesh.quad(
            {u0, kLow.v, kLow.u},
            {u1, kLow.v, kLow.u},
            {u1, kHigh.v, kHigh.u},
            {u0, kHigh.v, kHigh.u}
        );
        mesh.quad(
            {u0, kLow.v - 0.15F, kLow.u},
            {u1, kLow.v - 0.15F, kLow.u},
            {u1, kLow.v, kLow.u},
            {u0, kLow.v, kLow.u}
        );
        mesh.tint(0.73F);
        mesh.quad(
            {u1, kLow.v, kLow.u},
            {u0, kLow.v, kLow.u},
            {u0, kHigh.v, kHigh.u},
            {u1, kHigh.v, kHigh.u}
        );
        mesh.quad(
            {u1, kLow.v - 0.15F, kLow.u},
            {u0, kLow.v - 0.15F, kLow.u},
            {u0, kLow.v, kLow.u},
            {u1, kLow.v, kLow.u}
        );
    }
}

void add_shop_front(MeshBuilder& mesh, const CityMaterials& m, bool has_awning, RightEnd end) {
    const std::array<Opening, 1> window = {{{-1.5F, 1.5F, 0.55F, 2.2F, true}}};
    add_wall(mesh, m, m.stone, kWhole, window, 0.3F);
    add_window_bars(mesh, m, window[0], 0.3F, 4, 1);
    mesh.material(m.iron).tint(0.83F);  // goods on show
    mesh.open_box({{-1.2F, 0.55F, 1.72F}, {-0.5F, 1.0F, 1.85F}}, "SEWU");
    mesh.open_box({{0.2F, 0.55F, 1.72F}, {0.5F, 1.35F, 1.85F}}, "SEWU");
    mesh.open_box({{0.9F, 0.55F, 1.72F}, {1.3F, 0.85F, 1.85F}}, "SEWU");
    add_ground_frame(mesh, m, end);
    mesh.material(m.accent).tint(0.75F);
    add_block(mesh, -1.62F, 1.62F, 2.34F, 2.66F, 0.07F);
    mesh.material(m.glow).tint(1);
    for (const float u : {-0.9F, -0.3F, 0.3F, 0.9F}) {
        add_block(mesh, u - 0.17F, u + 0.17F, 2.43F, 2.57F, 0.09F);
    }
    if (has_awning) {
        add_awning(mesh, m);
    }
}

void add_door_front(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    const std::array<Opening, 3> openings = {
        {{-1.55F, -0.95F, 0.8F, 2.2F, false},
         {-0.6F, 0.6F, 0.42F, 2.3F, true},
         {0.95F, 1.55F, 0.8F, 2.2F, true}}};
    add_wall(mesh, m, m.stone, kWhole, openings, 0.25F);
    add_window_bars(mesh, m, openings[0], 0.25F, 1, 2);
    add_window_bars(mesh, m, openings[2], 0.25F, 1, 2);
    add_ground_frame(mesh, m, end);
    // Two leaves under a lit fanlight.
    mesh.material(m.accent).tint(0.73F);
    mesh.open_box({{-0.56F, 0.42F, 1.75F}, {-0.03F, 1.85F, 1.83F}}, "SUEW");
    mesh.open_box({{0.03F, 0.42F, 1.75F}, {0.56F, 1.85F, 1.83F}}, "SUEW");
    mesh.material(m.paving).tint(0.95F);
    add_block(mesh, -0.95F, 0.95F, 0, 0.28F, 0.6F);
    add_block(mesh, -0.75F, 0.75F, 0.28F, 0.42F, 0.38F);
    mesh.material(m.stone).tint(0.97F);
    add_block(mesh, -0.82F, -0.6F, 0.42F, 2.34F, 0.14F);
    add_block(mesh, 0.6F, 0.82F, 0.42F, 2.34F, 0.14F);
    mesh.material(m.iron).tint(0.89F);
    add_block(mesh, -0.95F, 0.95F, 2.34F, 2.5F, 0.7F);
    mesh.material(m.glow).tint(1);
    for (const float u : {-0.71F, 0.71F}) {
        mesh.open_box({{u - 0.07F, 1.7F, 2.14F}, {u + 0.07F, 2.0F, 2.28F}}, "SEWUD");
    }
}

void add_storey_frame(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    mesh.material(m.stone).tint(0.96F);
    add_piers(mesh, 0, 2.82F, end);
    mesh.material(m.stone).tint(0.92F);
    add_band(mesh, 2.82F, kCityStorey, 0.16F, end);
}

void add_storey_front(MeshBuilder& mesh, const CityMaterials& m, MaterialId wall, RightEnd end) {
    const std::array<Opening, 2> windows = {
        {{-1.4F, -0.25F, 0.75F, 2.5F, false}, {0.25F, 1.4F, 0.75F, 2.5F, false}}};
    add_wall(mesh, m, wall, kWhole, windows, 0.25F);
    for (const Opening& window : windows) {
        add_window_bars(mesh, m, window, 0.25F, 2, 2);
    }
    // Panels between the storeys draw the eye upwards.
    mesh.material(m.slate).tint(1);
    add_block(mesh, -1.4F, -0.25F, 0.12F, 0.56F, 0.05F);
    add_block(mesh, 0.25F, 1.4F, 0.12F, 0.56F, 0.05F);
    add_storey_frame(mesh, m, end);
}

// Three windows side by side.
void add_loft_front(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    constexpr float kDepth = 0.22F;
    const std::array<Opening, 3> windows = {
        {{-1.5F, -0.62F, 0.7F, 2.45F, false},
         {-0.44F, 0.44F, 0.7F, 2.45F, false},
         {0.62F, 1.5F, 0.7F, 2.45F, false}}};
    add_wall(mesh, m, m.brick, kWhole, windows, kDepth);
    for (const Opening& window : windows) {
        add_window_bars(mesh, m, window, kDepth, 2, 3);
    }
    mesh.material(m.stone).tint(0.89F);
    add_block(mesh, -1.62F, 1.62F, 2.45F, 2.62F, 0.06F);
    mesh.material(m.brick).tint(0.9F);
    add_piers(mesh, 0, 2.82F, end);
    mesh.material(m.brick).tint(0.83F);
    add_band(mesh, 2.82F, kCityStorey, 0.16F, end);
}

// A slab with a railing before the windows of a storey.
void add_balcony(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kReach = 0.75F;
    mesh.material(m.stone).tint(0.95F);
    add_block(mesh, -1.6F, 1.6F, 0.5F, 0.66F, kReach);
    mesh.material(m.iron).tint(1);
    constexpr float kOut = kCityHalf + kReach - 0.05F;
    mesh.box({{-1.6F, 1.42F, kOut - 0.05F}, {1.6F, 1.5F, kOut + 0.02F}});
    for (int bar = 0; bar < 9; ++bar) {
        const float u = -1.56F + 0.39F * static_cast<float>(bar);
        mesh.open_box({{u - 0.025F, 0.66F, kOut - 0.04F}, {u + 0.025F, 1.42F, kOut}}, "EWSN");
    }
    for (const float u : {-1.58F, 1.54F}) {
        mesh.open_box({{u, 1.42F, kCityHalf}, {u + 0.05F, 1.5F, kOut}}, "EWUD");
    }
    mesh.material(m.leaf).tint(0.9F);  // boxes of flowers
    mesh.open_box({{-1.3F, 0.66F, kOut - 0.3F}, {-0.4F, 1.0F, kOut - 0.06F}}, "EWSNU");
    mesh.material(m.tile).tint(1);
    mesh.open_box({{0.5F, 0.66F, kOut - 0.3F}, {1.3F, 0.95F, kOut - 0.06F}}, "EWSNU");
}

// Walls are darker towards the ground.
MeshBuilder shaded_ground(MeshBuilder mesh) {
    mesh.shade_upwards(0.85F, 1.5F);
    return mesh;
}

MeshBuilder shaded_storey(MeshBuilder mesh) {
    mesh.shade([](const Vec3& position, const Vec3& normal) {
        const float under = normal.y < -0.5F ? 0.8F : 1.0F;
        return under * (position.y < 0.05F ? 0.9F : 1.0F);
    });
    return mesh;
}

}  // namespace

MeshBuilder make_shop(const CityMaterials& materials) {
    return shaded_ground(make_side([&](MeshBuilder& mesh, RightEnd end) {
        add_shop_front(mesh, materials, true, end);
    }));
}

MeshBuilder make_shop_corner(const CityMaterials& materials) {
    const auto front = [&](MeshBuilder& mesh, RightEnd end) {
        add_shop_front(mesh, materials, false, end);
    };
    // The way up to the flats is round the corner.
    const auto door = [&](MeshBuilder& mesh, RightEnd end) {
        add_door_front(mesh, materials, end);
    };
    return shaded_ground(make_corner(front, door));
}

MeshBuilder make_core(const CityMaterials& materials) {
    MeshBuilder mesh;
    mesh.material(materials.paving).tint(0.78F);
    mesh.open_box({{-0.8F, 0, -0.8F}, {0.8F, kCityStorey, 0.8F}}, "EWSN");
    return mesh;
}

MeshBuilder make_block_wall(const CityMaterials& materials, MaterialId wall, bool has_balcony) {
    return shaded_storey(make_side([&](MeshBuilder& mesh, RightEnd end) {
        add_storey_front(mesh, materials, wall, end);
        if (has_balcony) {
            add_balcony(mesh, materials);
        }
    }));
}

MeshBuilder make_block_corner(const CityMaterials& materials, MaterialId wall) {
    return shaded_storey(make_corner(
        [&](MeshBuilder& mesh, RightEnd end) { add_storey_front(mesh, materials, wall, end); },
        [&](MeshBuilder& mesh, RightEnd end) { add_storey_front(mesh, materials, wall, end); }
    ));
}

MeshBuilder make_loft_wall(const CityMaterials& materials) {
    return shaded_storey(make_side([&](MeshBuilder& mesh, RightEnd end) {
        add_loft_front(mesh, materials, end);
    }));
}

MeshBuilder make_loft_corner(const CityMaterials& materials) {
    return shaded_storey(make_corner(
        [&](MeshBuilder& mesh, RightEnd end) { add_loft_front(mesh, materials, end); },
        [&](MeshBuilder& mesh, RightEnd end) { add_loft_front(mesh, materials, end); }
    ));
}

}  // namespace modelsynth::examples
