#include "solver/examples/city_houses.h"

#include "solver/examples/city_facade.h"

#include <array>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr Opening kWhole = {-kCityHalf, kCityHalf, 0, kCityStorey};

// Slopes, built falling to the south: the ridge is on the north wall of the cell.
constexpr float kEaves = kCityHalf + 0.38F;  // z
constexpr float kRidge = -kCityHalf;         // z
constexpr float kPitch = 0.66F;
constexpr float kSlab = 0.14F;   // thickness at verges and eaves
constexpr float kVerge = 0.22F;  // how far a roof reaches beyond its gable

float roof_y(float z) { return 0.2F + (kCityHalf - z) * kPitch; }

void add_lintel(MeshBuilder& mesh, const CityMaterials& m, const Opening& window) {
    mesh.material(m.stone).tint(0.95F);
    add_block(mesh, window.u0 - 0.12F, window.u1 + 0.12F, window.v1, window.v1 + 0.22F, 0.05F);
}

// Toothed stones on a corner: the facade with the corner on its right has the long ones.
void add_quoins(MeshBuilder& mesh, const CityMaterials& m, bool is_right, float v0) {
    constexpr float kReach = 0.05F;
    mesh.material(m.stone).tint(0.92F);
    for (int i = 0; i < 4; ++i) {
        const float v = v0 + 0.66F * static_cast<float>(i);
        const float width = (i % 2 == 0) == is_right ? 0.5F : 0.28F;
        if (is_right) {
            mesh.open_box(
                {{kCityHalf - width, v, kCityHalf},
                 {kCityHalf + kReach, v + 0.6F, kCityHalf + kReach}},
                "SUDWEN"
            );
        } else {
            mesh.open_box(
                {{-kCityHalf, v, kCityHalf}, {-kCityHalf + width, v + 0.6F, kCityHalf + kReach}},
                "SUDE"
            );
        }
    }
}

void add_shutters(MeshBuilder& mesh, const CityMaterials& m, const Opening& window) {
    mesh.material(m.accent).tint(0.86F);
    add_block(mesh, window.u0 - 0.38F, window.u0 - 0.02F, window.v0, window.v1, 0.06F);
    add_block(mesh, window.u1 + 0.02F, window.u1 + 0.38F, window.v0, window.v1, 0.06F);
}

void add_house_bands(MeshBuilder& mesh, const CityMaterials& m, bool is_ground, RightEnd end) {
    if (is_ground) {
        mesh.material(m.stone).tint(0.78F, 0.78F, 0.81F);
        add_band(mesh, 0, 0.5F, 0.1F, end);
    }
    mesh.material(m.stone).tint(0.92F);
    add_band(mesh, 2.82F, kCityStorey, 0.1F, end);
}

// Posts, rails and braces about two windows.
void add_timbers(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    constexpr float kReach = 0.05F;
    mesh.material(m.wood).tint(1);
    add_block(mesh, -kCityHalf, kCityHalf, 0.5F, 0.64F, kReach);
    add_block(mesh, -kCityHalf, kCityHalf, 2.36F, 2.5F, kReach);
    for (const float u : {-1.5F, -0.5F, 0.36F, 1.36F}) {
        add_block(mesh, u, u + 0.14F, 0.12F, 2.82F, kReach);
    }
    for (const float u : {-kCityHalf, kCityHalf - 0.1F}) {
        add_block(mesh, u, u + 0.1F, 0.12F, 2.82F, kReach);
    }
    for (const float way : {-1.0F, 1.0F}) {  // a brace on either side of the middle
        const float z = kCityHalf + kReach;
        const Vec3 foot0 = {way * 0.05F, 0.64F, z};
        const Vec3 foot1 = {way * 0.22F, 0.64F, z};
        const Vec3 head0 = {way * 0.18F, 2.36F, z};
        const Vec3 head1 = {way * 0.35F, 2.36F, z};
        if (way > 0) {
            mesh.quad(foot0, foot1, head1, head0);
        } else {
            mesh.quad(foot1, foot0, head0, head1);
        }
    }
    add_band(mesh, 0, 0.14F, 0.1F, end);
}

