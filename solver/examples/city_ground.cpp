#include "solver/examples/city_ground.h"

#include "solver/examples/city_props.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr float kHalf = kCityHalf;
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
    mesh.material(m.stone).tint(0.85F, 0.86F, 0.89F);
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

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3& position, const Vec3& normal) {
        const float under = normal.y < -0.3F ? 0.85F : 1.0F;
        return under * (position.y < 0.05F && normal.y < 0.5F ? 0.8F : 1.0F);
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
        mesh.material(materials.asphalt).tint(0.73F);  // a manhole cover
        const std::array<Point2, 2> cover = {{{0.35F, kRoadTop + 0.015F}, {0, kRoadTop + 0.015F}}};
        mesh.lathe(0.3F, -0.2F, cover, 8);
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_straight(const CityMaterials& materials, StreetPart part) {
    MeshBuilder mesh = make_street(materials, kArmsStraight);
    constexpr float kPaint = kRoadTop + 0.015F;
    const auto paint_line = [&](float x0, float x1) {
        mesh.material(materials.plaster).tint(1);
        add_flat(mesh, x0, -0.06F, x1, 0.06F, kPaint);
    };
    switch (part) {
        case StreetPart::kMarking:
            paint_line(-1.5F, -0.5F);
            paint_line(0.5F, 1.5F);
            break;
        case StreetPart::kLamps:
            paint_line(-1.5F, -0.5F);
            paint_line(0.5F, 1.5F);
            add_lamp_post(mesh, materials, 1.2F, 1.76F, -0.5F);
            add_lamp_post(mesh, materials, -1.2F, -1.76F, 0.5F);
            break;
        case StreetPart::kZebra:
            mesh.material(materials.plaster).tint(1);
            for (const float z : {-1.1F, -0.55F, 0.0F, 0.55F, 1.1F}) {
                add_flat(mesh, 0.3F, z - 0.15F, 1.7F, z + 0.15F, kPaint);
            }
            add_flat(mesh, -0.3F, 0.08F, -0.1F, 1.3F, kPaint);  // where cars stop
            break;
        case StreetPart::kCar:
            paint_line(-1.5F, -0.5F);
            paint_line(0.5F, 1.5F);
            mesh.placed({0.1F, kRoadTop, 0.72F}, 0, 0.8F, [&](MeshBuilder& car) {
                add_car(car, materials, materials.accent);
            });
            mesh.placed({-0.2F, kRoadTop, -0.72F}, 3.14159265F, 0.8F, [&](MeshBuilder& car) {
                add_car(car, materials, materials.glow);
            });
            break;
    }
    return mesh;
}

MeshBuilder make_street_end(const CityMaterials& materials) {
    MeshBuilder mesh = make_street(materials, kArmsEnd);
    mesh.material(materials.paving).tint(0.95F);
    mesh.open_box({{-kRoadHalf, 0, -kRoadHalf}, {-0.2F, kPavingTop, kRoadHalf}}, "EWSNU");
    mesh.material(materials.iron).tint(1);
    for (const float z : {-1.0F, -0.35F, 0.35F, 1.0F}) {
        mesh.cylinder(-0.5F, z, 0.09F, kPavingTop, 0.85F, 6);
    }
    return mesh;
}

}  // namespace modelsynth::examples
