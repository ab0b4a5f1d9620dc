#include "solver/discrete/scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace modelsynth::discrete {

namespace {

constexpr std::int32_t kGroupColumns = 16;

Scene empty_scene(const Example& example) {
    Scene scene;
    scene.kit = example.kit;
    for (const Piece& piece : example.pieces) {
        scene.names.push_back(piece.name);
    }
    return scene;
}

Instance place(const Example& example, Label label, double x, double y, double z) {
    const Piece& piece = example.pieces[label];
    return {
        piece.mesh.value_or(kNoMesh),
        label,
        {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)},
        piece.quarter_turns};
}

}  // namespace

Scene make_scene(
    const Example& example, const GridSize& size, std::span<const Label> labels, const Box& region
) {
    Scene scene = empty_scene(example);
    const auto [width, height, depth] = example.cell;
    const auto group_of = [](std::int32_t column) { return column / kGroupColumns; };
    for (std::int32_t gz = group_of(region.min.z); gz <= group_of(region.max.z - 1); ++gz) {
        for (std::int32_t gx = group_of(region.min.x); gx <= group_of(region.max.x - 1); ++gx) {
            SceneGroup group = {"columns_" + std::to_string(gx) + "_" + std::to_string(gz), {}};
            const Box box = {
                {std::max(region.min.x, gx * kGroupColumns),
                 region.min.y,
                 std::max(region.min.z, gz * kGroupColumns)},
                {std::min(region.max.x, (gx + 1) * kGroupColumns),
                 region.max.y,
                 std::min(region.max.z, (gz + 1) * kGroupColumns)}};
            for_each_cell(box, [&](const Cell& cell) {
                const Label label = labels[size.index(cell)];
                if (label != kNoLabel && example.pieces[label].mesh) {
                    group.instances.push_back(place(
                        example,
                        label,
                        (cell.x + 0.5) * width,
                        cell.y * height,
                        (cell.z + 0.5) * depth
                    ));
                }
            });
            if (!group.instances.empty()) {
                scene.groups.push_back(std::move(group));
            }
        }
    }
    return scene;
}

Scene make_piece_sheet(const Example& example) {
    Scene scene = empty_scene(example);
    const auto columns =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(example.pieces.size()))));
    SceneGroup sheet;
    for (std::size_t label = 0; label < example.pieces.size(); ++label) {
        const double x = static_cast<double>(label % columns) * example.cell[0] * 1.5;
        const double z = static_cast<double>(label / columns) * example.cell[2] * 1.5;
        sheet.instances.push_back(place(example, static_cast<Label>(label), x, 0, z));
    }
    scene.groups.push_back(std::move(sheet));
    return scene;
}

}  // namespace modelsynth::discrete
