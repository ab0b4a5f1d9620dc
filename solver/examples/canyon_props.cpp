#include "solver/examples/canyon_props.h"

#include <array>
#include <cmath>
#include <numbers>

namespace modelsynth::examples {

namespace {

constexpr float kFloor = kCanyonGround;
constexpr float kHalf = kCanyonHalf;

float angle_of(int index, int count) {
    return 2 * std::numbers::pi_v<float> * static_cast<float>(index % count) /
           static_cast<float>(count);
}

}  // namespace

void add_rock(MeshBuilder& mesh, float x, float z, const std::vector<RockRing>& rings, int sides) {
    const auto at = [&](const RockRing& ring, int side) {
        const float uneven =
            0.82F + 0.32F * scatter(ring.seed, static_cast<std::uint32_t>(side % sides));
        const float angle = angle_of(side, sides);
        return Vec3{
            x + ring.radius * uneven * std::cos(angle),
            ring.y,
            z - ring.radius * uneven * std::sin(angle)};
    };
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
        mesh.material(rings[k].material);
        for (int s = 0; s < sides; ++s) {
            mesh.tint(0.86F + 0.14F * scatter(rings[k].seed + 50, static_cast<std::uint32_t>(s)));
            mesh.quad(
                at(rings[k], s), at(rings[k], s + 1), at(rings[k + 1], s + 1), at(rings[k + 1], s)
            );
        }
    }
    mesh.tint(1).material(rings.back().material);
    for (int s = 0; s < sides; ++s) {
        mesh.triangle({x, rings.back().y, z}, at(rings.back(), s), at(rings.back(), s + 1));
    }
}

void add_lump(
    MeshBuilder& mesh,
    const Vec3& foot,
    float radius,
    float height,
    MaterialId material,
    std::uint32_t seed
) {
    add_rock(
        mesh,
        foot.x,
        foot.z,
        {{radius * 0.92F, foot.y, material, seed},
         {radius, foot.y + height * 0.4F, material, seed + 1},
         {radius * 0.7F, foot.y + height * 0.8F, material, seed + 2},
         {radius * 0.35F, foot.y + height, material, seed + 3}}
    );
}

void add_tuft(
    MeshBuilder& mesh, const Vec3& foot, float size, MaterialId material, std::uint32_t seed
) {
    constexpr int kBlades = 6;
    mesh.material(material);
    for (int blade = 0; blade < kBlades; ++blade) {
        const auto index = static_cast<std::uint32_t>(blade);
        const float angle = angle_of(blade, kBlades) + scatter(seed, index);
        const float reach = size * (0.25F + 0.35F * scatter(seed, index + 20));
        const float height = size * (0.6F + 0.4F * scatter(seed, index + 40));
        const float half = size * 0.12F;
        const Vec3 tip = {
            foot.x + reach * std::cos(angle), foot.y + height, foot.z - reach * std::sin(angle)};
        std::array<Vec3, 3> base;
        for (int i = 0; i < 3; ++i) {
            const float turn = angle + angle_of(i, 3);
            base[static_cast<std::size_t>(i)] = {
                foot.x + half * std::cos(turn), foot.y, foot.z - half * std::sin(turn)};
        }
        mesh.tint(0.8F + 0.2F * scatter(seed, index + 60));
        for (std::size_t i = 0; i < 3; ++i) {
            mesh.triangle(base[i], base[(i + 1) % 3], tip);
        }
    }
    mesh.tint(1);
}

