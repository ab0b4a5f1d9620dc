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

MeshBuilder make_barrels(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    add_barrel(mesh, palette, -0.4F, -0.3F);
    add_barrel(mesh, palette, 0.2F, -0.45F);
    mesh.material(palette.wood).tint(0.95F);
    mesh.placed({0.25F, 0, 0.4F}, 0.4F, 1, [](MeshBuilder& crate) {
        crate.bevelled_box({{-0.3F, 0, -0.3F}, {0.3F, 0.55F, 0.3F}}, 0.04F);
    });
    mesh.tint(0.85F);
    mesh.placed({-0.45F, 0, 0.45F}, 1.2F, 1, [](MeshBuilder& crate) {
        crate.bevelled_box({{-0.22F, 0, -0.22F}, {0.22F, 0.4F, 0.22F}}, 0.04F);
    });
    return mesh;
}

MeshBuilder make_hay(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    mesh.material(palette.wood);
    mesh.box({{-0.7F, 0.42F, -0.4F}, {0.5F, 0.52F, 0.4F}});
    for (const float z : {-0.42F, 0.42F}) {
        mesh.box({{-0.7F, 0.5F, z - 0.04F}, {0.5F, 0.78F, z + 0.04F}});
        mesh.open_box({{0.5F, 0.4F, z * 0.7F - 0.04F}, {0.95F, 0.48F, z * 0.7F + 0.04F}}, "EUDSN");
        // A wheel: a short drum that lies on its side.
        mesh.material(palette.dark);
        std::array<Point2, 8> rim;
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const float angle = 0.7853982F * static_cast<float>(i);
            rim[i] = {-0.15F + 0.4F * std::cos(angle), 0.4F + 0.4F * std::sin(angle)};
        }
        mesh.extrude(rim, z > 0 ? 0.5F : -0.58F, z > 0 ? 0.58F : -0.5F);
        mesh.material(palette.wood);
    }
    mesh.material(palette.wheat);
    mesh.bevelled_box({{-0.64F, 0.5F, -0.37F}, {0.44F, 1.05F, 0.37F}}, 0.2F);
    return mesh;
}

MeshBuilder make_stall(const Palette& palette) {
    MeshBuilder mesh;
    add_earth(mesh, palette);
    mesh.material(palette.wood);
    for (const float x : {-0.7F, 0.7F}) {
        for (const float z : {-0.6F, 0.6F}) {
            mesh.open_box({{x - 0.05F, 0, z - 0.05F}, {x + 0.05F, 1.5F, z + 0.05F}}, "EWSN");
        }
    }
    mesh.box({{-0.75F, 0.6F, 0.2F}, {0.75F, 0.7F, 0.7F}});
    mesh.open_box({{-0.7F, 0, 0.62F}, {0.7F, 0.6F, 0.66F}}, "EWSN");
    // A striped awning.
    for (int i = 0; i < 6; ++i) {
        const float x0 = -0.84F + 0.28F * static_cast<float>(i);
        mesh.material(i % 2 == 0 ? palette.flag : palette.plaster);
        mesh.quad(
            {x0, 1.4F, 0.85F}, {x0 + 0.28F, 1.4F, 0.85F}, {x0 + 0.28F, 1.8F, 0}, {x0, 1.8F, 0}
        );
        mesh.quad(
            {x0, 1.8F, 0}, {x0 + 0.28F, 1.8F, 0}, {x0 + 0.28F, 1.4F, -0.85F}, {x0, 1.4F, -0.85F}
        );
        mesh.quad(
            {x0 + 0.28F, 1.36F, 0.85F}, {x0, 1.36F, 0.85F}, {x0, 1.76F, 0}, {x0 + 0.28F, 1.76F, 0}
        );
        mesh.quad(
            {x0 + 0.28F, 1.76F, 0}, {x0, 1.76F, 0}, {x0, 1.36F, -0.85F}, {x0 + 0.28F, 1.36F, -0.85F}
        );
        mesh.quad(
            {x0, 1.22F, 0.86F},
            {x0 + 0.28F, 1.22F, 0.86F},
            {x0 + 0.28F, 1.4F, 0.85F},
            {x0, 1.4F, 0.85F}
        );
        mesh.quad(
            {x0 + 0.28F, 1.22F, -0.86F},
            {x0, 1.22F, -0.86F},
            {x0, 1.4F, -0.85F},
            {x0 + 0.28F, 1.4F, -0.85F}
        );
    }
    constexpr std::array<float, 4> kGoods = {-0.5F, -0.15F, 0.2F, 0.52F};
    for (std::size_t i = 0; i < kGoods.size(); ++i) {
        mesh.material(i % 2 == 0 ? palette.gold : palette.leaf);
        mesh.ball({kGoods[i], 0.78F, 0.45F}, {0.15F, 0.12F, 0.15F}, 6);
    }
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
