#include "solver/examples/city_roofs.h"

#include "solver/examples/city_facade.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

// The flat middle of a roof, and the slopes up to it, built for the south side.
constexpr float kDeck = 1.7F;
constexpr float kEaves = kCityHalf + 0.14F;  // z of the slope's foot ...
constexpr float kEavesTop = 0.24F;
constexpr float kEdge = 0.85F;  // ... and of its head
// What stands on the deck is built on a floor at 0.
constexpr float kRoofTop = 0;

void add_deck(MeshBuilder& mesh, const CityMaterials& m, float x1, float z0, float x0, float z1) {
    mesh.material(m.paving).tint(1, 0.97F, 0.95F);
    mesh.quad({x0, kDeck, z1}, {x1, kDeck, z1}, {x1, kDeck, z0}, {x0, kDeck, z0});
}

// Whether a slope goes on at either end or meets another over a corner.
struct Mitres {
    bool left = false;
    bool right = false;
};

void add_slope(MeshBuilder& mesh, const CityMaterials& m, MaterialId cover, const Mitres& mitres) {
    const auto end = [](bool is_mitred, float z) { return is_mitred ? z : kCityHalf; };
    // Cornice and gutter.
    mesh.material(m.stone).tint(1);
    const float left = -end(mitres.left, kCityHalf + 0.3F);
    const float right = end(mitres.right, kCityHalf + 0.3F);
    mesh.open_box({{left, 0, kCityHalf}, {right, kEavesTop, kCityHalf + 0.3F}}, "SUDEW");
    constexpr int kCourses = 4;
    mesh.material(cover);
    for (int course = 0; course < kCourses; ++course) {
        const auto at = [](int row) {
            const float t = static_cast<float>(row) / kCourses;
            return Point2{kEaves + (kEdge - kEaves) * t, kEavesTop + (kDeck - kEavesTop) * t};
        };
        const Point2 low = at(course);
        const Point2 high = at(course + 1);
        mesh.tint(course % 2 == 0 ? 1.0F : 0.9F);
        mesh.quad(
            {-end(mitres.left, low.u), low.v, low.u},
            {end(mitres.right, low.u), low.v, low.u},
            {end(mitres.right, high.u), high.v, high.u},
            {-end(mitres.left, high.u), high.v, high.u}
        );
    }
    mesh.material(m.stone).tint(1);  // a rim round the deck
    mesh.open_box(
        {{-end(mitres.left, kEdge + 0.08F), kDeck - 0.06F, kEdge - 0.14F},
         {end(mitres.right, kEdge + 0.08F), kDeck + 0.16F, kEdge + 0.08F}},
        "SNUDEW"
    );
}

// A window under a small gable, standing in the slope.
void add_roof_window(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kFront = 1.85F;
    constexpr float kBack = 0.7F;
    mesh.material(m.stone).tint(1);
    mesh.open_box({{-0.62F, kEavesTop, kBack}, {0.62F, 1.55F, kFront}}, "EWS");
    mesh.triangle({-0.62F, 1.55F, kFront}, {0.62F, 1.55F, kFront}, {0, 2.05F, kFront});
    mesh.material(m.glass).tint(1);
    mesh.open_box({{-0.38F, 0.5F, kFront}, {0.38F, 1.45F, kFront + 0.02F}}, "S");
    mesh.material(m.plaster).tint(1);
    mesh.open_box({{-0.03F, 0.5F, kFront}, {0.03F, 1.45F, kFront + 0.05F}}, "SEW");
    mesh.open_box({{-0.38F, 0.95F, kFront}, {0.38F, 1.01F, kFront + 0.05F}}, "SUD");
    mesh.open_box({{-0.5F, 0.4F, kFront}, {0.5F, 0.5F, kFront + 0.1F}}, "SUDEW");
    const auto half = [&](MeshBuilder& part) {
        constexpr float kOut = 0.8F;
        constexpr float kFall = 1.5F;
        constexpr float kTop = 2.15F;
        constexpr float kVerge = kFront + 0.14F;
        part.material(m.slate).tint(0.95F);
        part.quad({kOut, kFall, kVerge}, {kOut, kFall, kBack}, {0, kTop, kBack}, {0, kTop, kVerge});
        part.material(m.stone).tint(0.95F);
        part.quad(
            {kOut, kFall - 0.1F, kVerge},
            {kOut, kFall, kVerge},
            {0, kTop, kVerge},
            {0, kTop - 0.12F, kVerge}
        );
        part.tint(0.75F);
        part.quad(
            {0, kTop - 0.12F, kVerge},
            {0, kTop - 0.12F, kBack},
            {kOut, kFall - 0.1F, kBack},
            {kOut, kFall - 0.1F, kVerge}
        );
        part.triangle({0, kTop, kBack}, {kOut, kFall, kBack}, {0, kFall, kBack});
    };
    half(mesh);
    mesh.mirrored(half);
}

