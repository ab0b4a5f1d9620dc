#include "solver/examples/castle_court.h"

#include <array>
#include <cmath>

namespace modelsynth::examples::castle {

namespace {

// A flat stone, trodden into the ground.
void add_slab(MeshBuilder& mesh, const Palette& palette, const Point2& at, float size, float turn) {
    mesh.material(palette.paving)
        .tint(0.86F + 0.14F * scatter(71, static_cast<std::uint32_t>(100 * turn)));
    mesh.placed({at.u, 0, at.v}, turn, size, [](MeshBuilder& slab) {
        slab.open_box({{-0.3F, 0, -0.2F}, {0.3F, 0.03F, 0.2F}}, "EWUSN");
    });
    mesh.tint(1);
}

void add_barrel(MeshBuilder& mesh, const Palette& palette, float x, float z) {
    mesh.material(palette.wood);
    constexpr std::array<Point2, 5> kBarrel = {
        {{0.2F, 0}, {0.27F, 0.2F}, {0.27F, 0.42F}, {0.2F, 0.62F}, {0, 0.62F}}};
    mesh.lathe(x, z, kBarrel, 8);
    mesh.material(palette.dark);
    for (const float y : {0.14F, 0.42F}) {
        mesh.cylinder(x, z, 0.275F, y, y + 0.05F, 8);
    }
}

}  // namespace

MeshBuilder make_court(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    add_slab(mesh, palette, {-0.5F, -0.45F}, 1, 0.3F);
    add_slab(mesh, palette, {0.45F, 0.1F}, 1.1F, 1.4F);
    add_slab(mesh, palette, {-0.3F, 0.6F}, 0.8F, 2.3F);
    return mesh;
}

MeshBuilder make_court_edge(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    add_cobbles(mesh, palette, 72, {{-1, 0, -1}, {-0.45F, 0.03F, 1}}, 1, 5);
    add_slab(mesh, palette, {0.3F, 0.35F}, 0.9F, 0.8F);
    return mesh;
}

MeshBuilder make_shed(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    mesh.material(palette.wood);
    for (const float z : {-0.85F, 0.85F}) {
        mesh.open_box({{0.42F, 0, z - 0.07F}, {0.56F, 1.25F, z + 0.07F}}, "EWSN");
        mesh.open_box({{-0.95F, 0, z - 0.05F}, {-0.85F, 1.75F, z + 0.05F}}, "EWSN");
    }
    mesh.open_box({{0.4F, 1.2F, -1}, {0.58F, 1.34F, 1}}, "EWUD");
    mesh.tint(0.9F).open_box({{-0.98F, 0, -0.85F}, {-0.9F, 1.2F, 0.85F}}, "EU");
    // The roof's section is drawn along z, whole to the cell's walls: sheds stand in rows.
    mesh.material(palette.tile).tint(0.95F);
    constexpr std::array<Point2, 4> kRoof = {
        {{-0.98F, 1.75F}, {0.8F, 1.2F}, {0.8F, 1.3F}, {-0.98F, 1.9F}}};
    mesh.extrude(kRoof, -1, 1);
    mesh.material(palette.wheat).tint(0.95F);
    mesh.placed({-0.3F, 0, 0.3F}, 0.2F, 1, [](MeshBuilder& bale) {
        bale.bevelled_box({{-0.4F, 0, -0.3F}, {0.4F, 0.5F, 0.3F}}, 0.08F);
    });
    add_barrel(mesh, palette, -0.1F, -0.5F);
    return mesh;
}

MeshBuilder make_stores(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    add_barrel(mesh, palette, -0.45F, -0.45F);
    add_barrel(mesh, palette, 0.15F, -0.6F);
    mesh.material(palette.wood).tint(0.95F);
    mesh.placed({-0.5F, 0, 0.4F}, 0.4F, 1, [](MeshBuilder& crate) {
        crate.bevelled_box({{-0.28F, 0, -0.28F}, {0.28F, 0.5F, 0.28F}}, 0.04F);
    });
    mesh.material(palette.wheat);
    mesh.placed({0.4F, 0, 0.35F}, 0.2F, 1, [](MeshBuilder& bale) {
        bale.bevelled_box({{-0.35F, 0, -0.4F}, {0.35F, 0.45F, 0.4F}}, 0.09F);
        bale.bevelled_box({{-0.3F, 0.44F, -0.3F}, {0.3F, 0.8F, 0.25F}}, 0.09F);
    });
    return mesh;
}

MeshBuilder make_well(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    mesh.turned(0, [&](MeshBuilder& well) {
        well.material(palette.paving).tint(0.85F);
        well.cylinder(0, 0, 0.9F, 0, 0.05F, 10);
        well.material(palette.stone).tint(0.95F);
        constexpr std::array<Point2, 6> kRing = {
            {{0.62F, 0.05F},
             {0.55F, 0.6F},
             {0.64F, 0.62F},
             {0.64F, 0.75F},
             {0.42F, 0.75F},
             {0.42F, 0.3F}}};
        well.lathe(0, 0, kRing, 10, false);
        well.shade_upwards(kFootShade, 0.8F);
    });
    mesh.material(palette.dark).tint(1);
    cap(mesh, cut_square(0.25F), 0.45F, 0.4F);
    mesh.material(palette.wood);
    for (const float x : {-0.52F, 0.52F}) {
        mesh.box({{x - 0.05F, 0.6F, -0.05F}, {x + 0.05F, 1.5F, 0.05F}});
    }
    mesh.box({{-0.5F, 1.15F, -0.05F}, {0.5F, 1.25F, 0.05F}});
    mesh.material(palette.tile);
    mesh.gable_roof({{-0.75F, 1.4F, -0.5F}, {0.75F, 1.9F, 0.5F}}, 0.15F, 0.08F);
    return mesh;
}

}  // namespace modelsynth::examples::castle