void add_two_windows(MeshBuilder& mesh, const CityMaterials& m, HouseStorey storey, RightEnd end) {
    const bool is_ground = storey == HouseStorey::kGround;
    const bool is_timber = storey == HouseStorey::kTimber;
    const float sill = is_ground ? 1.0F : 0.8F;
    const std::array<Opening, 2> windows = {
        {{-1.35F, -0.55F, sill, 2.3F, false}, {0.55F, 1.35F, sill, 2.3F, false}}};
    add_wall(mesh, m, is_timber ? m.plaster : m.ochre, kWhole, windows, 0.2F);
    for (const Opening& window : windows) {
        add_window_bars(mesh, m, window, 0.2F, 2, 2);
        if (!is_timber) {
            add_lintel(mesh, m, window);
        }
        if (storey == HouseStorey::kMiddle) {
            add_shutters(mesh, m, window);
        }
    }
    if (is_timber) {
        add_timbers(mesh, m, end);
    }
    add_house_bands(mesh, m, is_ground, end);
}

void add_door_front(MeshBuilder& mesh, const CityMaterials& m, RightEnd end) {
    const std::array<Opening, 2> openings = {
        {{-1.2F, -0.2F, 0.42F, 2.4F, true}, {0.55F, 1.35F, 1.0F, 2.3F, true}}};
    add_wall(mesh, m, m.ochre, kWhole, openings, 0.2F);
    add_window_bars(mesh, m, openings[1], 0.2F, 2, 2);
    add_lintel(mesh, m, openings[0]);
    add_lintel(mesh, m, openings[1]);
    add_house_bands(mesh, m, true, end);
    mesh.material(m.accent).tint(0.95F);
    mesh.open_box({{-1.15F, 0.42F, 1.8F}, {-0.25F, 2.05F, 1.88F}}, "SUEW");
    mesh.tint(0.78F);
    mesh.open_box({{-1.0F, 0.6F, 1.86F}, {-0.4F, 1.2F, 1.9F}}, "SUEW");
    mesh.open_box({{-1.0F, 1.3F, 1.86F}, {-0.4F, 1.9F, 1.9F}}, "SUEW");
    mesh.material(m.paving).tint(0.95F);
    add_block(mesh, -1.4F, 0, 0, 0.28F, 0.55F);
    add_block(mesh, -1.3F, -0.1F, 0.28F, 0.42F, 0.32F);
    // A hood over the door, and a lantern.
    mesh.material(m.tile).tint(1);
    mesh.quad({-1.4F, 2.55F, 2.55F}, {0, 2.55F, 2.55F}, {0, 2.78F, 2}, {-1.4F, 2.78F, 2});
    mesh.tint(0.78F);
    mesh.quad({0, 2.55F, 2.55F}, {-1.4F, 2.55F, 2.55F}, {-1.4F, 2.55F, 2}, {0, 2.55F, 2});
    mesh.triangle({0, 2.55F, 2.55F}, {0, 2.55F, 2}, {0, 2.78F, 2});
    mesh.triangle({-1.4F, 2.55F, 2}, {-1.4F, 2.55F, 2.55F}, {-1.4F, 2.78F, 2});
    mesh.material(m.glow).tint(1);
    add_block(mesh, 0.08F, 0.22F, 1.85F, 2.1F, 0.18F);
}