// A tiled pavilion over the whole cell, with a lantern on top.
void add_cupola(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kEave = 1.85F;
    constexpr float kRoofFoot = 0.5F;
    constexpr float kNeck = 0.45F;
    constexpr float kShoulder = 2.1F;
    mesh.material(m.stone).tint(0.97F);
    mesh.open_box({{-1.7F, kRoofTop, -1.7F}, {1.7F, kRoofFoot, 1.7F}}, "EWSN");
    mesh.box({{-kEave, kRoofFoot - 0.1F, -kEave}, {kEave, kRoofFoot, kEave}});
    for (int side = 0; side < 4; ++side) {
        mesh.turned(side, [&](MeshBuilder& part) {
            constexpr int kCourses = 3;
            part.material(m.tile);
            for (int course = 0; course < kCourses; ++course) {
                const auto at = [](int row) {
                    const float t = static_cast<float>(row) / kCourses;
                    return Point2{
                        kEave + (kNeck - kEave) * t, kRoofFoot + (kShoulder - kRoofFoot) * t};
                };
                const Point2 low = at(course);
                const Point2 high = at(course + 1);
                part.tint(course % 2 == 0 ? 1.0F : 0.9F);
                part.quad(
                    {-low.u, low.v, low.u},
                    {low.u, low.v, low.u},
                    {high.u, high.v, high.u},
                    {-high.u, high.v, high.u}
                );
            }
            part.material(m.glass).tint(1);
            part.open_box({{-0.3F, kShoulder, 0.3F}, {0.3F, 2.5F, 0.36F}}, "S");
            part.material(m.stone).tint(1);
            part.open_box({{0.28F, kShoulder, 0.28F}, {0.42F, 2.5F, 0.42F}}, "EWSN");
            part.material(m.tile).tint(0.97F);
            part.triangle({-0.6F, 2.5F, 0.6F}, {0.6F, 2.5F, 0.6F}, {0, 3.3F, 0});
            part.tint(0.75F);
            part.triangle({0.6F, 2.5F, 0.6F}, {-0.6F, 2.5F, 0.6F}, {0, 2.5F, 0});
        });
    }
    mesh.material(m.iron).tint(1);
    mesh.cone(0, 0, 0.08F, 3.2F, 3.9F, 5);
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

// A hatch and two vents.
void add_hatch(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.stone).tint(0.95F);
    mesh.bevelled_box({{-1.1F, kRoofTop, -0.9F}, {0.1F, 0.45F, 0.5F}}, 0.05F);
    mesh.material(m.slate).tint(0.9F);
    mesh.bevelled_box({{-1.0F, 0.45F, -0.8F}, {0.0F, 0.55F, 0.4F}}, 0.04F);
    mesh.material(m.iron).tint(1);
    mesh.cylinder(1.0F, -0.7F, 0.16F, kRoofTop, 0.7F, 7);
    mesh.cone(1.0F, -0.7F, 0.28F, 0.7F, 0.9F, 7);
    mesh.cylinder(1.2F, 0.8F, 0.12F, kRoofTop, 0.5F, 7);
    mesh.cone(1.2F, 0.8F, 0.22F, 0.5F, 0.68F, 7);
}

