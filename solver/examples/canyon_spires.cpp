#include "solver/examples/canyon_spires.h"

#include "solver/examples/canyon_props.h"

#include <cmath>
#include <numbers>

namespace modelsynth::examples {

namespace {

constexpr float kFloor = kCanyonGround;
constexpr float kHalf = kCanyonHalf;
constexpr float kTop = kCanyonCell;

// A ring of an arch: its middle in the plane z = 0, the angle at which its radial axis leans from
// +x up, its radii along that axis and along z.
struct ArchRing {
    float x;
    float y;
    float angle;
    float radial;
    float depth;
    std::uint32_t seed;
};

// The beds of an arch lie level, as those of the cliffs.
MaterialId bed_of_arch(const CanyonPalette& palette, float y) {
    return y < 0.75F   ? palette.orange
           : y < 1.3F  ? palette.red
           : y < 1.55F ? palette.cream
           : y < 2.2F  ? palette.red
                       : palette.orange;
}

// Rings are joined in order, the hand of which is that of a shaft from below to above.
void add_tube(MeshBuilder& mesh, const CanyonPalette& palette, const std::vector<ArchRing>& rings) {
    constexpr int kSides = 9;
    const auto at = [](const ArchRing& ring, int side) {
        const auto index = static_cast<std::uint32_t>(side % kSides);
        const float uneven = ring.seed == 0 ? 1.0F : 0.82F + 0.34F * scatter(ring.seed, index);
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(index) / kSides;
        const float reach = ring.radial * uneven * std::cos(angle);
        return Vec3{
            ring.x + reach * std::cos(ring.angle),
            ring.y + reach * std::sin(ring.angle),
            -ring.depth * uneven * std::sin(angle)};
    };
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
        for (int s = 0; s < kSides; ++s) {
            const auto index = static_cast<std::uint32_t>(s);
            const float y = (at(rings[k], s).y + at(rings[k], s + 1).y + at(rings[k + 1], s).y +
                             at(rings[k + 1], s + 1).y) /
                            4;
            mesh.material(bed_of_arch(palette, y));
            mesh.tint(0.86F + 0.14F * scatter(rings[k].seed + 90, index));
            mesh.quad(
                at(rings[k], s), at(rings[k], s + 1), at(rings[k + 1], s + 1), at(rings[k + 1], s)
            );
        }
    }
    mesh.tint(1);
}

void shade_under(MeshBuilder& mesh) {
    mesh.shade([](const Vec3&, const Vec3& normal) { return normal.y < -0.3F ? 0.85F : 1.0F; });
}

constexpr float kLegRadial = 1.1F;
constexpr float kLegDepth = 1.12F;
constexpr float kSpanRadial = 0.82F;
constexpr float kSpanDepth = 1.0F;
constexpr float kSpanHeight = 1.75F;

}  // namespace

MeshBuilder make_hoodoo_foot(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_rock(
        mesh,
        0,
        0,
        {{1.25F, kFloor - 0.1F, palette.red, 501},
         {0.95F, 0.95F, palette.red, 502},
         {0.88F, 1.5F, palette.dark, 503},
         {0.72F, 1.55F, palette.orange, 504},
         {0.66F, 2.2F, palette.cream, 505},
         {0.74F, 2.3F, palette.red, 506},
         {0.66F, kTop, palette.red, 500}},
        9
    );
    mesh.shade_upwards(0.82F, 2.0F);
    add_ground(mesh, palette.sand, 210);
    add_lump(mesh, {1.0F, kFloor - 0.03F, 0.95F}, 0.3F, 0.3F, palette.orange, 507);
    return mesh;
}

MeshBuilder make_hoodoo_middle(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_rock(
        mesh,
        0,
        0,
        {{0.66F, 0, palette.red, 500},
         {0.72F, 0.6F, palette.orange, 511},
         {0.58F, 0.7F, palette.orange, 512},
         {0.62F, 1.3F, palette.cream, 513},
         {0.72F, 1.4F, palette.cream, 514},
         {0.74F, 1.6F, palette.red, 515},
         {0.6F, 1.7F, palette.dark, 516},
         {0.56F, 2.4F, palette.red, 517},
         {0.66F, kTop, palette.red, 500}},
        9
    );
    shade_under(mesh);
    return mesh;
}

