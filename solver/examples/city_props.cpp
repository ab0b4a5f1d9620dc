#include "solver/examples/city_props.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace modelsynth::examples {

void add_lamp_post(MeshBuilder& mesh, const CityMaterials& m, float x, float z, float reach) {
    mesh.placed({x, kPavingTop, z}, 0, 1, [&](MeshBuilder& post) {
        post.material(m.iron).tint(0.75F);
        const std::array<Point2, 6> profile = {
            {{0.13F, 0}, {0.11F, 0.3F}, {0.06F, 0.45F}, {0.05F, 3.4F}, {0.07F, 3.45F}, {0, 3.5F}}};
        post.lathe(0, 0, profile, 7);
        const float z0 = std::min(0.0F, reach);
        const float z1 = std::max(0.0F, reach);
        post.box({{-0.035F, 3.4F, z0}, {0.035F, 3.47F, z1}});
        post.open_box({{-0.2F, 3.34F, reach - 0.2F}, {0.2F, 3.44F, reach + 0.2F}}, "EWSNU");
        post.material(m.glow).tint(1);
        post.open_box({{-0.15F, 3.12F, reach - 0.15F}, {0.15F, 3.34F, reach + 0.15F}}, "EWSND");
    });
}

void add_car(MeshBuilder& mesh, const CityMaterials& m, MaterialId paint) {
    mesh.material(paint).tint(1);
    const std::array<Point2, 8> body = {
        {{-1.7F, 0.3F},
         {1.7F, 0.3F},
         {1.75F, 0.65F},
         {1.65F, 0.85F},
         {0.75F, 0.95F},
         {-1.5F, 0.95F},
         {-1.72F, 0.85F},
         {-1.75F, 0.5F}}};
    mesh.extrude(body, -0.72F, 0.72F);
    mesh.material(m.glass).tint(1);
    const std::array<Point2, 4> cabin = {
        {{-1.3F, 0.95F}, {0.75F, 0.95F}, {0.25F, 1.42F}, {-1.0F, 1.42F}}};
    mesh.extrude(cabin, -0.64F, 0.64F);
    mesh.material(paint).tint(1);
    mesh.open_box({{-0.98F, 1.42F, -0.62F}, {0.23F, 1.46F, 0.62F}}, "EWSNU");
    mesh.material(m.iron).tint(0.4F);
    for (const float x : {-1.1F, 1.1F}) {
        for (const float z : {-0.76F, 0.6F}) {
            std::array<Point2, 8> wheel;
            for (std::size_t i = 0; i < wheel.size(); ++i) {
                const float angle = 0.785398F * static_cast<float>(i);
                wheel[i] = {x + 0.3F * std::cos(angle), 0.33F + 0.3F * std::sin(angle)};
            }
            mesh.extrude(wheel, z, z + 0.16F);
        }
    }
    mesh.material(m.glow).tint(1);
    mesh.box({{1.7F, 0.6F, -0.6F}, {1.76F, 0.75F, -0.35F}});
    mesh.box({{1.7F, 0.6F, 0.35F}, {1.76F, 0.75F, 0.6F}});
}

void add_tree(MeshBuilder& mesh, const CityMaterials& m, float foot, float scale) {
    mesh.material(m.wood).tint(0.9F);
    const std::array<Point2, 4> trunk = {
        {{0.2F * scale, foot},
         {0.12F * scale, foot + 0.5F},
         {0.1F * scale, foot + 2.0F},
         {0, foot + 2.6F}}};
    mesh.lathe(0, 0, trunk, 6);
    mesh.material(m.leaf).tint(0.85F);
    mesh.ball({0.1F, foot + 2.3F * scale, 0.05F}, {1.25F * scale, 0.85F * scale, 1.2F * scale}, 8);
    mesh.tint(1);
    mesh.ball(
        {-0.2F, foot + 3.1F * scale, -0.15F}, {0.95F * scale, 0.8F * scale, 0.95F * scale}, 8
    );
    mesh.tint(0.9F);
    mesh.ball({0.45F, foot + 2.9F * scale, 0.4F}, {0.7F * scale, 0.6F * scale, 0.7F * scale}, 6);
}