void add_ground(MeshBuilder& mesh, MaterialId material, std::uint32_t seed) {
    constexpr int kParts = 4;
    const auto at = [seed](int x, int z) {
        const float step = kCanyonCell / kParts;
        Vec3 place = {
            -kHalf + step * static_cast<float>(x), kFloor, -kHalf + step * static_cast<float>(z)};
        if (x % kParts != 0 && z % kParts != 0) {
            const auto index = static_cast<std::uint32_t>(x * kParts + z);
            place.x += step * 0.5F * (scatter(seed, index) - 0.5F);
            place.z += step * 0.5F * (scatter(seed, index + 30) - 0.5F);
            place.y += 0.07F * scatter(seed, index + 60);
        }
        return place;
    };
    mesh.material(material);
    for (int z = 0; z < kParts; ++z) {
        for (int x = 0; x < kParts; ++x) {
            mesh.quad(at(x, z + 1), at(x + 1, z + 1), at(x + 1, z), at(x, z));
        }
    }
}

MeshBuilder make_valley(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.sand, 201);
    return mesh;
}

MeshBuilder make_pebbles(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.sand, 202);
    add_lump(mesh, {-0.6F, kFloor, 0.5F}, 0.22F, 0.2F, palette.red, 211);
    add_lump(mesh, {-0.2F, kFloor, 0.75F}, 0.13F, 0.13F, palette.orange, 212);
    add_lump(mesh, {0.8F, kFloor, -0.7F}, 0.16F, 0.17F, palette.red, 213);
    add_tuft(mesh, {0.5F, kFloor, 0.3F}, 0.4F, palette.grass, 214);
    return mesh;
}

MeshBuilder make_saguaro(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.sand, 203);
    mesh.material(palette.green);
    const auto column = [&mesh](float x, float z, float radius, float low, float high) {
        const std::array<Point2, 5> profile = {
            {{radius * 0.85F, low},
             {radius, low + 0.2F},
             {radius, high - radius},
             {radius * 0.7F, high - radius * 0.35F},
             {0, high}}};
        mesh.lathe(x, z, profile, 8);
    };
    column(0, 0, 0.24F, kFloor - 0.05F, 2.95F);
    const auto arm = [&](float reach, float low, float high) {
        const std::array<Point2, 6> elbow = {
            {{0, low - 0.14F},
             {reach, low - 0.14F},
             {reach + 0.15F, low},
             {reach + 0.1F, low + 0.16F},
             {reach - 0.1F, low + 0.16F},
             {0, low + 0.14F}}};
        mesh.tint(0.92F).extrude(elbow, -0.13F, 0.13F).tint(1);
        column(reach, 0, 0.16F, low, high);
    };
    arm(0.62F, 1.35F, 2.45F);
    mesh.turned(2, [&](MeshBuilder& turned) {
        const std::array<Point2, 6> elbow = {
            {{0, 1.55F}, {0.5F, 1.55F}, {0.64F, 1.7F}, {0.6F, 1.85F}, {0.4F, 1.85F}, {0, 1.82F}}};
        const std::array<Point2, 4> profile = {
            {{0.14F, 1.7F}, {0.15F, 2.5F}, {0.1F, 2.62F}, {0, 2.68F}}};
        turned.extrude(elbow, -0.12F, 0.12F).lathe(0.5F, 0, profile, 8);
    });
    mesh.shade([](const Vec3& position, const Vec3&) {
        return position.y < kFloor + 0.08F ? 1.0F : 0.8F + 0.07F * position.y;
    });
    add_lump(mesh, {-0.7F, kFloor, 0.7F}, 0.25F, 0.25F, palette.red, 221);
    add_tuft(mesh, {0.7F, kFloor, 0.8F}, 0.4F, palette.grass, 222);
    return mesh;
}

MeshBuilder make_sage(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.sand, 204);
    add_lump(mesh, {-0.4F, kFloor - 0.02F, -0.3F}, 0.42F, 0.55F, palette.green, 231);
    add_lump(mesh, {0.1F, kFloor - 0.02F, 0.1F}, 0.3F, 0.4F, palette.grass, 232);
    add_tuft(mesh, {0.8F, kFloor, 0.7F}, 0.6F, palette.grass, 233);
    add_tuft(mesh, {-0.7F, kFloor, 0.7F}, 0.5F, palette.green, 234);
    return mesh;
}

