#include "solver/examples/castle_shapes.h"

#include <algorithm>
#include <array>

namespace modelsynth::examples::castle {

void loft(MeshBuilder& mesh, std::span<const Point2> profile, const Outline& outline) {
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const std::vector<Point2> low = outline(profile[i].u);
        const std::vector<Point2> high = outline(profile[i + 1].u);
        const float y0 = profile[i].v;
        const float y1 = profile[i + 1].v;
        for (std::size_t p = 0; p + 1 < low.size(); ++p) {
            mesh.quad(
                {low[p].u, y0, low[p].v},
                {low[p + 1].u, y0, low[p + 1].v},
                {high[p + 1].u, y1, high[p + 1].v},
                {high[p].u, y1, high[p].v}
            );
        }
    }
}

Outline cut_square(float cut) {
    return [cut](float out) {
        const float c = std::min(cut, out);
        const float o = out;
        return std::vector<Point2>{
            {o, o - c},
            {o, c - o},
            {o - c, -o},
            {c - o, -o},
            {-o, c - o},
            {-o, o - c},
            {c - o, o},
            {o - c, o},
            {o, o - c}};
    };
}

void cap(MeshBuilder& mesh, const Outline& outline, float out, float y) {
    const std::vector<Point2> points = outline(out);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        mesh.triangle(
            {points[0].u, y, points[0].v},
            {points[i].u, y, points[i].v},
            {points[i + 1].u, y, points[i + 1].v}
        );
    }
}

void add_blocks(
    MeshBuilder& mesh,
    const Palette& palette,
    std::uint32_t seed,
    const Panel& panel,
    float z,
    float share
) {
    constexpr float kCourse = 1.0F / 3;
    constexpr float kLength = 0.5F;
    constexpr float kJoint = 0.02F;
    constexpr float kProud = 0.025F;
    mesh.material(palette.stone);
    std::uint32_t index = 0;
    for (int course = 0; course < 6; ++course) {
        const float y0 = static_cast<float>(course) * kCourse + kJoint;
        const float y1 = y0 + kCourse - 2 * kJoint;
        for (int place = -3; place < 3; ++place) {
            const float shift = course % 2 == 0 ? 0.0F : kLength / 2;
            const float x0 = static_cast<float>(place) * kLength + shift + kJoint;
            const float x1 = x0 + kLength - 2 * kJoint;
            index += 2;
            if (x0 < panel.x0 || x1 > panel.x1 || y0 < panel.y0 || y1 > panel.y1 ||
                scatter(seed, index) > share) {
                continue;
            }
            mesh.tint(0.84F + 0.16F * scatter(seed, index + 1));
            mesh.open_box({{x0, y0, z - 0.01F}, {x1, y1, z + kProud}}, "EWUDS");
        }
    }
    mesh.tint(kStoneTint);
}

void add_window(MeshBuilder& mesh, const Palette& palette, const Panel& panel, float z) {
    constexpr float kFrame = 0.1F;
    constexpr float kProud = 0.07F;
    const auto& [x0, x1, y0, y1] = panel;
    const float middle = (x0 + x1) / 2;
    const float head = y1 - (x1 - x0) * 0.45F;
    mesh.material(palette.dark).tint(1);
    const std::array<Vec3, 5> pane = {
        {{x0, y0, z + 0.012F},
         {x1, y0, z + 0.012F},
         {x1, head, z + 0.012F},
         {middle, y1, z + 0.012F},
         {x0, head, z + 0.012F}}};
    mesh.quad(pane[0], pane[1], pane[2], pane[4]).triangle(pane[4], pane[2], pane[3]);
    mesh.material(palette.trim);
    mesh.open_box({{x0 - kFrame, y0, z}, {x0, head, z + kProud}}, "EWS");
    mesh.open_box({{x1, y0, z}, {x1 + kFrame, head, z + kProud}}, "EWS");
    const std::array<Point2, 4> left = {
        {{x0 - kFrame, head}, {x0, head}, {middle, y1}, {middle, y1 + kFrame * 1.4F}}};
    const std::array<Point2, 4> right = {
        {{x1, head}, {x1 + kFrame, head}, {middle, y1 + kFrame * 1.4F}, {middle, y1}}};
    mesh.extrude(left, z, z + kProud).extrude(right, z, z + kProud);
    mesh.open_box(
        {{x0 - kFrame - 0.05F, y0 - 0.1F, z}, {x1 + kFrame + 0.05F, y0, z + kProud + 0.06F}},
        "EWUDS"
    );
    mesh.tint(kStoneTint);
}