void add_bench(MeshBuilder& mesh, const CityMaterials& m) {
    // A stone tub with a shrub between two seats.
    mesh.material(m.stone).tint(0.8F);
    mesh.bevelled_box({{-0.7F, kPavingTop, -0.7F}, {0.7F, 0.75F, 0.7F}}, 0.05F);
    mesh.material(m.leaf).tint(0.85F);
    mesh.ball({0, 0.95F, 0}, {0.62F, 0.5F, 0.62F}, 8);
    mesh.tint(1);
    mesh.ball({0.15F, 1.3F, 0.1F}, {0.4F, 0.4F, 0.4F}, 6);
    for (const int turns : {0, 2}) {
        mesh.turned(turns, [&](MeshBuilder& seat) {
            seat.material(m.iron).tint(0.8F);
            seat.box({{0.85F, kPavingTop, -0.65F}, {1.25F, 0.5F, -0.57F}});
            seat.box({{0.85F, kPavingTop, 0.57F}, {1.25F, 0.5F, 0.65F}});
            seat.material(m.wood).tint(1);
            seat.box({{0.8F, 0.5F, -0.8F}, {1.02F, 0.56F, 0.8F}});
            seat.box({{1.06F, 0.5F, -0.8F}, {1.28F, 0.56F, 0.8F}});
        });
    }
}

void add_fountain(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.stone).tint(0.9F);
    const std::array<Point2, 6> basin = {
        {{1.55F, 0.1F},
         {1.6F, 0.5F},
         {1.68F, 0.55F},
         {1.65F, 0.65F},
         {1.4F, 0.65F},
         {1.35F, 0.4F}}};
    mesh.lathe(0, 0, basin, 12, false);
    const std::array<Point2, 7> bowl = {
        {{0.3F, 0.3F},
         {0.2F, 0.6F},
         {0.2F, 1.2F},
         {0.75F, 1.45F},
         {0.78F, 1.55F},
         {0.65F, 1.55F},
         {0, 1.45F}}};
    mesh.lathe(0, 0, bowl, 10);
    const std::array<Point2, 4> figure = {{{0.15F, 1.45F}, {0.12F, 1.9F}, {0.2F, 2.2F}, {0, 2.5F}}};
    mesh.lathe(0, 0, figure, 8);
    mesh.material(m.glass).tint(1);
    const std::array<Point2, 2> water = {{{1.42F, 0.52F}, {0, 0.52F}}};
    mesh.lathe(0, 0, water, 12);
}

void add_table(MeshBuilder& mesh, const CityMaterials& m, float x, float z) {
    mesh.placed({x, kPavingTop, z}, 0, 1, [&](MeshBuilder& part) {
        part.material(m.iron).tint(1);
        part.cylinder(0, 0, 0.05F, 0, 2.2F, 5);
        part.material(m.plaster).tint(1);
        part.cylinder(0, 0, 0.38F, 0.68F, 0.74F, 8);
        part.material(m.accent).tint(1);
        part.cone(0, 0, 1.0F, 1.95F, 2.4F, 8);
        part.material(m.wood).tint(1);
        for (const float side : {-0.72F, 0.72F}) {
            part.open_box({{side - 0.17F, 0, -0.17F}, {side + 0.17F, 0.42F, 0.17F}}, "EWSNU");
        }
    });
}

void add_stall(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kStripe = 0.5F;
    mesh.material(m.wood).tint(1);
    mesh.open_box({{-1.25F, kPavingTop, -0.7F}, {1.25F, 0.95F, 0.7F}}, "EWSNU");
    mesh.material(m.leaf).tint(1);
    mesh.open_box({{-1.15F, 0.95F, -0.6F}, {-0.4F, 1.1F, 0.6F}}, "EWSNU");
    mesh.material(m.tile).tint(1);
    mesh.open_box({{-0.35F, 0.95F, -0.6F}, {0.4F, 1.14F, 0.6F}}, "EWSNU");
    mesh.material(m.glow).tint(1);
    mesh.open_box({{0.45F, 0.95F, -0.6F}, {1.15F, 1.08F, 0.6F}}, "EWSNU");
    mesh.material(m.iron).tint(1);
    for (const float x : {-1.3F, 1.3F}) {
        for (const float z : {-0.85F, 0.85F}) {
            mesh.open_box(
                {{x - 0.05F, kPavingTop, z - 0.05F}, {x + 0.05F, 2.2F, z + 0.05F}}, "EWSN"
            );
        }
    }
    for (int stripe = 0; stripe < 6; ++stripe) {
        const float x0 = -1.5F + kStripe * static_cast<float>(stripe);
        mesh.material(stripe % 2 == 0 ? m.accent : m.plaster).tint(1);
        const float x1 = x0 + kStripe;
        for (const float side : {-1.0F, 1.0F}) {
            const Vec3 low0 = {x0, 2.15F, side * 1.05F};
            const Vec3 low1 = {x1, 2.15F, side * 1.05F};
            const Vec3 high0 = {x0, 2.75F, 0};
            const Vec3 high1 = {x1, 2.75F, 0};
            // Cloth is seen from above and from below.
            mesh.quad(low0, low1, high1, high0);
            mesh.quad(low1, low0, high0, high1);
        }
    }
}

}  // namespace modelsynth::examples
