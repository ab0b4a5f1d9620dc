#include "solver/examples/canyon_landmarks.h"

#include "solver/examples/canyon_props.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace modelsynth::examples {

namespace {

constexpr float kFloor = kCanyonGround;
constexpr float kHalf = kCanyonHalf;
constexpr float kTop = kCanyonCell;

// Half the width of the notch that a stair or a spring cuts into a cliff.
constexpr float kNotch = 1.05F;

// What a notch leaves of a cliff that faces east, at the cell's south and north walls.
void add_notch_sides(MeshBuilder& mesh, const std::vector<SectionStop>& section) {
    const auto south = [](int index, float distance) {
        switch (index) {
            case 0:
                return Point2{distance, kHalf};
            case 1:
                return Point2{distance, kHalf - 0.25F};
            case 2:
                return Point2{distance - 0.12F, kNotch};
            default:
                return Point2{-kHalf, kNotch};
        }
    };
    const auto north = [&south](int index, float distance) {
        const Point2 mirrored = south(3 - index, distance);
        return Point2{mirrored.u, -mirrored.v};
    };
    std::vector<SectionStop> smooth = section;
    for (SectionStop& stop : smooth) {
        stop.seed = 0;
    }
    sweep_section(mesh, south, 3, smooth);
    sweep_section(mesh, north, 3, smooth);
}

}  // namespace

MeshBuilder make_stream(const CanyonPalette& palette) {
    MeshBuilder mesh;
    const Contour contour(CliffShape::kEdge);
    sweep_section(
        mesh,
        contour,
        {{1.05F, kFloor, palette.orange},
         {0.82F, 0.2F, palette.water, 301},
         {-0.82F, 0.2F, palette.orange, 302},
         {-1.05F, kFloor, palette.orange}}
    );
    mesh.material(palette.sand);
    ground_outside(mesh, contour, {1.05F, kFloor, palette.sand});
    ground_inside(mesh, contour, {-1.05F, kFloor, palette.sand});
    add_lump(mesh, {0.75F, 0.1F, -0.6F}, 0.2F, 0.3F, palette.red, 303);
    add_lump(mesh, {-0.3F, 0.1F, 0.5F}, 0.16F, 0.2F, palette.cream, 304);
    add_tuft(mesh, {-1.15F, kFloor, 0.2F}, 0.5F, palette.green, 305);
    add_tuft(mesh, {1.2F, kFloor, 0.8F}, 0.35F, palette.green, 306);
    return mesh;
}

MeshBuilder make_stream_bend(const CanyonPalette& palette) {
    MeshBuilder mesh;
    const Contour contour(CliffShape::kConcave);
    sweep_section(
        mesh,
        contour,
        {{1.05F, kFloor, palette.orange},
         {0.82F, 0.2F, palette.water},
         {-0.82F, 0.2F, palette.orange, 311},
         {-1.05F, kFloor, palette.orange}}
    );
    mesh.material(palette.sand);
    ground_outside(mesh, contour, {1.05F, kFloor, palette.sand});
    ground_inside(mesh, contour, {-1.05F, kFloor, palette.sand});
    add_lump(mesh, {-0.9F, kFloor - 0.05F, 0.8F}, 0.35F, 0.4F, palette.red, 312);
    add_tuft(mesh, {-1.1F, kFloor, 0.2F}, 0.5F, palette.green, 313);
    add_tuft(mesh, {1.2F, kFloor, -1.2F}, 0.35F, palette.green, 314);
    return mesh;
}