// Courses of slate from the eaves to the ridge, between u0 and u1.
void add_courses(MeshBuilder& mesh, const CityMaterials& m, float u0, float u1) {
    constexpr int kCourses = 6;
    constexpr float kLip = 0.07F;
    const float run = (kEaves - kRidge) / kCourses;
    mesh.material(m.tile);
    for (int course = 0; course < kCourses; ++course) {
        const float low = kEaves - run * static_cast<float>(course);
        const float high = low - run;
        mesh.tint(course % 2 == 0 ? 1.0F : 0.88F);
        mesh.quad(
            {u0, roof_y(low) + kLip, low},
            {u1, roof_y(low) + kLip, low},
            {u1, roof_y(high), high},
            {u0, roof_y(high), high}
        );
        mesh.tint(0.78F);
        mesh.quad(
            {u0, roof_y(low), low},
            {u1, roof_y(low), low},
            {u1, roof_y(low) + kLip, low},
            {u0, roof_y(low) + kLip, low}
        );
    }
    // Gutter, soffit, and the ridge tiles' half.
    mesh.material(m.iron).tint(0.89F);
    const float eaves_y = roof_y(kEaves);
    mesh.open_box({{u0, eaves_y - kSlab, kEaves}, {u1, eaves_y + 0.02F, kEaves + 0.12F}}, "SUD");
    mesh.material(m.wood).tint(1);
    mesh.quad(
        {u0, eaves_y - kSlab, kCityHalf - 0.1F},
        {u1, eaves_y - kSlab, kCityHalf - 0.1F},
        {u1, eaves_y - kSlab, kEaves},
        {u0, eaves_y - kSlab, kEaves}
    );
    mesh.material(m.plaster).tint(0.83F);
    mesh.open_box(
        {{u0, roof_y(kRidge) - 0.1F, kRidge}, {u1, roof_y(kRidge) + 0.1F, kRidge + 0.16F}}, "SU"
    );
    // The wall between the storey below and the slope.
    mesh.material(m.plaster).tint(0.89F);
    mesh.quad(
        {u0, -0.2F, kCityHalf}, {u1, -0.2F, kCityHalf}, {u1, 0.2F, kCityHalf}, {u0, 0.2F, kCityHalf}
    );
}

void add_dormer(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kFront = 1.3F;
    constexpr float kBack = -1.2F;
    constexpr float kHalf = 0.75F;
    const float foot = roof_y(kFront);
    constexpr float kTop = 2.1F;
    mesh.material(m.plaster).tint(0.95F);
    mesh.open_box({{-kHalf, foot - 0.1F, kBack}, {kHalf, kTop, kFront}}, "EWS");
    mesh.triangle({-kHalf, kTop, kFront}, {kHalf, kTop, kFront}, {0, kTop + 0.5F, kFront});
    mesh.material(m.glass).tint(1);
    mesh.open_box({{-0.42F, foot + 0.25F, kFront}, {0.42F, kTop - 0.1F, kFront + 0.01F}}, "S");
    mesh.material(m.stone).tint(0.95F);
    mesh.open_box({{-0.55F, foot + 0.1F, kFront}, {0.55F, foot + 0.25F, kFront + 0.12F}}, "SUDEW");
    mesh.open_box({{-0.55F, foot + 0.25F, kFront}, {-0.42F, kTop, kFront + 0.07F}}, "SUDEW");
    mesh.open_box({{0.42F, foot + 0.25F, kFront}, {0.55F, kTop, kFront + 0.07F}}, "SUDEW");
    mesh.open_box({{-0.42F, kTop - 0.1F, kFront}, {0.42F, kTop, kFront + 0.07F}}, "SUD");
    mesh.open_box({{-0.03F, foot + 0.25F, kFront}, {0.03F, kTop - 0.1F, kFront + 0.05F}}, "SEW");
    const auto roof_half = [&](MeshBuilder& part) {
        constexpr float kOut = 0.95F;
        constexpr float kFall = kTop - 0.13F;
        const float ridge = kTop + 0.6F;
        part.material(m.tile).tint(0.97F);
        part.quad(
            {kOut, kFall, kFront + 0.2F},
            {kOut, kFall, kBack},
            {0, ridge, kBack},
            {0, ridge, kFront + 0.2F}
        );
        part.material(m.iron).tint(0.89F);
        part.quad(
            {kOut, kFall - 0.1F, kFront + 0.2F},
            {kOut, kFall, kFront + 0.2F},
            {0, ridge, kFront + 0.2F},
            {0, ridge - 0.12F, kFront + 0.2F}
        );
        part.quad(
            {kOut, kFall, kBack},
            {kOut, kFall, kFront + 0.2F},
            {kOut, kFall - 0.1F, kFront + 0.2F},
            {kOut, kFall - 0.1F, kBack}
        );
        part.quad(
            {0, ridge - 0.12F, kFront + 0.2F},
            {0, ridge - 0.12F, kBack},
            {kOut, kFall - 0.1F, kBack},
            {kOut, kFall - 0.1F, kFront + 0.2F}
        );
    };
    roof_half(mesh);
    mesh.mirrored(roof_half);
}