// A winter garden: a glass roof as wide as the cell.
void add_roof_light(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kFoot = 1.6F;
    constexpr float kWall = 0.7F;
    constexpr float kTop = 1.9F;
    mesh.material(m.stone).tint(0.97F);
    mesh.open_box({{-kFoot, kRoofTop, -kFoot}, {kFoot, 0.25F, kFoot}}, "EWSNU");
    for (int side = 0; side < 4; ++side) {
        mesh.turned(side, [&](MeshBuilder& part) {
            part.material(m.glass).tint(1);
            part.quad(
                {-kFoot, 0.25F, kFoot},
                {kFoot, 0.25F, kFoot},
                {kFoot, kWall, kFoot},
                {-kFoot, kWall, kFoot}
            );
            part.triangle({-kFoot, kWall, kFoot}, {kFoot, kWall, kFoot}, {0, kTop, 0});
            part.material(m.plaster).tint(1);
            part.open_box(
                {{-kFoot, kWall - 0.05F, kFoot}, {kFoot, kWall + 0.05F, kFoot + 0.05F}}, "SUD"
            );
            for (const float x : {-kFoot, -0.55F, 0.55F, kFoot - 0.08F}) {
                part.open_box({{x, 0.25F, kFoot}, {x + 0.08F, kWall, kFoot + 0.05F}}, "SEW");
            }
            // Along the hip.
            constexpr float kBar = 0.06F;
            part.quad(
                {kFoot - kBar, kWall + 0.03F, kFoot + 0.03F},
                {kFoot + kBar, kWall + 0.03F, kFoot - kBar},
                {kBar, kTop + 0.03F, -kBar},
                {-kBar, kTop + 0.03F, kBar}
            );
        });
    }
}

// A chimney stack on the deck behind a roof window.
void add_stack(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.brick).tint(1);
    mesh.bevelled_box({{-1.55F, kDeck, -0.9F}, {-0.75F, 3.5F, -0.3F}}, 0.04F);
    mesh.material(m.stone).tint(0.95F);
    mesh.bevelled_box({{-1.63F, 3.5F, -0.98F}, {-0.67F, 3.65F, -0.22F}}, 0.04F);
    mesh.material(m.tile).tint(1);
    mesh.cylinder(-1.35F, -0.6F, 0.13F, 3.65F, 4.0F, 8);
    mesh.cylinder(-0.95F, -0.6F, 0.13F, 3.65F, 4.1F, 8);
}

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3&, const Vec3& normal) { return normal.y < -0.5F ? 0.8F : 1.0F; });
    return mesh;
}

}  // namespace

MeshBuilder make_flat_roof(const CityMaterials& materials, RoofPart part) {
    MeshBuilder mesh;
    add_deck(mesh, materials, kCityHalf, -kCityHalf, -kCityHalf, kCityHalf);
    mesh.placed({0, kDeck, 0}, 0, 1, [&](MeshBuilder& thing) {
        switch (part) {
            case RoofPart::kHatch:
                add_hatch(thing, materials);
                break;
            case RoofPart::kCupola:
                add_cupola(thing, materials);
                break;
            case RoofPart::kGarden:
                add_roof_garden(thing, materials);
                break;
            case RoofPart::kLight:
                add_roof_light(thing, materials);
                break;
        }
    });
    return shaded(std::move(mesh));
}

MeshBuilder make_mansard(const CityMaterials& materials, MaterialId cover, bool has_dormer) {
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& part) {
        add_slope(part, materials, cover, {});
        add_deck(part, materials, kCityHalf, -kCityHalf, -kCityHalf, kEdge);
        if (has_dormer) {
            add_roof_window(part, materials);
            add_stack(part, materials);
        }
    });
    return shaded(std::move(mesh));
}

MeshBuilder make_mansard_corner(const CityMaterials& materials, MaterialId cover) {
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& part) { add_slope(part, materials, cover, {false, true}); });
    mesh.turned(2, [&](MeshBuilder& part) { add_slope(part, materials, cover, {true, false}); });
    add_deck(mesh, materials, kEdge, -kEdge, -kCityHalf, kCityHalf);
    // A finial marks the corner.
    mesh.material(materials.iron).tint(1);
    mesh.cone(kEdge, -kEdge, 0.16F, kDeck, kDeck + 1.3F, 6);
    return shaded(std::move(mesh));
}

}  // namespace modelsynth::examples
