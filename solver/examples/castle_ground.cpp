#include "solver/examples/castle_ground.h"

#include <array>
#include <cmath>

namespace modelsynth::examples::castle {

namespace {

// Blades in a bunch: three-sided, so that they show from every side.
void add_tuft(MeshBuilder& mesh, std::uint32_t seed, float x, float z, float height) {
    for (std::uint32_t blade = 0; blade < 5; ++blade) {
        const float dx = 0.22F * (scatter(seed, 3 * blade) - 0.5F);
        const float dz = 0.22F * (scatter(seed, 3 * blade + 1) - 0.5F);
        const float tall = height * (0.6F + 0.4F * scatter(seed, 3 * blade + 2));
        const Vec3 tip = {x + dx * 2.2F, tall, z + dz * 2.2F};
        constexpr float kThick = 0.035F;
        const Vec3 a = {x + dx - kThick, 0, z + dz + kThick};
        const Vec3 b = {x + dx + kThick, 0, z + dz + kThick};
        const Vec3 c = {x + dx, 0, z + dz - kThick};
        mesh.tint(0.62F + 0.38F * scatter(seed, 40 + blade), 0.8F, 0.6F);
        mesh.triangle(a, b, tip).triangle(b, c, tip).triangle(c, a, tip);
    }
    mesh.tint(1);
}

// A patch of another green, hardly above the ground.
void add_patch(MeshBuilder& mesh, float x, float z, float radius, float tint) {
    mesh.tint(tint, tint, tint * 0.92F);
    std::array<Vec3, 7> rim;
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const float angle = 6.2831853F * static_cast<float>(i) / static_cast<float>(rim.size());
        const float reach = radius * (i % 2 == 0 ? 1.0F : 0.72F);
        rim[i] = {x + reach * std::cos(angle), 0.012F, z - reach * std::sin(angle)};
    }
    for (std::size_t i = 1; i + 1 < rim.size(); ++i) {
        mesh.triangle(rim[0], rim[i], rim[i + 1]);
    }
    mesh.tint(1);
}

void add_foliage(MeshBuilder& mesh, const Vec3& centre, const Vec3& radii, float tint) {
    mesh.turned(0, [&](MeshBuilder& ball) {
        ball.tint(tint).ball(centre, radii, 8);
        ball.shade([&](const Vec3& place, const Vec3&) {
            return 0.86F + 0.14F * (place.y - centre.y) / radii.y;
        });
    });
}

}  // namespace

MeshBuilder make_grass(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_patch(mesh, 0.3F, -0.35F, 0.5F, 0.86F);
    add_patch(mesh, -0.45F, 0.4F, 0.36F, 0.95F);
    add_tuft(mesh, 3, 0.5F, 0.45F, 0.14F);
    return mesh;
}

MeshBuilder make_wild(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_patch(mesh, 0.1F, 0.1F, 0.75F, 0.84F);
    add_tuft(mesh, 15, 0.35F, -0.5F, 0.4F);
    add_tuft(mesh, 16, -0.55F, 0.45F, 0.34F);
    mesh.turned(0, [&](MeshBuilder& stones) {
        stones.material(palette.paving).tint(0.95F);
        stones.placed({-0.25F, 0, -0.2F}, 0.5F, 1, [](MeshBuilder& stone) {
            stone.bevelled_box({{-0.35F, 0, -0.28F}, {0.3F, 0.36F, 0.28F}}, 0.14F);
        });
        stones.shade_upwards(0.78F, 0.4F);
    });
    for (std::uint32_t i = 0; i < 5; ++i) {
        const float x = 1.5F * (scatter(8, i) - 0.5F);
        const float z = 1.5F * (scatter(9, i) - 0.5F);
        mesh.material(i % 2 == 0 ? palette.gold : palette.flag);
        mesh.cone(x, z, 0.06F, 0.1F, 0.2F, 4);
    }
    return mesh;
}

MeshBuilder make_path(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    mesh.material(palette.paving).tint(0.78F);
    mesh.quad({-1, 0.015F, 0.7F}, {1, 0.015F, 0.7F}, {1, 0.015F, -0.7F}, {-1, 0.015F, -0.7F});
    add_cobbles(mesh, palette, 21, {{-1, 0, -0.68F}, {1, 0.03F, 0.68F}}, 5, 3);
    mesh.tint(1);
    add_cobbles(mesh, palette, 22, {{-1, 0, 0.7F}, {1, 0.07F, 0.84F}}, 3, 1);
    add_cobbles(mesh, palette, 23, {{-1, 0, -0.84F}, {1, 0.07F, -0.7F}}, 3, 1);
    return mesh;
}

MeshBuilder make_place(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    mesh.material(palette.paving).tint(0.78F);
    cap(mesh, cut_square(0.3F), 1, 0.015F);
    mesh.tint(1);
    // Two rings of stones about a round one.
    constexpr int kStones = 12;
    for (int ring = 0; ring < 2; ++ring) {
        for (int i = 0; i < kStones - 4 * (1 - ring); ++i) {
            const float step = 6.2831853F / static_cast<float>(kStones - 4 * (1 - ring));
            const float angle = step * static_cast<float>(i);
            const float inner = ring == 0 ? 0.27F : 0.62F;
            const float outer = ring == 0 ? 0.58F : 0.94F;
            const auto at = [&](float radius, float turn) {
                const float a = angle + turn * step;
                return Point2{radius * std::cos(a), -radius * std::sin(a)};
            };
            const std::array<Point2, 4> stone = {
                {at(inner, 0.06F), at(outer, 0.04F), at(outer, 0.96F), at(inner, 0.94F)}};
            mesh.tint(0.78F + 0.22F * scatter(25, static_cast<std::uint32_t>(20 * ring + i)));
            mesh.prism(stone, 0, 0.04F);
        }
    }
    mesh.tint(0.9F).cylinder(0, 0, 0.22F, 0, 0.06F, 8);
    return mesh;
}

