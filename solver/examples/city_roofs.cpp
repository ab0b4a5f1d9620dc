#include "solver/examples/city_roofs.h"

#include "solver/examples/city_facade.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr float kRoofTop = 0.1F;

void add_roof_floor(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.tile).tint(0.79F);
    mesh.open_box({{-kCityHalf, 0, -kCityHalf}, {kCityHalf, kRoofTop, kCityHalf}}, "U");
    mesh.tint(0.89F);
    mesh.open_box({{-kCityHalf, 0, -0.03F}, {kCityHalf, kRoofTop + 0.03F, 0.03F}}, "USN");
}

void add_parapet(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    constexpr float kThick = 0.3F;
    constexpr float kTop = 0.85F;
    mesh.material(m.stone).tint(0.92F);
    add_band(mesh, 0, 0.22F, 0.3F, end);
    mesh.tint(1);
    const float right = kCityHalf;
    mesh.open_box({{-kCityHalf, 0, kCityHalf - kThick}, {right, kTop, kCityHalf}}, "SNEW");
    // A coping, and a raised middle that breaks the line against the sky.
    mesh.material(m.paving).tint(0.89F);
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
    mesh.material(m.iron).tint(0.89F);
    for (const float x : {-0.75F, 0.75F}) {
        for (const float z : {-0.75F, 0.75F}) {
            mesh.open_box({{x - 0.08F, kRoofTop, z - 0.08F}, {x + 0.08F, 1.3F, z + 0.08F}}, "EWSN");
        }
    }
    mesh.box({{-1.05F, 1.2F, -1.05F}, {1.05F, 1.35F, 1.05F}});
    mesh.material(m.brick).tint(0.86F);
    mesh.cylinder(0, 0, 1.0F, 1.35F, 3.1F, 12);
    mesh.material(m.iron).tint(0.83F);
    for (const float y : {1.7F, 2.6F}) {
        const std::array<Point2, 2> hoop = {{{1.03F, y}, {1.03F, y + 0.1F}}};
        mesh.lathe(0, 0, hoop, 12);
    }
    mesh.material(m.tile).tint(1);
    mesh.cone(0, 0, 1.2F, 3.1F, 3.9F, 12);
}

// Lawn, a pergola and a seat up in the sun.
void add_roof_garden(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.brick).tint(1, 0.85F, 0.7F);
    mesh.open_box({{-1.5F, kRoofTop, -1.5F}, {1.5F, 0.3F, 1.5F}}, "EWSNU");
    mesh.material(m.leaf).tint(1);
    mesh.open_box({{-1.4F, 0.3F, -1.4F}, {0.1F, 0.36F, 1.4F}}, "EWSNU");
    mesh.tint(0.8F);
    mesh.ball({-0.7F, 0.75F, -0.6F}, {0.6F, 0.55F, 0.6F}, 7);
    mesh.ball({-0.8F, 0.55F, 0.7F}, {0.4F, 0.4F, 0.4F}, 6);
    mesh.material(m.plaster).tint(1);
    for (const float x : {0.35F, 1.3F}) {
        for (const float z : {-1.2F, 1.2F}) {
            mesh.open_box({{x - 0.06F, 0.3F, z - 0.06F}, {x + 0.06F, 2.2F, z + 0.06F}}, "EWSN");
        }
        mesh.box({{x - 0.06F, 2.2F, -1.45F}, {x + 0.06F, 2.32F, 1.45F}});
    }
    for (const float z : {-1.2F, -0.6F, 0.0F, 0.6F, 1.2F}) {
        mesh.box({{0.1F, 2.32F, z - 0.05F}, {1.55F, 2.4F, z + 0.05F}});
    }
    mesh.material(m.accent).tint(1);
    mesh.open_box({{0.5F, 0.3F, -0.5F}, {1.1F, 0.65F, 0.5F}}, "EWSNU");
}

void add_roof_light(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.tile).tint(0.95F);
    mesh.open_box({{-1.3F, kRoofTop, -0.9F}, {1.3F, 0.5F, 0.9F}}, "EWSN");
    mesh.material(m.glow).tint(1);
    mesh.quad({-1.3F, 0.5F, 0.9F}, {1.3F, 0.5F, 0.9F}, {1.3F, 1.0F, 0}, {-1.3F, 1.0F, 0});
    mesh.quad({1.3F, 0.5F, -0.9F}, {-1.3F, 0.5F, -0.9F}, {-1.3F, 1.0F, 0}, {1.3F, 1.0F, 0});
    mesh.triangle({1.3F, 0.5F, 0.9F}, {1.3F, 0.5F, -0.9F}, {1.3F, 1.0F, 0});
    mesh.triangle({-1.3F, 0.5F, -0.9F}, {-1.3F, 0.5F, 0.9F}, {-1.3F, 1.0F, 0});
    mesh.material(m.iron).tint(0.89F);
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
    mesh.material(m.brick).tint(0.92F);
    mesh.bevelled_box({{-1.3F, kRoofTop, -1.2F}, {-0.3F, 2.1F, -0.5F}}, 0.04F);
    mesh.material(m.stone).tint(0.89F);
    mesh.bevelled_box({{-1.38F, 2.1F, -1.28F}, {-0.22F, 2.25F, -0.42F}}, 0.04F);
    mesh.material(m.iron).tint(0.95F);
    mesh.cylinder(-1.05F, -0.85F, 0.14F, 2.25F, 2.6F, 8);
    mesh.cylinder(-0.55F, -0.85F, 0.14F, 2.25F, 2.75F, 8);
    mesh.material(m.paving).tint(0.86F);
    mesh.bevelled_box({{0.35F, kRoofTop, -0.9F}, {1.35F, 0.85F, 0.2F}}, 0.05F);
    mesh.material(m.iron).tint(0.78F);
    mesh.cylinder(0.85F, -0.35F, 0.35F, 0.85F, 0.95F, 8);
}

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3&, const Vec3& normal) { return normal.y < -0.5F ? 0.8F : 1.0F; });
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
        case RoofPart::kGarden:
            add_roof_garden(mesh, materials);
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

MeshBuilder make_parapet_corner(const CityMaterials& materials) {
    const auto parapet = [&](MeshBuilder& mesh, RightEnd end) {
        add_parapet(mesh, materials, end);
    };
    MeshBuilder mesh = make_corner(parapet, parapet);
    // A finial marks the corner.
    mesh.material(materials.stone).tint(0.97F);
    mesh.bevelled_box({{1.55F, 0.95F, -2.0F}, {2.0F, 1.3F, -1.55F}}, 0.05F);
    mesh.material(materials.tile).tint(1);
    mesh.hip_roof({{1.55F, 1.3F, -2.0F}, {2.0F, 1.8F, -1.55F}}, 0.06F);
    add_roof_floor(mesh, materials);
    return shaded(std::move(mesh));
}

}  // namespace modelsynth::examples
