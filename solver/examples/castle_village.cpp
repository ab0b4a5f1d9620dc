#include "solver/examples/castle_village.h"

#include <algorithm>
#include <array>

namespace modelsynth::examples::castle {

namespace {

constexpr float kDepth = 0.78F;
constexpr float kEaves = 0.97F;
constexpr float kWallTop = 1.55F;
constexpr float kRidge = 3.0F;
constexpr float kEast = 0.8F;

// A beam that stands out of a wall that faces south.
void add_beam(MeshBuilder& face, const Palette& palette, const Panel& panel) {
    face.material(palette.wood).tint(0.9F);
    face.open_box(
        {{panel.x0, panel.y0, kDepth - 0.02F}, {panel.x1, panel.y1, kDepth + 0.04F}}, "EWUDS"
    );
}

// Wall and slope towards the south, from x0 to x1; the roof from `roof0` to `roof1`.
void add_front(
    MeshBuilder& mesh, const Palette& palette, float x0, float x1, float roof0, float roof1
) {
    mesh.material(palette.plaster).tint(1);
    mesh.quad(
        {x0, 0.3F, kDepth}, {x1, 0.3F, kDepth}, {x1, kWallTop, kDepth}, {x0, kWallTop, kDepth}
    );
    mesh.material(palette.trim).tint(0.9F);
    mesh.open_box({{x0, 0, 0}, {x1, 0.3F, kDepth + 0.05F}}, x1 < 1 ? "EUS" : "US");
    add_beam(mesh, palette, {x0, x1, 0.3F, 0.4F});
    add_beam(mesh, palette, {x0, x1, 1.4F, 1.5F});
    mesh.material(palette.wood).tint(0.85F);
    constexpr std::array<Point2, 2> kUnder = {{{kDepth, 1.48F}, {kEaves, 1.26F}}};
    const Outline along = [&](float out) {
        return std::vector<Point2>{{roof0, out}, {roof1, out}};
    };
    loft(mesh, kUnder, along);
    mesh.material(palette.tile).tint(0.9F);
    constexpr std::array<Point2, 2> kBoard = {{{kEaves, 1.26F}, {kEaves, 1.38F}}};
    loft(mesh, kBoard, along);
    add_courses(mesh, along, {kEaves, 1.38F}, {0, kRidge}, 5);
}

void add_cottage_window(MeshBuilder& face, const Palette& palette, float x) {
    face.material(palette.dark).tint(1);
    const float z = kDepth + 0.012F;
    face.quad({x - 0.2F, 0.75F, z}, {x + 0.2F, 0.75F, z}, {x + 0.2F, 1.2F, z}, {x - 0.2F, 1.2F, z});
    add_beam(face, palette, {x - 0.27F, x - 0.2F, 0.7F, 1.25F});
    add_beam(face, palette, {x + 0.2F, x + 0.27F, 0.7F, 1.25F});
    add_beam(face, palette, {x - 0.3F, x + 0.3F, 0.68F, 0.75F});
    add_beam(face, palette, {x - 0.27F, x + 0.27F, 1.2F, 1.26F});
    face.material(palette.flag).tint(1);
    face.open_box({{x - 0.28F, 0.6F, z}, {x + 0.28F, 0.7F, z + 0.14F}}, "EWUDS");
}

void add_cottage_door(MeshBuilder& face, const Palette& palette, float x) {
    face.material(palette.wood).tint(1);
    face.open_box({{x - 0.24F, 0, kDepth}, {x + 0.24F, 1.15F, kDepth + 0.07F}}, "EWUS");
    add_beam(face, palette, {x - 0.32F, x - 0.24F, 0, 1.24F});
    add_beam(face, palette, {x + 0.24F, x + 0.32F, 0, 1.24F});
    add_beam(face, palette, {x - 0.32F, x + 0.32F, 1.15F, 1.24F});
    face.material(palette.paving);
    face.bevelled_box({{x - 0.32F, 0, kDepth}, {x + 0.32F, 0.08F, 0.98F}}, 0.03F);
}

// The gable that looks east.
void add_gable(MeshBuilder& mesh, const Palette& palette) {
    const float peak = kRidge - 0.05F;
    mesh.material(palette.plaster).tint(0.97F);
    mesh.quad(
        {kEast, 0.3F, kDepth},
        {kEast, 0.3F, -kDepth},
        {kEast, kWallTop, -kDepth},
        {kEast, kWallTop, kDepth}
    );
    mesh.triangle({kEast, kWallTop, kDepth}, {kEast, kWallTop, -kDepth}, {kEast, peak, 0});
    mesh.material(palette.wood).tint(0.9F);
    const auto beam = [&](float y0, float y1, float z0, float z1) {
        mesh.open_box({{kEast - 0.02F, y0, z0}, {kEast + 0.04F, y1, z1}}, "EUDSN");
    };
    beam(1.4F, 1.5F, -kDepth, kDepth);
    beam(0.3F, 1.4F, -0.05F, 0.05F);
    beam(1.5F, 2.75F, -0.05F, 0.05F);
    beam(2.05F, 2.13F, -0.42F, 0.42F);
    // Barge boards, as thick as the roof.
    mesh.tint(0.8F);
    for (const float sign : {-1.0F, 1.0F}) {
        const Vec3 low = {0.95F, 1.26F, sign * kEaves};
        const Vec3 top = {0.95F, kRidge - 0.1F, 0};
        const Vec3 low_up = {0.95F, 1.4F, sign * kEaves};
        const Vec3 top_up = {0.95F, kRidge, 0};
        const Vec3 in_low = {kEast, 1.26F, sign * kEaves};
        const Vec3 in_top = {kEast, kRidge - 0.1F, 0};
        if (sign > 0) {
            mesh.quad(low, top, top_up, low_up).quad(in_low, in_top, top, low);
        } else {
            mesh.quad(top, low, low_up, top_up).quad(in_top, in_low, low, top);
        }
    }
}

// Bunches of ears, from `north` to the south of the cell.
void add_wheat(MeshBuilder& mesh, const Palette& palette, float north) {
    mesh.material(palette.wheat);
    std::uint32_t index = 0;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const float x0 = -1 + 0.42F * static_cast<float>(column);
            const float z1 = 1 - 0.5F * static_cast<float>(row);
            const float z0 = std::max(z1 - 0.44F, north);
            if (z1 - z0 < 0.3F) {
                continue;
            }
            const float top = 0.36F + 0.16F * scatter(82, ++index);
            mesh.tint(0.84F + 0.16F * scatter(83, index));
            mesh.bevelled_box({{x0 + 0.03F, 0, z0}, {x0 + 0.38F, top, z1}}, 0.08F);
        }
    }
    mesh.tint(1);
}

