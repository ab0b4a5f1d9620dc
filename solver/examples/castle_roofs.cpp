#include "solver/examples/castle_roofs.h"

#include <algorithm>
#include <array>

namespace modelsynth::examples::castle {

namespace {

// Eaves stand out on the level of the wall's head: a second roof on the first keeps clear of it.
constexpr float kEaves = 1.24F;
constexpr float kFascia = 0.12F;
constexpr int kCourses = 5;

std::vector<Point2> side_outline(float out) { return {{out, 1}, {out, -1}}; }

std::vector<Point2> corner_outline(float out) { return {{out, 1}, {out, -out}, {-1, -out}}; }

std::vector<Point2> valley_outline(float out) { return {{1, -out}, {out, -out}, {out, -1}}; }

void add_eaves(MeshBuilder& mesh, const Palette& palette, const Outline& outline) {
    mesh.material(palette.wood).tint(0.8F);
    constexpr std::array<Point2, 2> kSoffit = {{{0.95F, 0}, {kEaves, 0}}};
    loft(mesh, kSoffit, outline);
    mesh.material(palette.slate).tint(0.82F);
    constexpr std::array<Point2, 2> kBoard = {{{kEaves, 0}, {kEaves, kFascia}}};
    loft(mesh, kBoard, outline);
}

void add_slope(MeshBuilder& mesh, const Palette& palette, const Outline& outline, float from) {
    mesh.material(palette.slate);
    const auto height = [](float out) {
        return kFascia + (2 - kFascia) * (kEaves - out) / (kEaves + 1);
    };
    add_courses(mesh, outline, {from, height(from)}, {-1, 2}, kCourses);
}

}  // namespace

MeshBuilder make_roof_corner(const Palette& palette) {
    MeshBuilder mesh;
    add_eaves(mesh, palette, corner_outline);
    add_slope(mesh, palette, corner_outline, kEaves);
    return mesh;
}

MeshBuilder make_roof_side(const Palette& palette) {
    MeshBuilder mesh;
    add_eaves(mesh, palette, side_outline);
    add_slope(mesh, palette, side_outline, kEaves);
    return mesh;
}

MeshBuilder make_roof_chimney(const Palette& palette) {
    MeshBuilder mesh;
    mesh.turned(3, [&](MeshBuilder& south) { south = make_roof_side(palette); });
    mesh.material(palette.stone).tint(0.95F);
    mesh.open_box({{-0.3F, 0.5F, -0.15F}, {0.3F, 2.3F, 0.35F}}, "EWSN");
    mesh.material(palette.trim).tint(1);
    mesh.bevelled_box({{-0.38F, 2.3F, -0.23F}, {0.38F, 2.46F, 0.43F}}, 0.05F);
    mesh.material(palette.dark);
    for (const float x : {-0.16F, 0.16F}) {
        mesh.cylinder(x, 0.1F, 0.1F, 2.4F, 2.7F, 6);
    }
    return mesh;
}

MeshBuilder make_roof_valley(const Palette& palette) {
    MeshBuilder mesh;
    // The same courses as the sides', cut at the corner of the cell, where two eaves meet.
    add_slope(
        mesh, palette, [](float out) { return valley_outline(std::min(out, 1.0F)); }, kEaves
    );
    return mesh;
}

MeshBuilder make_spire(const Palette& palette) {
    MeshBuilder mesh;
    // Eight-sided: the cut at the corner is drawn in with the roof. Measured from the tower's
    // middle, at (-1, 1), the eaves lie 1 + out away.
    const Outline outline = [](float out) {
        const float cut = (1 + out) * 0.26F;
        return std::vector<Point2>{{out, 1}, {out, cut - out}, {out - cut, -out}, {-1, -out}};
    };
    mesh.material(palette.stone).tint(kStoneTint);
    const Outline body = [](float out) {
        const float c = kTowerCut;
        return std::vector<Point2>{{out, 1}, {out, c - out}, {out - c, -out}, {-1, -out}};
    };
    constexpr std::array<Point2, 2> kNeck = {{{1, 0}, {1, 0.3F}}};
    loft(mesh, kNeck, body);
    mesh.turned(1, [&](MeshBuilder& face) { add_corbels(face, palette, -1, 1, 1, 0.36F); });
    mesh.turned(2, [&](MeshBuilder& face) { add_corbels(face, palette, -1, 1, 1, 0.36F); });
    mesh.shade([](const Vec3& place, const Vec3&) { return place.y > 0.2F ? 0.88F : 1.0F; });
    mesh.material(palette.stone).tint(0.95F);
    constexpr std::array<Point2, 3> kCornice = {{{1, 0.3F}, {1.12F, 0.44F}, {1.12F, 0.56F}}};
    loft(mesh, kCornice, body);
    mesh.material(palette.slate).tint(0.8F);
    constexpr std::array<Point2, 3> kUnder = {{{1, 0.52F}, {1.36F, 0.46F}, {1.36F, 0.54F}}};
    loft(mesh, kUnder, outline);
    add_courses(mesh, outline, {1.36F, 0.54F}, {0.75F, 1.15F}, 2);
    add_courses(mesh, outline, {0.75F, 1.15F}, {-1, 4.6F}, 5);
    return mesh;
}

void add_spire_flag(MeshBuilder& mesh, const Palette& palette) {
    add_flag(mesh, palette, {-1, 4.4F, 1}, 1.9F);
}

}  // namespace modelsynth::examples::castle