MeshBuilder make_hoodoo_top(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_rock(
        mesh,
        0,
        0,
        {{0.66F, 0, palette.red, 500},
         {0.6F, 0.5F, palette.orange, 521},
         {0.42F, 0.9F, palette.orange, 522},
         {0.45F, 1.15F, palette.cream, 523},
         {1.0F, 1.3F, palette.cream, 524},
         {1.08F, 1.6F, palette.cream, 525},
         {0.85F, 1.95F, palette.cream, 526},
         {0.35F, 2.15F, palette.cream, 527}},
        9
    );
    shade_under(mesh);
    return mesh;
}

MeshBuilder make_arch_foot(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_tube(
        mesh,
        palette,
        {{0, kFloor - 0.1F, 0, 1.4F, 1.4F, 601},
         {0, 0.95F, 0, 1.25F, 1.25F, 602},
         {0, 1.35F, 0, 1.18F, 1.18F, 603},
         {0, 1.5F, 0, 1.02F, 1.02F, 606},
         {0, 2.2F, 0, 1.2F, 1.2F, 604},
         {0, kTop, 0, kLegRadial, kLegDepth, 0}}
    );
    mesh.shade_upwards(0.82F, 2.2F);
    add_ground(mesh, palette.sand, 211);
    add_lump(mesh, {1.15F, kFloor - 0.03F, 1.15F}, 0.28F, 0.3F, palette.red, 605);
    return mesh;
}

MeshBuilder make_arch_shaft(const CanyonPalette& palette) {
    MeshBuilder mesh;
    add_tube(
        mesh,
        palette,
        {{0, 0, 0, kLegRadial, kLegDepth, 0},
         {0, 0.7F, 0, 1.25F, 1.15F, 611},
         {0, 1.3F, 0, 1.12F, 1.02F, 612},
         {0, 1.5F, 0, 0.96F, 0.92F, 614},
         {0, 2.2F, 0, 1.15F, 1.1F, 613},
         {0, kTop, 0, kLegRadial, kLegDepth, 0}}
    );
    return mesh;
}

MeshBuilder make_arch_shoulder(const CanyonPalette& palette) {
    // A quarter turn about the cell's lower east edge, from upright to level.
    MeshBuilder mesh;
    constexpr int kParts = 6;
    std::vector<ArchRing> rings;
    for (int part = 0; part <= kParts; ++part) {
        const float share = static_cast<float>(part) / kParts;
        const float turn = share * std::numbers::pi_v<float> / 2;
        const float bulge = 0.22F * std::sin(2 * turn);
        const bool at_end = part == 0 || part == kParts;
        rings.push_back(
            {kHalf - kHalf * std::cos(turn) - bulge * 0.5F,
             kSpanHeight * std::sin(turn) + bulge * 0.5F,
             -turn,
             kLegRadial + (kSpanRadial - kLegRadial) * share,
             kLegDepth + (kSpanDepth - kLegDepth) * share,
             at_end ? 0U : 620U + static_cast<std::uint32_t>(part)}
        );
    }
    add_tube(mesh, palette, rings);
    shade_under(mesh);
    return mesh;
}

MeshBuilder make_arch_span(const CanyonPalette& palette) {
    MeshBuilder mesh;
    constexpr float kDown = -std::numbers::pi_v<float> / 2;
    add_tube(
        mesh,
        palette,
        {{-kHalf, kSpanHeight, kDown, kSpanRadial, kSpanDepth, 0},
         {-0.8F, kSpanHeight + 0.2F, kDown, 0.66F, 0.95F, 631},
         {0, kSpanHeight + 0.32F, kDown, 0.5F, 0.85F, 632},
         {0.8F, kSpanHeight + 0.16F, kDown, 0.68F, 0.9F, 633},
         {kHalf, kSpanHeight, kDown, kSpanRadial, kSpanDepth, 0}}
    );
    shade_under(mesh);
    return mesh;
}

}  // namespace modelsynth::examples