// Posts and two rails along the east of the cell, from `north` to its south.
void add_fence(MeshBuilder& mesh, const Palette& palette, float north) {
    mesh.material(palette.wood).tint(1);
    for (const float z : {-0.75F, 0.25F}) {
        mesh.open_box({{0.74F, 0, z - 0.06F}, {0.86F, 0.66F, z + 0.06F}}, "EWUSN");
    }
    mesh.tint(0.92F);
    for (const float y : {0.25F, 0.48F}) {
        mesh.open_box({{0.78F, y, north}, {0.82F, y + 0.09F, 1}}, "EWUDSN");
    }
    mesh.tint(1);
}

}  // namespace

MeshBuilder make_cottage_end(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_front(mesh, palette, -1, kEast, -1, 0.95F);
    add_beam(mesh, palette, {0.68F, 0.8F, 0.3F, 1.5F});
    add_cottage_door(mesh, palette, -0.1F);
    mesh.turned(2, [&](MeshBuilder& back) {
        back.mirrored([&](MeshBuilder& front) {
            add_front(front, palette, -1, kEast, -1, 0.95F);
            add_beam(front, palette, {0.68F, 0.8F, 0.3F, 1.5F});
            add_cottage_window(front, palette, -0.1F);
        });
    });
    add_gable(mesh, palette);
    return mesh;
}

MeshBuilder make_cottage_middle(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    for (const int turns : {0, 2}) {
        mesh.turned(turns, [&](MeshBuilder& front) {
            add_front(front, palette, -1, 1, -1, 1);
            add_beam(front, palette, {-0.06F, 0.06F, 0.3F, 1.4F});
            add_cottage_window(front, palette, -0.5F);
            add_cottage_window(front, palette, 0.5F);
        });
    }
    mesh.material(palette.trim).tint(1);
    mesh.open_box({{-0.22F, 2.4F, -0.22F}, {0.22F, 3.5F, 0.22F}}, "EWSN");
    mesh.material(palette.stone).tint(0.95F);
    mesh.bevelled_box({{-0.28F, 3.5F, -0.28F}, {0.28F, 3.62F, 0.28F}}, 0.04F);
    return mesh;
}

MeshBuilder make_field_corner(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_wheat(mesh, palette, -0.6F);
    add_fence(mesh, palette, -0.8F);
    mesh.turned(1, [&](MeshBuilder& north) {
        // As seen from the north the corner lies in the west.
        north.mirrored([&](MeshBuilder& fence) { add_fence(fence, palette, -0.8F); });
    });
    return mesh;
}

MeshBuilder make_field_side(const Palette& palette) {
    MeshBuilder mesh;
    add_grass(mesh, palette);
    add_wheat(mesh, palette, -1);
    add_fence(mesh, palette, -1);
    return mesh;
}

}  // namespace modelsynth::examples::castle