MeshBuilder make_boulders(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.sand, 205);
    add_lump(mesh, {-0.25F, kFloor - 0.03F, -0.2F}, 0.75F, 1.0F, palette.red, 241);
    add_lump(mesh, {0.65F, kFloor - 0.03F, 0.45F}, 0.42F, 0.5F, palette.orange, 242);
    add_lump(mesh, {-0.6F, kFloor - 0.03F, 0.85F}, 0.26F, 0.26F, palette.red, 243);
    add_tuft(mesh, {0.3F, kFloor, 0.95F}, 0.4F, palette.grass, 244);
    return mesh;
}

MeshBuilder make_turf(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.grass, 206);
    return mesh;
}

MeshBuilder make_tufts(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.grass, 207);
    add_tuft(mesh, {-0.6F, kFloor, -0.5F}, 0.6F, palette.grass, 251);
    add_tuft(mesh, {0.5F, kFloor, 0.2F}, 0.5F, palette.green, 252);
    add_tuft(mesh, {-0.3F, kFloor, 0.8F}, 0.4F, palette.grass, 253);
    add_lump(mesh, {0.7F, kFloor - 0.02F, -0.7F}, 0.25F, 0.22F, palette.cream, 254);
    return mesh;
}

MeshBuilder make_slabs(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.grass, 212);
    // Bare rock that shows through the turf in two steps, and a yucca in its lee.
    const auto slab = [&](float x, float z, float radius, float low, float high, std::uint32_t seed
                      ) {
        add_rock(
            mesh,
            x,
            z,
            {{radius, low, palette.orange, seed},
             {radius * 0.95F, high - 0.04F, palette.cream, seed},
             {radius * 0.86F, high, palette.cream, seed}},
            9
        );
    };
    slab(-0.15F, 0.1F, 1.15F, kFloor - 0.02F, kFloor + 0.13F, 281);
    slab(-0.35F, -0.15F, 0.65F, kFloor + 0.12F, kFloor + 0.3F, 282);
    add_tuft(mesh, {0.85F, kFloor, 0.95F}, 0.8F, palette.green, 283);
    add_tuft(mesh, {-1.1F, kFloor, 1.1F}, 0.5F, palette.grass, 284);
    return mesh;
}

MeshBuilder make_juniper(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_ground(mesh, palette.grass, 208);
    add_rock(
        mesh,
        0,
        0,
        {{0.2F, kFloor - 0.05F, palette.wood, 261},
         {0.12F, 1.1F, palette.wood, 262},
         {0.1F, 1.6F, palette.wood, 263}},
        5
    );
    add_lump(mesh, {0.3F, 1.05F, 0.15F}, 0.62F, 0.8F, palette.green, 264);
    add_lump(mesh, {-0.38F, 1.25F, -0.1F}, 0.58F, 0.8F, palette.green, 265);
    add_lump(mesh, {0.05F, 1.75F, -0.05F}, 0.55F, 0.9F, palette.green, 266);
    mesh.shade([](const Vec3& position, const Vec3& normal) {
        const float rise = position.y < kFloor + 0.08F ? 1.0F : 0.65F + 0.14F * position.y;
        return rise * (normal.y < -0.4F ? 0.7F : 1.0F);
    });
    return mesh;
}