MeshBuilder make_pool(const CanyonPalette& palette) {
    MeshBuilder mesh;
    // A line that comes in by the south wall, goes round and out again.
    constexpr int kParts = 14;
    constexpr int kStraight = 2;
    constexpr float kPoolMiddle = 0.15F;  // where the round part begins, south of the cell's middle
    const auto line = [](int index, float distance) {
        if (index < kStraight) {
            const float z = index == 0 ? kHalf : kHalf - 0.5F;
            return Point2{distance, z};
        }
        if (index > kParts - kStraight) {
            const float z = index == kParts ? kHalf : kHalf - 0.5F;
            return Point2{-distance, z};
        }
        const float turn = std::numbers::pi_v<float> * static_cast<float>(index - kStraight) /
                           (kParts - 2 * kStraight);
        return Point2{distance * std::cos(turn), kPoolMiddle - distance * std::sin(turn)};
    };
    sweep_section(
        mesh,
        line,
        kParts,
        {{1.05F, kFloor, palette.orange}, {0.82F, 0.2F, palette.water}, {0, 0.2F, palette.water}}
    );
    mesh.material(palette.sand);
    const auto out = [&line](int index) {
        const Point2 point = line(index, 1.05F);
        if (index <= kStraight || index >= kParts - kStraight) {
            return Vec3{std::copysign(kHalf, point.u), kFloor, point.v};
        }
        const float to_side = kHalf / std::max(0.01F, std::abs(point.u));
        const float to_back = (kHalf + kPoolMiddle) / (kPoolMiddle - point.v);
        return to_side < to_back
                   ? Vec3{std::copysign(kHalf, point.u), kFloor, kPoolMiddle + (point.v - kPoolMiddle) * to_side}
                   : Vec3{point.u * to_back, kFloor, -kHalf};
    };
    for (int i = 0; i < kParts; ++i) {
        const Point2 a = line(i, 1.05F);
        const Point2 b = line(i + 1, 1.05F);
        mesh.quad({a.u, kFloor, a.v}, out(i), out(i + 1), {b.u, kFloor, b.v});
        if ((out(i).z == -kHalf) != (out(i + 1).z == -kHalf)) {  // the quad cuts the cell's corner
            const float side = std::copysign(kHalf, out(i).x + out(i + 1).x);
            mesh.triangle(out(i), {side, kFloor, -kHalf}, out(i + 1));
        }
    }
    for (const float x : {-1.15F, 1.15F}) {
        add_tuft(mesh, {x, kFloor, 0.3F}, 0.6F, palette.green, x > 0 ? 321U : 322U);
    }
    add_tuft(mesh, {0.4F, kFloor, -1.2F}, 0.7F, palette.green, 323);
    add_tuft(mesh, {-0.6F, kFloor, -1.15F}, 0.5F, palette.green, 324);
    add_lump(mesh, {-0.95F, kFloor - 0.05F, -0.85F}, 0.3F, 0.35F, palette.red, 325);
    return mesh;
}

MeshBuilder make_spring(const CanyonPalette& palette) {
    MeshBuilder mesh;
    const std::vector<SectionStop> section = cliff_section(palette, CliffKind::kValleyFoot);
    // Below, the cliff is cut by a notch; above, it goes on as the lintel of a cave.
    constexpr float kLintel = 2.0F;
    std::vector<SectionStop> below;
    std::vector<SectionStop> above;
    for (const SectionStop& stop : section) {
        if (stop.y <= kLintel && above.empty() && !(stop.y == kLintel && stop.distance == 0)) {
            below.push_back(stop);
        } else {
            above.push_back(stop);
        }
    }
    below.push_back({0, kLintel, palette.orange});
    add_notch_sides(mesh, below);
    const Contour edge(CliffShape::kEdge);
    sweep_section(mesh, edge, above);
    mesh.material(palette.dark).tint(0.45F);
    mesh.quad(
        {-1.0F, 0, kNotch}, {-1.0F, 0, -kNotch}, {-1.0F, kLintel, -kNotch}, {-1.0F, kLintel, kNotch}
    );
    for (int i = 0; i < Contour::kSegments; ++i) {  // the cave's ceiling up to the lintel
        const float depth = above.front().seed == 0 ? 0 : 0.12F;
        const Point2 a = edge.at(i, depth);
        const Point2 b = edge.at(i + 1, depth);
        mesh.quad(
            {-1.0F, kLintel, b.v}, {b.u, kLintel, b.v}, {a.u, kLintel, a.v}, {-1.0F, kLintel, a.v}
        );
    }
    mesh.tint(1);
    shade_cliff(mesh, CliffKind::kValleyFoot);
    mesh.turned(1, [&](MeshBuilder& turned) {
        const MaterialId bank = palette.orange;
        for (const float side : {-1.0F, 1.0F}) {
            const auto strip = [&](float u0, float y0, float u1, float y1) {
                // From the water outwards; the hand depends on the side.
                if (side > 0) {
                    turned.quad({u0, y0, kHalf}, {u1, y1, kHalf}, {u1, y1, -1.0F}, {u0, y0, -1.0F});
                } else {
                    turned.quad(
                        {-u1, y1, kHalf}, {-u0, y0, kHalf}, {-u0, y0, -1.0F}, {-u1, y1, -1.0F}
                    );
                }
            };
            turned.material(bank);
            strip(0.82F, 0.2F, 1.05F, kFloor);
            turned.material(palette.sand);
            strip(1.05F, kFloor, kHalf, kFloor);
        }
        turned.material(palette.water);
        turned.quad(
            {-0.82F, 0.2F, kHalf}, {0.82F, 0.2F, kHalf}, {0.82F, 0.2F, -1.0F}, {-0.82F, 0.2F, -1.0F}
        );
    });
    return mesh;
}

