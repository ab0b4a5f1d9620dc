#include "solver/examples/canyon_rock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace modelsynth::examples {

namespace {

constexpr float kHalf = kCanyonHalf;
constexpr float kTop = kCanyonCell;
constexpr float kFloor = kCanyonGround;

// The cracks of the beds that two pieces on top of each other share.
constexpr std::uint32_t kJointSeed = 7;

struct Ray {
    float u;
    float v;
};

Ray ray(int index) {
    const float angle = std::numbers::pi_v<float> / 2 * static_cast<float>(index) /
                        static_cast<float>(Contour::kSegments);
    return {std::cos(angle), std::sin(angle)};
}

// Corners are a little squarer than a circle; the ends stay where they are.
float squared(const Ray& r) { return 1 + 0.4F * r.u * r.v; }

// Rock breaks in blocks: neighbouring points stand out or back together. None at the cell walls.
float crack(std::uint32_t seed, int index, int segments) {
    const float depth = seed == kJointSeed ? 0.18F : 0.28F;
    if (seed == 0 || index == 0 || index == segments) {
        return 0;
    }
    static constexpr std::array<std::array<std::uint8_t, Contour::kSegments + 1>, 3> kBlocks = {
        {{0, 0, 1, 1, 1, 2, 2, 3, 3}, {0, 0, 0, 1, 2, 2, 2, 3, 3}, {0, 1, 1, 1, 1, 2, 3, 3, 3}}};
    const std::uint32_t block = kBlocks[seed % 3][static_cast<std::size_t>(index)];
    // Near the walls the breaks are shallow, or every cell would show as a brick.
    const bool at_wall = index == 1 || index == segments - 1;
    return (at_wall ? 0.3F : 1.0F) * depth * (2 * scatter(seed, block) - 1);
}

Vec3 lifted(const Point2& point, float y) { return {point.u, y, point.v}; }

Vec3 place(const Contour& contour, const SectionStop& stop, int index) {
    const float distance = stop.distance + crack(stop.seed, index, Contour::kSegments);
    return lifted(contour.at(index, distance), stop.y);
}

}  // namespace

Point2 Contour::at(int index, float distance) const {
    const Ray r = ray(index);
    switch (shape_) {
        case CliffShape::kConvex: {
            const float radius = (kHalf + distance) * squared(r);
            return {-kHalf + radius * r.u, kHalf - radius * r.v};
        }
        case CliffShape::kConcave: {
            const float radius = (kHalf - distance) * squared(r);
            return {kHalf - radius * r.v, -kHalf + radius * r.u};
        }
        case CliffShape::kEdge:
            break;
    }
    return {distance, kHalf - kCanyonCell * static_cast<float>(index) / kSegments};
}

Point2 Contour::outer(int index) const {
    const Ray r = ray(index);
    const float reach = kCanyonCell / std::max(r.u, r.v);
    switch (shape_) {
        case CliffShape::kConvex:
            return {-kHalf + reach * r.u, kHalf - reach * r.v};
        case CliffShape::kConcave:
            return {kHalf, -kHalf};
        case CliffShape::kEdge:
            break;
    }
    return {kHalf, at(index, 0).v};
}

Point2 Contour::inner(int index) const {
    const Ray r = ray(index);
    const float reach = kCanyonCell / std::max(r.u, r.v);
    switch (shape_) {
        case CliffShape::kConvex:
            return {-kHalf, kHalf};
        case CliffShape::kConcave:
            return {kHalf - reach * r.v, -kHalf + reach * r.u};
        case CliffShape::kEdge:
            break;
    }
    return {-kHalf, at(index, 0).v};
}

void sweep_section(
    MeshBuilder& mesh,
    const std::function<Point2(int index, float distance)>& line,
    int segments,
    const std::vector<SectionStop>& section
) {
    const auto place = [&](const SectionStop& stop, int index) {
        return lifted(line(index, stop.distance + crack(stop.seed, index, segments)), stop.y);
    };
    for (std::size_t k = 0; k + 1 < section.size(); ++k) {
        const SectionStop& low = section[k];
        const SectionStop& high = section[k + 1];
        mesh.material(low.material);
        for (int i = 0; i < segments; ++i) {
            mesh.tint(0.88F + 0.12F * scatter(low.seed + 100, static_cast<std::uint32_t>(i) / 2));
            mesh.quad(place(low, i), place(low, i + 1), place(high, i + 1), place(high, i));
        }
    }
    mesh.tint(1);
}

void sweep_section(
    MeshBuilder& mesh, const Contour& contour, const std::vector<SectionStop>& section
) {
    const auto line = [&contour](int index, float distance) { return contour.at(index, distance); };
    sweep_section(mesh, line, Contour::kSegments, section);
}