// The gable on the east end of a slope that falls to the south.
void add_gable_end(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kWall = kCityHalf;
    constexpr float kJamb = -1.3F;  // of the attic window, half of which is here
    constexpr float kSill = 0.6F;
    constexpr float kHead = 1.7F;
    constexpr float kPane = kWall - 0.15F;
    const auto wall_at = [&](float z, float y) { return Vec3{kWall, y, z}; };
    mesh.material(m.plaster).tint(1);
    mesh.quad(
        wall_at(kCityHalf, -0.2F),
        wall_at(kJamb, -0.2F),
        wall_at(kJamb, roof_y(kJamb)),
        wall_at(kCityHalf, roof_y(kCityHalf))
    );
    mesh.quad(
        wall_at(kJamb, -0.2F), wall_at(kRidge, -0.2F), wall_at(kRidge, kSill), wall_at(kJamb, kSill)
    );
    mesh.quad(
        wall_at(kJamb, kHead),
        wall_at(kRidge, kHead),
        wall_at(kRidge, roof_y(kRidge)),
        wall_at(kJamb, roof_y(kJamb))
    );
    mesh.tint(0.83F);
    mesh.quad(
        {kPane, kSill, kJamb}, {kWall, kSill, kJamb}, {kWall, kSill, kRidge}, {kPane, kSill, kRidge}
    );
    mesh.quad(
        {kWall, kHead, kJamb}, {kPane, kHead, kJamb}, {kPane, kHead, kRidge}, {kWall, kHead, kRidge}
    );
    mesh.quad(
        {kWall, kSill, kJamb}, {kPane, kSill, kJamb}, {kPane, kHead, kJamb}, {kWall, kHead, kJamb}
    );
    mesh.material(m.glass).tint(1);
    mesh.quad(
        {kPane, kSill, kJamb}, {kPane, kSill, kRidge}, {kPane, kHead, kRidge}, {kPane, kHead, kJamb}
    );
    mesh.material(m.stone).tint(0.95F);
    mesh.open_box({{kWall, kSill - 0.12F, kRidge}, {kWall + 0.1F, kSill, kJamb + 0.1F}}, "EUDS");
    mesh.open_box({{kWall, kHead, kRidge}, {kWall + 0.06F, kHead + 0.2F, kJamb + 0.1F}}, "EUDS");
    mesh.material(m.iron).tint(0.89F);
    mesh.open_box({{kPane, kSill, kRidge}, {kPane + 0.05F, kHead, kRidge + 0.04F}}, "ES");
    // Barge board along the verge.
    constexpr float kEnd = kWall + kVerge;
    constexpr float kBoard = 0.26F;
    const auto edge = [&](float x, float z, float drop) { return Vec3{x, roof_y(z) - drop, z}; };
    mesh.material(m.stone).tint(0.89F);
    mesh.quad(
        edge(kEnd, kEaves, kBoard),
        edge(kEnd, kRidge, kBoard),
        edge(kEnd, kRidge, -0.1F),
        edge(kEnd, kEaves, -0.1F)
    );
    mesh.tint(0.7F);
    mesh.quad(
        edge(kWall, kRidge, kBoard),
        edge(kEnd, kRidge, kBoard),
        edge(kEnd, kEaves, kBoard),
        edge(kWall, kEaves, kBoard)
    );
    mesh.tint(0.89F);
    mesh.quad(
        edge(kWall, kEaves, kBoard),
        edge(kEnd, kEaves, kBoard),
        edge(kEnd, kEaves, -0.1F),
        edge(kWall, kEaves, -0.1F)
    );
    mesh.tint(0.95F);
    mesh.quad(
        edge(kEnd - 0.12F, kEaves, -0.1F),
        edge(kEnd, kEaves, -0.1F),
        edge(kEnd, kRidge, -0.1F),
        edge(kEnd - 0.12F, kRidge, -0.1F)
    );
    mesh.quad(
        edge(kEnd - 0.12F, kRidge, 0.1F),
        edge(kEnd - 0.12F, kEaves, 0.1F),
        edge(kEnd - 0.12F, kEaves, -0.1F),
        edge(kEnd - 0.12F, kRidge, -0.1F)
    );
}

