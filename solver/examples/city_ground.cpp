#include "solver/examples/city_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr float kHalf = kCityHalf;
constexpr float kRoadTop = 0.03F;
constexpr float kRoadHalf = 1.4F;
constexpr float kKerbHalf = 1.56F;  // where the kerb stones end
constexpr float kJoint = 0.025F;

void add_flat(MeshBuilder& mesh, float x0, float z0, float x1, float z1, float y) {
    mesh.quad({x0, y, z1}, {x1, y, z1}, {x1, y, z0}, {x0, y, z0});
}

// What closes the sides of the model at its rim.
void add_skirt(MeshBuilder& mesh) {
    mesh.open_box({{-kHalf, 0, -kHalf}, {kHalf, kRoadTop, kHalf}}, "EWSN");
}

void add_kerb(MeshBuilder& mesh, const CityMaterials& m, float x0, float z0, float x1, float z1) {
    mesh.material(m.stone).tint(0.72F, 0.75F, 0.8F);
    mesh.open_box({{x0, 0, z0}, {x1, kPavingTop, z1}}, "EWSNU");
}

void add_slab(MeshBuilder& mesh, const CityMaterials& m, float x0, float z0, float x1, float z1) {
    mesh.material(m.paving).tint(1);
    mesh.open_box({{x0, 0, z0}, {x1, kPavingTop, z1}}, "EWSNU");
}

// The pavement of the corner between the eastern and the northern side.
void add_street_corner(MeshBuilder& mesh, const CityMaterials& m, bool east_arm, bool north_arm) {
    constexpr float k = kRoadHalf;
    constexpr float e = kKerbHalf;
    if (east_arm && north_arm) {
        // Rounded by one cut, so that cars get round.
        add_kerb(mesh, m, k, -kHalf, e, -e);
        add_kerb(mesh, m, k, -e, kHalf, -k);
        add_slab(mesh, m, e, -kHalf, kHalf, -e);
    } else if (east_arm) {
        add_kerb(mesh, m, k, -e, kHalf, -k);
        add_slab(mesh, m, k, -kHalf, kHalf, -e);
    } else if (north_arm) {
        add_kerb(mesh, m, k, -kHalf, e, -k);
        add_slab(mesh, m, e, -kHalf, kHalf, -k);
    } else {
        add_kerb(mesh, m, k, -e, e, -k);
        add_slab(mesh, m, k, -kHalf, kHalf, -e);
        add_slab(mesh, m, e, -e, kHalf, -k);
    }
}

// The pavement along the closed northern side, between the corners: two slabs and a joint.
void add_street_side(MeshBuilder& mesh, const CityMaterials& m) {
    add_kerb(mesh, m, -kRoadHalf, -kKerbHalf, -kJoint / 2, -kRoadHalf);
    add_kerb(mesh, m, kJoint / 2, -kKerbHalf, kRoadHalf, -kRoadHalf);
    add_slab(mesh, m, -kRoadHalf, -kHalf, -kJoint, -kKerbHalf);
    add_slab(mesh, m, kJoint, -kHalf, kRoadHalf, -kKerbHalf);
}

void add_lamp_post(MeshBuilder& mesh, const CityMaterials& m, float x, float z, float reach) {
    mesh.placed({x, kPavingTop, z}, 0, 1, [&](MeshBuilder& post) {
        post.material(m.asphalt).tint(0.75F);
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

void add_car(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.accent).tint(0.8F);
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
    mesh.material(m.accent).tint(0.7F);
    mesh.open_box({{-0.98F, 1.42F, -0.62F}, {0.23F, 1.46F, 0.62F}}, "EWSNU");
    mesh.material(m.asphalt).tint(0.4F);
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
    mesh.material(m.brick).tint(0.45F, 0.5F, 0.5F);
    const std::array<Point2, 4> trunk = {
        {{0.2F * scale, foot},
         {0.12F * scale, foot + 0.5F},
         {0.1F * scale, foot + 2.0F},
         {0, foot + 2.6F}}};
    mesh.lathe(0, 0, trunk, 6);
    mesh.material(m.leaf).tint(0.75F);
    mesh.ball({0.1F, foot + 2.3F * scale, 0.05F}, {1.25F * scale, 0.85F * scale, 1.2F * scale}, 8);
    mesh.tint(1);
    mesh.ball(
        {-0.2F, foot + 3.1F * scale, -0.15F}, {0.95F * scale, 0.8F * scale, 0.95F * scale}, 8
    );
    mesh.tint(0.9F);
    mesh.ball({0.45F, foot + 2.9F * scale, 0.4F}, {0.7F * scale, 0.6F * scale, 0.7F * scale}, 6);
}

void add_puddle(MeshBuilder& mesh, const CityMaterials& m, float x, float z, float y, float size) {
    std::array<Vec3, 9> rim;
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const float angle = 6.283185F * static_cast<float>(i) / static_cast<float>(rim.size());
        const float radius = size * (0.65F + 0.35F * scatter(7, static_cast<std::uint32_t>(i)));
        rim[i] = {x + 1.5F * radius * std::cos(angle), y, z - radius * std::sin(angle)};
    }
    mesh.material(m.glass).tint(1);
    for (std::size_t i = 0; i < rim.size(); ++i) {
        mesh.triangle({x, y, z}, rim[i], rim[(i + 1) % rim.size()]);
    }
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
            seat.material(m.asphalt).tint(0.8F);
            seat.box({{0.85F, kPavingTop, -0.65F}, {1.25F, 0.5F, -0.57F}});
            seat.box({{0.85F, kPavingTop, 0.57F}, {1.25F, 0.5F, 0.65F}});
            seat.material(m.brick).tint(0.8F);
            seat.box({{0.8F, 0.5F, -0.8F}, {1.02F, 0.56F, 0.8F}});
            seat.box({{1.06F, 0.5F, -0.8F}, {1.28F, 0.56F, 0.8F}});
        });
    }
}