void add_corbels(MeshBuilder& mesh, const Palette& palette, float x0, float x1, float z, float y) {
    mesh.material(palette.trim).tint(1);
    for (int i = 0; i < 4; ++i) {
        const float x = -0.75F + 0.5F * static_cast<float>(i);
        if (x - 0.09F < x0 || x + 0.09F > x1) {
            continue;
        }
        mesh.open_box(
            {{x - 0.08F, y - 0.34F, z - 0.01F}, {x + 0.08F, y - 0.16F, z + 0.07F}}, "EWDS"
        );
        mesh.open_box(
            {{x - 0.08F, y - 0.16F, z - 0.01F}, {x + 0.08F, y + 0.1F, z + 0.16F}}, "EWUDS"
        );
    }
    mesh.tint(kStoneTint);
}

void add_courses(
    MeshBuilder& mesh, const Outline& outline, const Point2& from, const Point2& to, int courses
) {
    constexpr float kLip = 0.06F;
    for (int i = 0; i < courses; ++i) {
        const auto at = [&](int step, float lift) {
            const float t = static_cast<float>(step) / static_cast<float>(courses);
            return Point2{from.u + (to.u - from.u) * t, from.v + (to.v - from.v) * t + lift};
        };
        mesh.tint(i % 2 == 0 ? 0.86F : 0.97F);
        // The last course ends in the ridge itself: the slope beyond has to meet it.
        const std::array<Point2, 3> profile = {{at(i, 0), at(i, kLip), at(i + 1, 0)}};
        loft(mesh, profile, outline);
    }
    mesh.tint(1);
}

void add_flag(MeshBuilder& mesh, const Palette& palette, const Vec3& foot, float height) {
    const auto& [x, y, z] = foot;
    mesh.material(palette.wood).tint(1);
    mesh.box({{x - 0.04F, y, z - 0.04F}, {x + 0.04F, y + height, z + 0.04F}});
    mesh.material(palette.gold);
    mesh.ball({x, y + height + 0.06F, z}, {0.09F, 0.09F, 0.09F}, 6);
    // Two leaves a hand apart in depth would fight from afar: one wavy prism, thick enough.
    mesh.material(palette.flag);
    constexpr std::array<float, 4> kAlong = {0.04F, 0.45F, 0.85F, 1.3F};
    constexpr std::array<float, 4> kWave = {0, 0.1F, -0.04F, 0.08F};
    constexpr std::array<float, 4> kHalf = {0.36F, 0.3F, 0.22F, 0.02F};
    const float middle = y + height - 0.42F;
    for (std::size_t i = 0; i + 1 < kAlong.size(); ++i) {
        const auto corner = [&](std::size_t at, float side, float up) {
            return Vec3{x + kAlong[at], middle + up * kHalf[at], z + kWave[at] + side};
        };
        constexpr float kThin = 0.02F;
        mesh.tint(i % 2 == 0 ? 1.0F : 0.85F);
        mesh.quad(
            corner(i, kThin, -1),
            corner(i + 1, kThin, -1),
            corner(i + 1, kThin, 1),
            corner(i, kThin, 1)
        );
        mesh.quad(
            corner(i + 1, -kThin, -1),
            corner(i, -kThin, -1),
            corner(i, -kThin, 1),
            corner(i + 1, -kThin, 1)
        );
        mesh.quad(
            corner(i, kThin, 1),
            corner(i + 1, kThin, 1),
            corner(i + 1, -kThin, 1),
            corner(i, -kThin, 1)
        );
        mesh.quad(
            corner(i, -kThin, -1),
            corner(i + 1, -kThin, -1),
            corner(i + 1, kThin, -1),
            corner(i, kThin, -1)
        );
    }
    mesh.tint(1);
}

void add_grass(MeshBuilder& mesh, const Palette& palette) {
    mesh.material(palette.grass).tint(kStoneTint);
    mesh.quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
}

void add_earth(MeshBuilder& mesh, const Palette& palette) {
    mesh.material(palette.earth).tint(kStoneTint);
    mesh.quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
}

void add_cobbles(
    MeshBuilder& mesh,
    const Palette& palette,
    std::uint32_t seed,
    const Extent& extent,
    int columns,
    int rows
) {
    mesh.material(palette.paving);
    const float width = (extent.max.x - extent.min.x) / static_cast<float>(columns);
    const float depth = (extent.max.z - extent.min.z) / static_cast<float>(rows);
    std::uint32_t index = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const auto drawn = [&] { return scatter(seed, index++); };
            const float x = extent.min.x + width * static_cast<float>(column);
            const float z = extent.min.z + depth * static_cast<float>(row);
            const Vec3 low = {
                x + width * (0.03F + 0.07F * drawn()), 0, z + depth * (0.03F + 0.07F * drawn())};
            const Vec3 high = {
                x + width * (0.97F - 0.07F * drawn()),
                extent.max.y + 0.025F * drawn(),
                z + depth * (0.97F - 0.07F * drawn())};
            mesh.tint(0.84F + 0.16F * drawn());
            mesh.open_box({low, high}, "EWUSN");
        }
    }
    mesh.tint(1);
}

}  // namespace modelsynth::examples::castle