void ground_outside(MeshBuilder& mesh, const Contour& contour, const SectionStop& stop) {
    const auto start = [&](int index) { return place(contour, stop, index); };
    for (int i = 0; i < Contour::kSegments; ++i) {
        mesh.quad(
            start(i),
            lifted(contour.outer(i), stop.y),
            lifted(contour.outer(i + 1), stop.y),
            start(i + 1)
        );
    }
}

void ground_inside(MeshBuilder& mesh, const Contour& contour, const SectionStop& stop) {
    const auto start = [&](int index) { return place(contour, stop, index); };
    for (int i = 0; i < Contour::kSegments; ++i) {
        mesh.quad(
            lifted(contour.inner(i), stop.y),
            start(i),
            start(i + 1),
            lifted(contour.inner(i + 1), stop.y)
        );
    }
}

std::vector<SectionStop> cliff_section(const CanyonPalette& palette, CliffKind kind) {
    const auto [red, orange, cream, dark, sand, grass] = std::array{
        palette.red, palette.orange, palette.cream, palette.dark, palette.sand, palette.grass};
    switch (kind) {
        case CliffKind::kValleyFoot:
            return {
                {1.2F, kFloor, sand, 22},
                {0.95F, 0.72F, orange, 22},
                {0.62F, 1.2F, red, 22},
                {0.42F, 1.45F, red, 22},
                {0.28F, 1.5F, dark, 24},
                {0.2F, 1.8F, dark, 24},
                {0.1F, 1.8F, cream, 25},
                {0.1F, 2.0F, cream, 25},
                {0, 2.0F, orange, kJointSeed},
                {0, kTop, orange, kJointSeed}};
        case CliffKind::kMiddle:
            return {
                {0, 0, orange, kJointSeed},
                {0, 0.34F, orange, kJointSeed},
                {0.16F, 0.5F, red, 31},
                {0.1F, 1.25F, red, 31},
                {-0.04F, 1.32F, cream, 32},
                {-0.06F, 1.5F, orange, 32},
                {-0.08F, 2.0F, orange, 35},
                {-0.1F, 2.45F, red, 35},
                {-0.02F, 2.6F, orange, kJointSeed},
                {0, kTop, orange, kJointSeed}};
        case CliffKind::kRim:
            return {
                {0, 0, orange, kJointSeed},
                {0, 0.1F, orange, kJointSeed},
                {0.2F, 0.1F, cream, 41},
                {0.26F, 0.36F, cream, 41},
                {0.12F, kFloor, cream, 41},
                {-0.16F, kFloor, cream, 41}};
        case CliffKind::kTerraceFoot:
            return {
                {0.75F, kFloor, grass, 52},
                {0.45F, 0.72F, red, 52},
                {0.3F, 0.95F, red, 52},
                {0.12F, 1.0F, orange, 54},
                {0.1F, 1.5F, cream, 54},
                {0.2F, 1.5F, cream, 55},
                {0.2F, 1.72F, red, 55},
                {0.1F, 1.78F, red, 56},
                {0.06F, 2.3F, orange, 56},
                {0, 2.35F, orange, kJointSeed},
                {0, kTop, orange, kJointSeed}};
    }
    return {};
}

void shade_cliff(MeshBuilder& mesh, CliffKind kind) {
    const bool is_foot = kind == CliffKind::kValleyFoot || kind == CliffKind::kTerraceFoot;
    mesh.shade([is_foot](const Vec3& position, const Vec3& normal) {
        const float rise = is_foot ? std::clamp((position.y - kFloor) / 1.2F, 0.0F, 1.0F) : 1.0F;
        return (0.86F + 0.14F * rise) * (normal.y < -0.3F ? 0.8F : 1.0F);
    });
}

MeshBuilder make_cliff(const CanyonPalette& palette, CliffKind kind, CliffShape shape) {
    MeshBuilder mesh;
    const Contour contour(shape);
    const std::vector<SectionStop> section = cliff_section(palette, kind);
    sweep_section(mesh, contour, section);
    shade_cliff(mesh, kind);
    // What is flat has no shade, so that it meets the plain ground next to it.
    switch (kind) {
        case CliffKind::kValleyFoot:
            mesh.material(palette.sand);
            ground_outside(mesh, contour, section.front());
            break;
        case CliffKind::kTerraceFoot:
            mesh.material(palette.grass);
            ground_outside(mesh, contour, section.front());
            break;
        case CliffKind::kRim:
            mesh.material(palette.grass);
            ground_inside(mesh, contour, section.back());
            break;
        case CliffKind::kMiddle:
            break;
    }
    return mesh;
}

}  // namespace modelsynth::examples
