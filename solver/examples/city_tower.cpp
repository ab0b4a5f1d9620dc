#include "solver/examples/city_tower.h"

#include "solver/examples/city_facade.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr Opening kWhole = {-kCityHalf, kCityHalf, 0, kCityStorey};

// Both sides of a quarter. The tower goes on to the left of its east side and to the right of its
// north side; u = +2 of the first and u = -2 of the second are its corner.
template <class Facade>
MeshBuilder make_quarter(const Facade& facade) {
    return make_corner(
        [&](MeshBuilder& mesh, RightEnd end) { facade(mesh, end); },
        [&](MeshBuilder& mesh, RightEnd end) { facade(mesh, end); }
    );
}

float towards_corner(RightEnd end) { return end == RightEnd::kCorner ? 1.0F : -1.0F; }

void add_corner_pier(MeshBuilder& mesh, const CityMaterials& m, float v0, float v1, RightEnd end) {
    mesh.material(m.stone).tint(0.95F);
    if (end == RightEnd::kCorner) {
        mesh.open_box({{1.45F, v0, kCityHalf}, {2.1F, v1, kCityHalf + 0.1F}}, "SWENU");
    } else {
        mesh.open_box({{-kCityHalf, v0, kCityHalf}, {-1.45F, v1, kCityHalf + 0.1F}}, "SEU");
    }
}

// Half a clock face about the middle of the tower's side.
void add_half_clock(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    constexpr float kMiddle = 1.6F;
    const float inner = -kCityHalf * towards_corner(end);
    const float away = towards_corner(end);
    const auto fan = [&](float radius, float z) {
        constexpr std::array<Point2, 5> kArc = {
            {{0, -1}, {0.7071F, -0.7071F}, {1, 0}, {0.7071F, 0.7071F}, {0, 1}}};
        for (std::size_t i = 0; i + 1 < kArc.size(); ++i) {
            const Vec3 centre = {inner, kMiddle, z};
            const Vec3 a = {inner + away * radius * kArc[i].u, kMiddle + radius * kArc[i].v, z};
            const Vec3 b = {
                inner + away * radius * kArc[i + 1].u, kMiddle + radius * kArc[i + 1].v, z};
            if (away > 0) {
                mesh.triangle(centre, a, b);
            } else {
                mesh.triangle(centre, b, a);
            }
        }
    };
    mesh.material(m.accent).tint(0.8F);
    fan(1.25F, kCityHalf + 0.04F);
    mesh.material(m.plaster).tint(1);
    fan(1.08F, kCityHalf + 0.07F);
    mesh.material(m.iron).tint(0.8F);
    const float hand0 = std::min(inner, inner + away * (end == RightEnd::kCorner ? 0.75F : 0.05F));
    const float hand1 = std::max(inner, inner + away * (end == RightEnd::kCorner ? 0.75F : 0.05F));
    mesh.quad(
        {hand0, kMiddle - 0.05F, kCityHalf + 0.1F},
        {hand1, kMiddle - 0.05F, kCityHalf + 0.1F},
        {hand1, kMiddle + 0.05F, kCityHalf + 0.1F},
        {hand0, kMiddle + 0.05F, kCityHalf + 0.1F}
    );
    const float up0 = std::min(inner, inner + away * 0.05F);
    const float up1 = std::max(inner, inner + away * 0.05F);
    mesh.quad(
        {up0, kMiddle, kCityHalf + 0.1F},
        {up1, kMiddle, kCityHalf + 0.1F},
        {up1, kMiddle + 0.95F, kCityHalf + 0.1F},
        {up0, kMiddle + 0.95F, kCityHalf + 0.1F}
    );
}

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3&, const Vec3& normal) { return normal.y < -0.5F ? 0.8F : 1.0F; });
    return mesh;
}

}  // namespace