MeshBuilder make_house(const CanyonPalette& palette) {
    MeshBuilder mesh;
    constexpr float kWall = 1.2F;
    constexpr float kRoof = 2.55F;
    add_ground(mesh, palette.grass, 209);
    // Walls lean in a little, as mud brick does, and end in a parapet about a sunken roof.
    const auto ring = [](float reach, float y) {
        return std::array<Vec3, 4>{
            {{-reach, y, reach}, {reach, y, reach}, {reach, y, -reach}, {-reach, y, -reach}}};
    };
    const auto foot = ring(kWall, kFloor - 0.05F);
    const auto top = ring(kWall - 0.08F, kRoof + 0.3F);
    const auto lip = ring(kWall - 0.28F, kRoof + 0.3F);
    const auto roof = ring(kWall - 0.28F, kRoof);
    mesh.material(palette.cream).tint(0.95F, 0.84F, 0.72F);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        mesh.quad(foot[i], foot[j], top[j], top[i]);
        mesh.quad(top[i], top[j], lip[j], lip[i]);
        mesh.quad(lip[i], lip[j], roof[j], roof[i]);
    }
    mesh.tint(0.8F, 0.7F, 0.6F).quad(roof[0], roof[1], roof[2], roof[3]).tint(1);
    mesh.shade_upwards(0.75F, 2.2F);
    mesh.material(palette.wood);
    for (int beam = 0; beam < 4; ++beam) {  // roof beams that show on both sides
        const float x = -0.75F + 0.5F * static_cast<float>(beam);
        mesh.box({{x - 0.07F, 2.2F, -1.38F}, {x + 0.07F, 2.34F, -1.05F}});
        mesh.box({{x - 0.07F, 2.2F, 1.05F}, {x + 0.07F, 2.34F, 1.38F}});
    }
    // A door in a frame, blue against spirits, and a window.
    mesh.box({{1.05F, kFloor, -0.45F}, {1.24F, 2.0F, 0.45F}});
    mesh.material(palette.water).box({{1.1F, kFloor, -0.34F}, {1.27F, 1.88F, 0.34F}});
    mesh.material(palette.cream).box({{1.15F, kFloor, -0.5F}, {1.45F, kFloor + 0.14F, 0.5F}});
    for (const float side : {-1.0F, 1.0F}) {
        const float z0 = side > 0 ? 1.0F : -1.21F;
        mesh.material(palette.wood).box({{-0.4F, 1.2F, z0}, {0.2F, 1.85F, z0 + 0.21F}});
        const float w0 = side > 0 ? 1.05F : -1.24F;
        mesh.material(palette.dark).box({{-0.32F, 1.28F, w0}, {0.12F, 1.77F, w0 + 0.19F}});
    }
    // A ladder leans against the back; its poles stand out above the roof.
    mesh.material(palette.wood);
    for (const float z : {-0.25F, 0.25F}) {
        mesh.quad(
            {-1.42F, kFloor, z - 0.05F},
            {-1.42F, kFloor, z + 0.05F},
            {-1.16F, 2.98F, z + 0.05F},
            {-1.16F, 2.98F, z - 0.05F}
        );
        mesh.quad(
            {-1.35F, kFloor, z + 0.05F},
            {-1.35F, kFloor, z - 0.05F},
            {-1.09F, 2.98F, z - 0.05F},
            {-1.09F, 2.98F, z + 0.05F}
        );
        mesh.quad(
            {-1.42F, kFloor, z + 0.05F},
            {-1.35F, kFloor, z + 0.05F},
            {-1.09F, 2.98F, z + 0.05F},
            {-1.16F, 2.98F, z + 0.05F}
        );
        mesh.quad(
            {-1.35F, kFloor, z - 0.05F},
            {-1.42F, kFloor, z - 0.05F},
            {-1.16F, 2.98F, z - 0.05F},
            {-1.09F, 2.98F, z - 0.05F}
        );
    }
    for (int rung = 0; rung < 6; ++rung) {
        const float y = 0.8F + 0.36F * static_cast<float>(rung);
        const float x = -1.385F + (y - kFloor) * 0.105F;
        mesh.box({{x - 0.03F, y, -0.25F}, {x + 0.03F, y + 0.06F, 0.25F}});
    }
    add_lump(mesh, {-0.5F, kRoof - 0.02F, 0.5F}, 0.22F, 0.42F, palette.red, 271);
    add_tuft(mesh, {1.2F, kFloor, 1.25F}, 0.35F, palette.green, 272);
    return mesh;
}

}  // namespace modelsynth::examples
