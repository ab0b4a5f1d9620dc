#include "solver/examples/city_roofs.h"

#include "solver/examples/city_facade.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr float kRoofTop = 0.1F;

void add_roof_floor(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.slate).tint(0.62F);
    mesh.open_box({{-kCityHalf, 0, -kCityHalf}, {kCityHalf, kRoofTop, kCityHalf}}, "U");
    mesh.tint(0.8F);
    mesh.open_box({{-kCityHalf, 0, -0.03F}, {kCityHalf, kRoofTop + 0.03F, 0.03F}}, "USN");
}

void add_parapet(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    constexpr float kThick = 0.3F;
    constexpr float kTop = 0.85F;
    mesh.material(m.stone).tint(0.85F);
    add_band(mesh, 0, 0.22F, 0.3F, end);
    mesh.tint(1);
    const float right = kCityHalf;
    mesh.open_box({{-kCityHalf, 0, kCityHalf - kThick}, {right, kTop, kCityHalf}}, "SNEW");
    // A coping, and a raised middle that breaks the line against the sky.
    mesh.material(m.paving).tint(0.8F);
    mesh.open_box(
        {{-kCityHalf, kTop, kCityHalf - kThick - 0.05F},
         {right + (end == RightEnd::kCorner ? 0.06F : 0.0F), kTop + 0.1F, kCityHalf + 0.06F}},
        "SNUDEW"
    );
    mesh.material(m.stone).tint(1);
    mesh.bevelled_box(
        {{-0.8F, kTop + 0.1F, kCityHalf - kThick}, {0.8F, kTop + 0.4F, kCityHalf}}, 0.06F
    );
    for (const float u : {-1.5F, -0.5F, 0.5F, 1.5F}) {  // brackets under the cornice
        add_block(mesh, u - 0.1F, u + 0.1F, -0.18F, 0, 0.24F);
    }
}

// A water tank on legs.
void add_tank(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.asphalt).tint(0.8F);
    for (const float x : {-0.75F, 0.75F}) {
        for (const float z : {-0.75F, 0.75F}) {
            mesh.open_box({{x - 0.08F, kRoofTop, z - 0.08F}, {x + 0.08F, 1.3F, z + 0.08F}}, "EWSN");
        }
    }
    mesh.box({{-1.05F, 1.2F, -1.05F}, {1.05F, 1.35F, 1.05F}});
    mesh.material(m.brick).tint(0.75F);
    mesh.cylinder(0, 0, 1.0F, 1.35F, 3.1F, 12);
    mesh.material(m.asphalt).tint(0.7F);
    for (const float y : {1.7F, 2.6F}) {
        const std::array<Point2, 2> hoop = {{{1.03F, y}, {1.03F, y + 0.1F}}};
        mesh.lathe(0, 0, hoop, 12);
    }
    mesh.material(m.slate).tint(1);
    mesh.cone(0, 0, 1.2F, 3.1F, 3.9F, 12);
}

void add_mast(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.stone).tint(0.75F);
    mesh.bevelled_box({{-1.1F, kRoofTop, -0.9F}, {1.1F, 1.9F, 0.9F}}, 0.06F);
    mesh.material(m.slate).tint(0.9F);
    mesh.bevelled_box({{-1.25F, 1.9F, -1.05F}, {1.25F, 2.05F, 1.05F}}, 0.05F);
    mesh.material(m.accent).tint(0.5F);
    mesh.open_box({{-0.4F, kRoofTop, 0.9F}, {0.4F, 1.6F, 0.94F}}, "SEWU");
    mesh.material(m.asphalt).tint(0.9F);
    const std::array<Point2, 4> pole = {{{0.09F, 2.05F}, {0.07F, 3.6F}, {0.03F, 5.6F}, {0, 5.7F}}};
    mesh.lathe(0.5F, 0, pole, 6);
    for (const float y : {3.4F, 4.2F, 4.9F}) {
        mesh.box({{0.5F - 0.55F, y, -0.03F}, {0.5F + 0.55F, y + 0.06F, 0.03F}});
    }
    mesh.material(m.glow).tint(1);
    mesh.ball({0.5F, 5.72F, 0}, {0.1F, 0.1F, 0.1F}, 6);
}