MeshBuilder make_tower_ground(const CityMaterials& materials) {
    MeshBuilder mesh = make_quarter([&](MeshBuilder& part, RightEnd end) {
        const std::array<Opening, 1> window = {{{-0.35F, 0.35F, 1.2F, 2.3F, false}}};
        add_wall(part, materials, materials.brick, kWhole, window, 0.3F);
        add_corner_pier(part, materials, 0.5F, 2.75F, end);
        part.material(materials.stone).tint(0.85F);
        add_band(part, 0, 0.5F, 0.15F, end);
        part.material(materials.stone).tint(1);
        add_band(part, 2.75F, kCityStorey, 0.18F, end);
    });
    mesh.shade_upwards(0.85F, 1.5F);
    return mesh;
}

MeshBuilder make_tower_shaft(const CityMaterials& materials) {
    return shaded(make_quarter([&](MeshBuilder& part, RightEnd end) {
        const std::array<Opening, 1> window = {{{-0.3F, 0.3F, 0.8F, 2.2F, false}}};
        add_wall(part, materials, materials.brick, kWhole, window, 0.3F);
        part.material(materials.stone).tint(0.95F);
        add_block(part, -0.45F, 0.45F, 0.66F, 0.8F, 0.1F);
        add_block(part, -0.45F, 0.45F, 2.2F, 2.42F, 0.08F);
        add_corner_pier(part, materials, 0, kCityStorey, end);
    }));
}

MeshBuilder make_tower_belfry(const CityMaterials& materials) {
    return shaded(make_quarter([&](MeshBuilder& part, RightEnd end) {
        add_wall(part, materials, materials.stone, kWhole, {}, 0.3F);
        part.material(materials.stone).tint(1);
        add_band(part, 0, 0.2F, 0.2F, end);
        add_band(part, 2.75F, kCityStorey, 0.3F, end);
        add_half_clock(part, materials, end);
    }));
}

MeshBuilder make_tower_spire(const CityMaterials& materials) {
    // Each quarter has two half sides of the pyramid, whose top is above the tower's middle.
    constexpr float kTop = 7;
    constexpr float kOut = 2.45F;
    MeshBuilder mesh;
    const Vec3 top = {-kCityHalf, kTop, kCityHalf};
    const Vec3 corner = {kOut, 0, -kOut};
    const Vec3 east = {kOut, 0, kCityHalf};
    const Vec3 north = {-kCityHalf, 0, -kOut};
    // Courses: the pyramid in four slices of two tints.
    const auto between = [](const Vec3& a, const Vec3& b, float t) {
        return Vec3{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t};
    };
    mesh.material(materials.tile);
    for (int slice = 0; slice < 5; ++slice) {
        const float low = static_cast<float>(slice) / 5;
        const float high = static_cast<float>(slice + 1) / 5;
        mesh.tint(slice % 2 == 0 ? 1.0F : 0.88F);
        const auto side = [&](const Vec3& right, const Vec3& left) {
            if (slice == 4) {
                mesh.triangle(between(left, top, low), between(right, top, low), top);
            } else {
                mesh.quad(
                    between(left, top, low),
                    between(right, top, low),
                    between(right, top, high),
                    between(left, top, high)
                );
            }
        };
        side(corner, east);
        side(north, corner);
    }
    mesh.material(materials.iron).tint(1);
    mesh.open_box(
        {{-kCityHalf, kTop - 0.3F, kCityHalf - 0.06F}, {-1.94F, kTop + 1.2F, kCityHalf}}, "EN"
    );
    // Pinnacles on the corners.
    mesh.material(materials.stone).tint(1);
    mesh.bevelled_box({{1.75F, 0, -2.25F}, {2.25F, 0.9F, -1.75F}}, 0.04F);
    mesh.material(materials.tile).tint(0.95F);
    mesh.hip_roof({{1.75F, 0.9F, -2.25F}, {2.25F, 1.7F, -1.75F}}, 0.06F);
    mesh.material(materials.tile).tint(0.7F);
    mesh.quad(
        {-kCityHalf, 0, kCityHalf}, {-kCityHalf, 0, -kOut}, {kOut, 0, -kOut}, {kOut, 0, kCityHalf}
    );
    return shaded(std::move(mesh));
}

}  // namespace modelsynth::examples