void add_grass(MeshBuilder& mesh, const CityMaterials& m, float east, float north) {
    mesh.material(m.leaf).tint(0.62F, 0.7F, 0.55F);
    mesh.open_box({{-kHalf, 0, north}, {east, kPavingTop, kHalf}}, "EWSNU");
    // Tufts.
    mesh.tint(0.75F, 0.85F, 0.6F);
    for (std::uint32_t i = 0; i < 10; ++i) {
        const float x = -1.7F + 3.0F * scatter(11, i);
        const float z = -1.2F + 2.9F * scatter(12, i);
        const float height = kPavingTop + 0.1F + 0.1F * scatter(13, i);
        mesh.triangle(
            {x - 0.07F, kPavingTop, z}, {x + 0.07F, kPavingTop, z + 0.05F}, {x, height, z}
        );
        mesh.triangle(
            {x + 0.07F, kPavingTop, z + 0.05F}, {x - 0.07F, kPavingTop, z}, {x, height, z}
        );
    }
}

constexpr float kHedge = 1.45F;  // where the hedge begins, from the middle
constexpr float kRim = 1.85F;    // where the kerb begins

// Hedge and kerb on the east, each from north to south.
void add_hedge(MeshBuilder& mesh, const CityMaterials& m, const Point2& kerb, const Point2& hedge) {
    constexpr float kInner = kRim - 0.03F;
    mesh.material(m.stone).tint(0.72F, 0.75F, 0.8F);
    mesh.open_box({{kRim, 0, kerb.u}, {kHalf, 0.27F, kerb.v}}, "EWUSN");
    mesh.material(m.leaf).tint(0.8F);
    mesh.open_box({{kHedge, kPavingTop, hedge.u}, {kInner, 0.72F, hedge.v}}, "EWSN");
    mesh.tint(1);
    mesh.open_box({{kHedge, kPavingTop, hedge.u}, {kInner, 0.72F, hedge.v}}, "U");
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

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3& position, const Vec3& normal) {
        const float under = normal.y < -0.3F ? 0.75F : 1.0F;
        return under * (position.y < 0.05F && normal.y < 0.5F ? 0.6F : 1.0F);
    });
    return mesh;
}

}  // namespace