void add_roof_light(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.slate).tint(0.9F);
    mesh.open_box({{-1.3F, kRoofTop, -0.9F}, {1.3F, 0.5F, 0.9F}}, "EWSN");
    mesh.material(m.glow).tint(1);
    mesh.quad({-1.3F, 0.5F, 0.9F}, {1.3F, 0.5F, 0.9F}, {1.3F, 1.0F, 0}, {-1.3F, 1.0F, 0});
    mesh.quad({1.3F, 0.5F, -0.9F}, {-1.3F, 0.5F, -0.9F}, {-1.3F, 1.0F, 0}, {1.3F, 1.0F, 0});
    mesh.triangle({1.3F, 0.5F, 0.9F}, {1.3F, 0.5F, -0.9F}, {1.3F, 1.0F, 0});
    mesh.triangle({-1.3F, 0.5F, -0.9F}, {-1.3F, 0.5F, 0.9F}, {-1.3F, 1.0F, 0});
    mesh.material(m.asphalt).tint(0.8F);
    for (const float x : {-1.3F, -0.43F, 0.43F, 1.3F}) {
        mesh.open_box({{x - 0.04F, 0.95F, -0.06F}, {x + 0.04F, 1.05F, 0.06F}}, "EWSNU");
        mesh.quad(
            {x - 0.04F, 0.52F, 0.92F},
            {x + 0.04F, 0.52F, 0.92F},
            {x + 0.04F, 1.03F, 0.02F},
            {x - 0.04F, 1.03F, 0.02F}
        );
        mesh.quad(
            {x + 0.04F, 0.52F, -0.92F},
            {x - 0.04F, 0.52F, -0.92F},
            {x - 0.04F, 1.03F, -0.02F},
            {x + 0.04F, 1.03F, -0.02F}
        );
    }
}

// Chimney stacks and an air duct behind a parapet, built for the south side.
void add_stack(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.brick).tint(0.85F);
    mesh.bevelled_box({{-1.3F, kRoofTop, -1.2F}, {-0.3F, 2.1F, -0.5F}}, 0.04F);
    mesh.material(m.stone).tint(0.8F);
    mesh.bevelled_box({{-1.38F, 2.1F, -1.28F}, {-0.22F, 2.25F, -0.42F}}, 0.04F);
    mesh.material(m.asphalt).tint(0.9F);
    mesh.cylinder(-1.05F, -0.85F, 0.14F, 2.25F, 2.6F, 8);
    mesh.cylinder(-0.55F, -0.85F, 0.14F, 2.25F, 2.75F, 8);
    mesh.material(m.paving).tint(0.75F);
    mesh.bevelled_box({{0.35F, kRoofTop, -0.9F}, {1.35F, 0.85F, 0.2F}}, 0.05F);
    mesh.material(m.asphalt).tint(0.6F);
    mesh.cylinder(0.85F, -0.35F, 0.35F, 0.85F, 0.95F, 8);
}

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3&, const Vec3& normal) { return normal.y < -0.5F ? 0.65F : 1.0F; });
    return mesh;
}

}  // namespace

MeshBuilder make_flat_roof(const CityMaterials& materials, RoofPart part) {
    MeshBuilder mesh;
    add_roof_floor(mesh, materials);
    switch (part) {
        case RoofPart::kNone:
            break;
        case RoofPart::kTank:
            add_tank(mesh, materials);
            break;
        case RoofPart::kMast:
            add_mast(mesh, materials);
            break;
        case RoofPart::kLight:
            add_roof_light(mesh, materials);
            break;
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_parapet(const CityMaterials& materials, bool has_stack) {
    MeshBuilder mesh = make_side([&](MeshBuilder& part, RightEnd end) {
        add_parapet(part, materials, end);
        if (has_stack) {
            add_stack(part, materials);
        }
    });
    add_roof_floor(mesh, materials);
    return shaded(std::move(mesh));
}

MeshBuilder make_parapet_corner(const CityMaterials& materials, bool has_tank) {
    const auto parapet = [&](MeshBuilder& mesh, RightEnd end) {
        add_parapet(mesh, materials, end);
    };
    MeshBuilder mesh = make_corner(parapet, parapet);
    // A finial marks the corner.
    mesh.material(materials.stone).tint(0.95F);
    mesh.bevelled_box({{1.55F, 0.95F, -2.0F}, {2.0F, 1.3F, -1.55F}}, 0.05F);
    mesh.material(materials.slate).tint(1);
    mesh.hip_roof({{1.55F, 1.3F, -2.0F}, {2.0F, 1.8F, -1.55F}}, 0.06F);
    add_roof_floor(mesh, materials);
    if (has_tank) {
        mesh.placed({-0.35F, 0, 0.35F}, 0, 1, [&](MeshBuilder& part) {
            add_tank(part, materials);
        });
    }
    return shaded(std::move(mesh));
}

}  // namespace modelsynth::examples