MeshBuilder make_stair(const CanyonPalette& palette, CliffKind foot) {
    MeshBuilder mesh;
    const bool in_valley = foot == CliffKind::kValleyFoot;
    add_notch_sides(mesh, cliff_section(palette, foot));
    shade_cliff(mesh, foot);
    mesh.material(palette.cream).tint(0.96F, 0.88F, 0.8F);
    constexpr int kSteps = 10;
    constexpr float kFirst = 1.3F;
    mesh.turned(1, [](MeshBuilder& turned) {
        const float run = (kFirst + kHalf) / kSteps;
        const float rise = kTop / kSteps;
        for (int step = 0; step < kSteps; ++step) {
            const auto index = static_cast<float>(step);
            const float z = kFirst - run * index;
            const float y = kFloor + rise * index;
            turned.quad(
                {-kNotch, y, z}, {kNotch, y, z}, {kNotch, y + rise, z}, {-kNotch, y + rise, z}
            );
            turned.quad(
                {-kNotch, y + rise, z},
                {kNotch, y + rise, z},
                {kNotch, y + rise, z - run},
                {-kNotch, y + rise, z - run}
            );
            for (const float side : {-1.0F, 1.0F}) {  // visible where they stand out of the cliff
                if (z > 0) {
                    const float x = side * kNotch;
                    const float near = side > 0 ? z : z - run;
                    const float far = side > 0 ? z - run : z;
                    turned.quad(
                        {x, kFloor, near}, {x, kFloor, far}, {x, y + rise, far}, {x, y + rise, near}
                    );
                }
            }
        }
    });
    mesh.tint(1).shade([](const Vec3& position, const Vec3&) {
        return position.y <= kFloor ? 0.85F : 1.0F;
    });
    mesh.material(in_valley ? palette.sand : palette.grass);
    mesh.open_box({{0, 0, -kHalf}, {kHalf, kFloor, kHalf}}, "U");
    return mesh;
}

MeshBuilder make_stair_head(const CanyonPalette& palette) {
    MeshBuilder mesh;
    const std::vector<SectionStop> section = cliff_section(palette, CliffKind::kRim);
    add_notch_sides(mesh, section);
    shade_cliff(mesh, CliffKind::kRim);
    mesh.material(palette.grass);
    const float lip = section.back().distance - 0.12F;
    mesh.open_box({{-kHalf, 0, kNotch}, {lip, kFloor, kHalf}}, "U");
    mesh.open_box({{-kHalf, 0, -kHalf}, {lip, kFloor, -kNotch}}, "U");
    mesh.material(palette.cream);
    mesh.open_box({{lip, 0, kNotch}, {section.back().distance, kFloor, kHalf}}, "U");
    mesh.open_box({{lip, 0, -kHalf}, {section.back().distance, kFloor, -kNotch}}, "U");
    return mesh;
}

MeshBuilder make_bridge(const CanyonPalette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.wood);
    constexpr int kPlanks = 8;
    for (int plank = 0; plank < kPlanks; ++plank) {
        const float middle = -kHalf + kCanyonCell * (static_cast<float>(plank) + 0.5F) / kPlanks;
        const float sway = 0.05F * (scatter(401, static_cast<std::uint32_t>(plank)) - 0.5F);
        mesh.tint(0.8F + 0.5F * scatter(402, static_cast<std::uint32_t>(plank)));
        mesh.box({{middle - 0.15F, 0.42F, -0.62F + sway}, {middle + 0.15F, 0.5F, 0.62F + sway}});
    }
    mesh.tint(0.7F);
    for (const float z : {-0.6F, 0.54F}) {
        mesh.open_box({{-kHalf, 0.34F, z}, {kHalf, 0.42F, z + 0.06F}}, "UDSN");
        mesh.open_box({{-kHalf, 1.2F, z}, {kHalf, 1.27F, z + 0.06F}}, "UDSN");
        for (const float x : {-0.75F, 0.75F}) {
            mesh.open_box({{x - 0.03F, 0.42F, z}, {x + 0.03F, 1.2F, z + 0.06F}}, "EWSN");
        }
    }
    mesh.tint(1);
    return mesh;
}

MeshBuilder make_bridge_head(const CanyonPalette& palette) {
    MeshBuilder mesh = make_cliff(palette, CliffKind::kRim, CliffShape::kEdge);
    mesh.material(palette.wood);
    for (int plank = 0; plank < 5; ++plank) {
        const float middle = -0.25F + 0.375F * static_cast<float>(plank);
        mesh.tint(0.8F + 0.5F * scatter(403, static_cast<std::uint32_t>(plank)));
        mesh.box({{middle - 0.15F, 0.42F, -0.62F}, {middle + 0.15F, 0.53F, 0.62F}});
    }
    mesh.tint(0.7F);
    for (const float z : {-0.6F, 0.54F}) {
        mesh.open_box({{0.1F, 0.34F, z}, {kHalf, 0.42F, z + 0.06F}}, "UDSN");
        mesh.open_box({{-0.35F, 1.2F, z}, {kHalf, 1.27F, z + 0.06F}}, "UDSNW");
        mesh.box({{-0.42F, kFloor, z - 0.05F}, {-0.26F, 1.55F, z + 0.11F}});
    }
    mesh.tint(1);
    return mesh;
}

}  // namespace modelsynth::examples