void add_chimney(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.brick).tint(0.95F);
    mesh.bevelled_box({{0.6F, 1.2F, -1.3F}, {1.5F, 3.7F, -0.6F}}, 0.04F);
    mesh.material(m.stone).tint(0.89F);
    mesh.bevelled_box({{0.5F, 3.4F, -1.4F}, {1.6F, 3.58F, -0.5F}}, 0.04F);
    mesh.material(m.brick).tint(1, 0.95F, 0.89F);
    mesh.cylinder(0.85F, -0.95F, 0.13F, 3.7F, 4.1F, 8);
    mesh.cylinder(1.25F, -0.95F, 0.13F, 3.7F, 4.2F, 8);
}

MeshBuilder shaded(MeshBuilder mesh, bool is_ground) {
    if (is_ground) {
        mesh.shade_upwards(0.85F, 1.5F);
    } else {
        mesh.shade([](const Vec3&, const Vec3& normal) { return normal.y < -0.5F ? 0.82F : 1.0F; });
    }
    return mesh;
}

}  // namespace

MeshBuilder make_house_front(const CityMaterials& materials) {
    return shaded(
        make_side([&](MeshBuilder& mesh, RightEnd end) {
            add_two_windows(mesh, materials, HouseStorey::kGround, end);
        }),
        true
    );
}

MeshBuilder make_house_door(const CityMaterials& materials) {
    return shaded(
        make_side([&](MeshBuilder& mesh, RightEnd end) { add_door_front(mesh, materials, end); }),
        true
    );
}

MeshBuilder make_house_ground_corner(const CityMaterials& materials) {
    return shaded(
        make_corner(
            [&](MeshBuilder& mesh, RightEnd end) {
                add_two_windows(mesh, materials, HouseStorey::kGround, end);
                add_quoins(mesh, materials, true, 0.5F);
            },
            [&](MeshBuilder& mesh, RightEnd end) {
                add_two_windows(mesh, materials, HouseStorey::kGround, end);
                add_quoins(mesh, materials, false, 0.5F);
            }
        ),
        true
    );
}

MeshBuilder make_house_wall(const CityMaterials& materials, HouseStorey storey) {
    return shaded(
        make_side([&](MeshBuilder& mesh, RightEnd end) {
            add_two_windows(mesh, materials, storey, end);
        }),
        false
    );
}

MeshBuilder make_house_corner(const CityMaterials& materials, HouseStorey storey) {
    return shaded(
        make_corner(
            [&](MeshBuilder& mesh, RightEnd end) {
                add_two_windows(mesh, materials, storey, end);
                if (storey == HouseStorey::kMiddle) {
                    add_quoins(mesh, materials, true, 0.12F);
                }
            },
            [&](MeshBuilder& mesh, RightEnd end) {
                add_two_windows(mesh, materials, storey, end);
                if (storey == HouseStorey::kMiddle) {
                    add_quoins(mesh, materials, false, 0.12F);
                }
            }
        ),
        false
    );
}

MeshBuilder make_slope(const CityMaterials& materials, bool has_dormer) {
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& part) {
        add_courses(part, materials, -kCityHalf, kCityHalf);
        if (has_dormer) {
            add_dormer(part, materials);
        }
    });
    return shaded(std::move(mesh), false);
}

MeshBuilder make_gable(const CityMaterials& materials, bool is_left) {
    // The eastern end of a slope to the south is the northern one of a slope to the east.
    const auto slope = [&](MeshBuilder& part) {
        add_courses(part, materials, -kCityHalf, kCityHalf + kVerge - 0.12F);
        add_gable_end(part, materials);
        if (is_left) {
            add_chimney(part, materials);
        }
    };
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& part) {
        if (is_left) {
            slope(part);
        } else {
            part.mirrored(slope);
        }
    });
    return shaded(std::move(mesh), false);
}

}  // namespace modelsynth::examples
