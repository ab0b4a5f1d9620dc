#include "solver/examples/canyon_cliffs.h"

#include "solver/examples/canyon_props.h"
#include "solver/examples/canyon_rock.h"

namespace modelsynth::examples {

MeshBuilder make_dwelling(const CanyonPalette& palette) {
    MeshBuilder mesh = make_cliff(palette, CliffKind::kMiddle, CliffShape::kEdge);
    // A ledge, and rooms that stand on it against the rock.
    mesh.material(palette.red).tint(0.95F);
    mesh.bevelled_box({{-0.1F, 0.42F, -1.25F}, {0.75F, 0.75F, 1.25F}}, 0.14F);
    const auto room = [&](float z0, float z1, float top, float front) {
        mesh.material(palette.sand).tint(0.97F);
        mesh.bevelled_box({{-0.1F, 0.74F, z0}, {front, top, z1}}, 0.05F);
        const float middle = (z0 + z1) / 2;
        mesh.material(palette.dark).tint(0.5F);
        mesh.open_box(
            {{front - 0.1F, 0.76F, middle - 0.14F}, {front + 0.01F, 1.3F, middle + 0.14F}}, "E"
        );
        mesh.material(palette.wood).tint(1);
        mesh.box({{front - 0.05F, 1.3F, middle - 0.2F}, {front + 0.05F, 1.38F, middle + 0.2F}});
        for (const float z : {z0 + 0.12F, middle, z1 - 0.12F}) {
            mesh.box(
                {{front - 0.05F, top - 0.2F, z - 0.04F}, {front + 0.14F, top - 0.12F, z + 0.04F}}
            );
        }
    };
    room(-1.1F, -0.3F, 1.75F, 0.5F);
    room(-0.22F, 0.55F, 2.05F, 0.44F);
    room(0.62F, 1.15F, 1.6F, 0.52F);
    return mesh;
}

MeshBuilder make_bushy_rim(const CanyonPalette& palette) {
    MeshBuilder mesh = make_cliff(palette, CliffKind::kRim, CliffShape::kEdge);
    constexpr float kFloor = kCanyonGround;
    add_lump(mesh, {-0.55F, kFloor - 0.03F, -0.6F}, 0.46F, 0.6F, palette.green, 611);
    add_lump(mesh, {-0.85F, kFloor - 0.03F, 0.1F}, 0.34F, 0.45F, palette.green, 612);
    add_lump(mesh, {-0.5F, kFloor - 0.03F, 0.75F}, 0.3F, 0.28F, palette.cream, 613);
    add_tuft(mesh, {-0.4F, kFloor, 0.2F}, 0.6F, palette.green, 614);
    add_tuft(mesh, {-1.0F, kFloor, -0.9F}, 0.5F, palette.grass, 615);
    return mesh;
}

MeshBuilder make_rockfall(const CanyonPalette& palette) {
    MeshBuilder mesh = make_cliff(palette, CliffKind::kValleyFoot, CliffShape::kEdge);
    constexpr float kFloor = kCanyonGround;
    add_lump(mesh, {0.75F, kFloor, -0.5F}, 0.55F, 0.85F, palette.red, 621);
    add_lump(mesh, {0.95F, kFloor - 0.03F, 0.35F}, 0.38F, 0.5F, palette.orange, 622);
    add_lump(mesh, {0.6F, kFloor, 0.85F}, 0.42F, 0.75F, palette.red, 623);
    add_lump(mesh, {1.2F, kFloor - 0.03F, -0.05F}, 0.2F, 0.22F, palette.orange, 624);
    add_tuft(mesh, {1.15F, kFloor, 0.95F}, 0.5F, palette.green, 625);
    return mesh;
}

}  // namespace modelsynth::examples