MeshBuilder make_path_bend(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    // Rings of stones about the corner between east and north.
    const auto at = [](float radius, float turn) {
        const float angle = 3.14159265F * (1 + turn / 2);
        return Point2{1 + radius * std::cos(angle), -1 - radius * std::sin(angle)};
    };
    constexpr int kParts = 6;
    mesh.material(palette.paving).tint(0.78F);
    for (int i = 0; i < kParts; ++i) {
        const float t0 = static_cast<float>(i) / kParts;
        const float t1 = static_cast<float>(i + 1) / kParts;
        const std::array<Point2, 4> bed = {
            {at(0.3F, t0), at(1.7F, t0), at(1.7F, t1), at(0.3F, t1)}};
        mesh.quad(
            {bed[0].u, 0.015F, bed[0].v},
            {bed[1].u, 0.015F, bed[1].v},
            {bed[2].u, 0.015F, bed[2].v},
            {bed[3].u, 0.015F, bed[3].v}
        );
    }
    constexpr std::array<float, 6> kRings = {0.16F, 0.3F, 0.76F, 1.24F, 1.7F, 1.84F};
    constexpr std::array<int, 5> kStones = {2, 3, 4, 6, 4};
    for (std::size_t ring = 0; ring + 1 < kRings.size(); ++ring) {
        const bool kerb = ring == 0 || ring == 4;
        for (int i = 0; i < kStones[ring]; ++i) {
            const float step = 1.0F / static_cast<float>(kStones[ring]);
            const float t0 = step * (static_cast<float>(i) + 0.04F);
            const float t1 = step * (static_cast<float>(i) + 0.96F);
            const float low = kRings[ring] + 0.02F;
            const float high = kRings[ring + 1] - 0.02F;
            const std::array<Point2, 4> stone = {
                {at(low, t0), at(high, t0), at(high, t1), at(low, t1)}};
            mesh.tint(
                0.84F +
                0.16F *
                    scatter(
                        26, static_cast<std::uint32_t>(10 * ring) + static_cast<std::uint32_t>(i)
                    )
            );
            mesh.prism(stone, 0, kerb ? 0.07F : 0.035F);
        }
    }
    mesh.tint(1);
    return mesh;
}

MeshBuilder make_meadow_edge(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_patch(mesh, -0.6F, 0.3F, 0.38F, 0.84F);
    add_tuft(mesh, 17, -0.8F, -0.55F, 0.4F);
    add_tuft(mesh, 18, -0.72F, 0.35F, 0.3F);
    mesh.material(palette.paving).tint(0.85F);
    mesh.placed({-0.75F, 0, 0.75F}, 0.4F, 1, [](MeshBuilder& stone) {
        stone.bevelled_box({{-0.16F, 0, -0.14F}, {0.16F, 0.2F, 0.14F}}, 0.07F);
    });
    return mesh;
}

MeshBuilder make_tree(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_patch(mesh, 0, 0, 0.85F, 0.82F);
    add_tuft(mesh, 33, 0.5F, 0.4F, 0.3F);
    mesh.turned(0, [&](MeshBuilder& trunk) {
        trunk.material(palette.wood);
        constexpr std::array<Point2, 4> kTrunk = {
            {{0.3F, 0}, {0.19F, 0.25F}, {0.14F, 1.1F}, {0.17F, 1.9F}}};
        trunk.lathe(0, 0, kTrunk, 7);
        trunk.shade_upwards(0.75F, 1.2F);
    });
    mesh.material(palette.leaf);
    add_foliage(mesh, {0, 2.15F, 0}, {0.95F, 0.75F, 0.95F}, 0.88F);
    add_foliage(mesh, {0.22F, 2.75F, -0.15F}, {0.68F, 0.6F, 0.66F}, 1);
    add_foliage(mesh, {-0.4F, 2.55F, 0.3F}, {0.52F, 0.45F, 0.52F}, 0.96F);
    return mesh;
}

MeshBuilder make_cypress(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_patch(mesh, 0, 0, 0.7F, 0.82F);
    mesh.material(palette.wood).cylinder(0, 0, 0.12F, 0, 0.5F, 6);
    mesh.turned(0, [&](MeshBuilder& leaves) {
        leaves.material(palette.leaf).tint(0.78F, 0.86F, 0.9F);
        constexpr std::array<Point2, 7> kLeaves = {
            {{0.12F, 0.3F},
             {0.5F, 0.6F},
             {0.62F, 1.3F},
             {0.54F, 2},
             {0.4F, 2.8F},
             {0.2F, 3.5F},
             {0, 4}}};
        leaves.lathe(0, 0, kLeaves, 8);
        leaves.shade_upwards(0.75F, 1.6F);
    });
    return mesh;
}

}  // namespace modelsynth::examples::castle