MeshBuilder make_street(const CityMaterials& materials, const StreetArms& arms) {
    MeshBuilder mesh;
    mesh.material(materials.asphalt).tint(1);
    add_flat(mesh, -kHalf, -kHalf, kHalf, kHalf, kRoadTop);
    add_skirt(mesh);
    for (std::size_t side = 0; side < arms.size(); ++side) {
        const bool next_arm = arms[(side + 1) % arms.size()];
        mesh.turned(static_cast<int>(side), [&](MeshBuilder& part) {
            add_street_corner(part, materials, arms[side], next_arm);
        });
        if (!arms[side]) {
            mesh.turned(static_cast<int>(side) + 3, [&](MeshBuilder& part) {
                add_street_side(part, materials);
            });
        }
    }
    if (arms != kArmsStraight) {
        mesh.material(materials.asphalt).tint(0.5F);  // a manhole cover
        const std::array<Point2, 2> cover = {{{0.35F, kRoadTop + 0.015F}, {0, kRoadTop + 0.015F}}};
        mesh.lathe(0.3F, -0.2F, cover, 8);
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_straight(const CityMaterials& materials, StreetPart part) {
    MeshBuilder mesh = make_street(materials, kArmsStraight);
    constexpr float kPaint = kRoadTop + 0.015F;
    switch (part) {
        case StreetPart::kMarking:
            mesh.material(materials.stone).tint(1);
            add_flat(mesh, -1.5F, -0.06F, -0.5F, 0.06F, kPaint);
            add_flat(mesh, 0.9F, -0.06F, 1.9F, 0.06F, kPaint);
            add_puddle(mesh, materials, 0.4F, 0.85F, kPaint, 0.32F);
            break;
        case StreetPart::kLamps:
            add_lamp_post(mesh, materials, 1.9F, 1.78F, -0.5F);
            add_lamp_post(mesh, materials, -1.9F, -1.78F, 0.5F);
            break;
        case StreetPart::kZebra:
            mesh.material(materials.stone).tint(1);
            for (const float z : {-1.1F, -0.55F, 0.0F, 0.55F, 1.1F}) {
                add_flat(mesh, -1.0F, z - 0.14F, 1.0F, z + 0.14F, kPaint);
            }
            break;
        case StreetPart::kCar:
            mesh.placed({0.1F, kRoadTop, 0.45F}, 0, 1, [&](MeshBuilder& car) {
                add_car(car, materials);
            });
            break;
    }
    return mesh;
}

MeshBuilder make_paving(const CityMaterials& materials, PavingPart part) {
    MeshBuilder mesh;
    mesh.material(materials.paving).tint(0.5F);
    mesh.open_box({{-kHalf, 0, -kHalf}, {kHalf, kPavingTop - 0.02F, kHalf}}, "EWSNU");
    const bool has_pit = part == PavingPart::kTree;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const auto index = static_cast<std::uint32_t>(row * 4 + column);
            if (has_pit && row % 3 != 0 && column % 3 != 0) {
                continue;
            }
            const float x = -kHalf + static_cast<float>(column);
            const float z = -kHalf + static_cast<float>(row);
            mesh.tint(0.86F + 0.14F * scatter(3, index));
            add_flat(mesh, x + kJoint, z + kJoint, x + 1 - kJoint, z + 1 - kJoint, kPavingTop);
        }
    }
    switch (part) {
        case PavingPart::kNone:
            break;
        case PavingPart::kLamp:
            add_lamp_post(mesh, materials, 0, 0, 0.5F);
            break;
        case PavingPart::kTree:
            mesh.material(materials.asphalt).tint(0.6F);
            mesh.open_box({{-0.85F, 0.1F, -0.85F}, {0.85F, kPavingTop + 0.03F, 0.85F}}, "EWSNU");
            add_tree(mesh, materials, kPavingTop, 0.95F);
            break;
        case PavingPart::kBench:
            add_bench(mesh, materials);
            break;
        case PavingPart::kPuddle:
            add_puddle(mesh, materials, 0.2F, 0.3F, kPavingTop + 0.012F, 0.9F);
            break;
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_lawn(const CityMaterials& materials, LawnPart part) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kHalf, -kHalf);
    switch (part) {
        case LawnPart::kNone:
            break;
        case LawnPart::kTree:
            add_tree(mesh, materials, kPavingTop, 1.25F);
            break;
        case LawnPart::kShrubs:
            mesh.material(materials.leaf).tint(0.8F);
            mesh.ball({-0.7F, 0.45F, 0.5F}, {0.75F, 0.6F, 0.7F}, 8);
            mesh.tint(1);
            mesh.ball({0.6F, 0.4F, -0.6F}, {0.6F, 0.5F, 0.65F}, 8);
            mesh.material(materials.brick).tint(1);
            mesh.ball({0.5F, 0.3F, 0.7F}, {0.4F, 0.3F, 0.4F}, 6);
            break;
        case LawnPart::kFountain:
            add_fountain(mesh, materials);
            break;
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_lawn_edge(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kRim, -kHalf);
    add_hedge(mesh, materials, {-kHalf, kHalf}, {-kHalf, kHalf});
    return shaded(std::move(mesh));
}

MeshBuilder make_lawn_corner(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kRim, -kRim);
    add_hedge(mesh, materials, {-kHalf, kHalf}, {-kRim + 0.03F, kHalf});
    mesh.turned(1, [&](MeshBuilder& north) {
        add_hedge(north, materials, {-kHalf, kRim}, {-kHalf, kHedge});
    });
    return shaded(std::move(mesh));
}

}  // namespace modelsynth::examples
