#include "solver/examples/castle_walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace modelsynth::examples::castle {

namespace {

constexpr float kPlinth = 0.72F;
constexpr float kWalk = 0.9F;
constexpr float kParapet = 1.25F;
constexpr float kMerlon = 1.75F;
constexpr float kGateHalf = 0.68F;

constexpr std::array<Point2, 4> kFoot = {
    {{kPlinth, 0}, {kPlinth, 0.3F}, {kWallHalf, 0.44F}, {kWallHalf, 2}}};
constexpr std::array<Point2, 2> kUnderParapet = {{{kWallHalf, 0}, {kWallHalf, 0.66F}}};
constexpr std::array<Point2, 5> kOverWall = {
    {{kWallHalf, 0.66F},
     {kParapetOut, 0.78F},
     {kParapetOut, kParapet},
     {kParapetIn, kParapet},
     {kParapetIn, kWalk}}};
constexpr std::array<Point2, 2> kWalkway = {{{kParapetIn, kWalk}, {0, kWalk}}};

// The surface over a profile along every side of a wall, inner corners between arms included.
void loft_wall(MeshBuilder& mesh, const Arms& arms, std::span<const Point2> profile) {
    for (std::size_t side = 0; side < 4; ++side) {
        const bool arm = arms[side];
        const bool left = arms[(side + 1) % 4];   // north, seen as the side is turned to the east
        const bool right = arms[(side + 3) % 4];  // south
        mesh.turned(static_cast<int>(side), [&](MeshBuilder& turned) {
            if (!arm) {
                loft(turned, profile, [&](float out) {
                    return std::vector<Point2>{{out, right ? 1 : out}, {out, left ? -1 : -out}};
                });
            } else if (left) {
                loft(turned, profile, [](float out) {
                    return std::vector<Point2>{{1, -out}, {out, -out}, {out, -1}};
                });
            }
        });
    }
}

// A merlon on a parapet that faces south, from x0 to x1 as far as it lies within low ... high.
void add_merlon(MeshBuilder& mesh, float x0, float x1, float low, float high) {
    const float from = std::max(x0, low);
    const float to = std::min(x1, high);
    if (to - from < 0.2F) {
        return;
    }
    mesh.bevelled_box({{from, kParapet, kParapetIn}, {to, kMerlon, kParapetOut}}, 0.05F);
}

// Merlons look over the meadow: on the sides given, and in the nooks between arms where asked.
void add_merlons(MeshBuilder& mesh, const Arms& arms, const Arms& outward, bool in_nooks) {
    for (std::size_t side = 0; side < 4; ++side) {
        const bool arm = arms[(side + 3) % 4];  // the south, once the sides are turned
        const bool east = arms[side];
        const bool west = arms[(side + 2) % 4];
        mesh.turned(static_cast<int>(side), [&](MeshBuilder& turned) {
            if (!arm && outward[(side + 3) % 4]) {
                // Where two sides meet, the one that ends there in the east has the corner.
                const float low = west ? -1 : -kParapetIn;
                const float high = east ? 1 : kParapetOut;
                add_merlon(turned, -0.78F, -0.26F, low, high);
                add_merlon(turned, 0.26F, 0.78F, low, high);
            } else if (arm && east && in_nooks) {
                add_merlon(turned, kParapetIn, 0.78F, -1, 1);
            }
        });
    }
}

// Ground about the wall, a quarter of the cell each: north-east, north-west, south-west,
// south-east.
void add_quarters(MeshBuilder& mesh, const Palette& palette, const Arms& court) {
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        mesh.turned(static_cast<int>(quarter), [&](MeshBuilder& ground) {
            ground.material(court[quarter] ? palette.earth : palette.grass).tint(kShadyTint);
            ground.quad({0, 0, 0}, {1, 0, 0}, {1, 0, -1}, {0, 0, -1});
        });
    }
}

// The faces of a wall that look straight out, as panels facing south.
void on_faces(
    MeshBuilder& mesh,
    const Arms& arms,
    const std::function<void(MeshBuilder&, std::uint32_t side, float x0, float x1)>& add
) {
    for (std::size_t side = 0; side < 4; ++side) {
        if (!arms[(side + 3) % 4]) {
            mesh.turned(static_cast<int>(side), [&](MeshBuilder& turned) {
                add(turned,
                    static_cast<std::uint32_t>(side),
                    arms[(side + 2) % 4] ? -1 : -kWallHalf,
                    arms[side] ? 1 : kWallHalf);
            });
        }
    }
}

// The lower half of a wall, two metres up.
void add_foot(MeshBuilder& wall, const Palette& palette, const Arms& arms) {
    wall.turned(0, [&](MeshBuilder& mesh) {
        mesh.material(palette.trim).tint(kStoneTint);
        loft_wall(mesh, arms, std::span(kFoot).first(3));
        mesh.material(palette.stone);
        loft_wall(mesh, arms, std::span(kFoot).subspan(2));
        on_faces(mesh, arms, [&](MeshBuilder& face, std::uint32_t side, float x0, float x1) {
            add_blocks(face, palette, 11 + side, {x0, x1, 0.5F, 2}, kWallHalf, 0.34F);
        });
        mesh.shade_upwards(kFootShade, 1.6F);
    });
}

// The upper half, with corbels, walk and parapet.
void add_top(
    MeshBuilder& wall,
    const Palette& palette,
    const Arms& arms,
    const Arms& outward,
    bool merlons_in_nooks
) {
    wall.placed({0, 2, 0}, 0, 1, [&](MeshBuilder& mesh) {
        mesh.material(palette.stone).tint(kStoneTint);
        loft_wall(mesh, arms, kUnderParapet);
        on_faces(mesh, arms, [&](MeshBuilder& face, std::uint32_t side, float x0, float x1) {
            add_blocks(face, palette, 31 + side, {x0, x1, 0, 0.4F}, kWallHalf, 0.5F);
            add_corbels(face, palette, x0, x1, kWallHalf, 0.68F);
        });
        mesh.shade([](const Vec3& place, const Vec3&) { return place.y > 0.5F ? 0.88F : 1.0F; });
        mesh.material(palette.stone).tint(1);
        loft_wall(mesh, arms, kOverWall);
        add_merlons(mesh, arms, outward, merlons_in_nooks);
        mesh.material(palette.paving).tint(0.85F);
        loft_wall(mesh, arms, kWalkway);
    });
}

void add_gate_foot(MeshBuilder& gate, const Palette& palette, bool inner) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    for (const int turns : {0, 2}) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            for (const float sign : {-1.0F, 1.0F}) {
                const float low = std::min(sign, sign * kGateHalf);
                const float high = std::max(sign, sign * kGateHalf);
                loft(face, kFoot, [&](float out) {
                    return std::vector<Point2>{{low, out}, {high, out}};
                });
            }
        });
        // A jamb, with the end of the plinth.
        mesh.turned(turns, [&](MeshBuilder& jamb) {
            const float x = -kGateHalf;
            jamb.quad({x, 0, kWallHalf}, {x, 0, -kWallHalf}, {x, 2, -kWallHalf}, {x, 2, kWallHalf});
            for (const float z : {-1.0F, 1.0F}) {
                const Vec3 a = {x, 0, z * kPlinth};
                const Vec3 b = {x, 0, z * kWallHalf};
                const Vec3 c = {x, 0.44F, z * kWallHalf};
                const Vec3 d = {x, 0.3F, z * kPlinth};
                z > 0 ? jamb.quad(a, b, c, d) : jamb.quad(d, c, b, a);
            }
            // Quoins at the edges of the opening.
            jamb.material(palette.trim).tint(1);
            for (int i = 0; i < 4; ++i) {
                const float y = 0.5F + 0.38F * static_cast<float>(i);
                const float reach = i % 2 == 0 ? 0.26F : 0.16F;
                for (const float z : {-1.0F, 1.0F}) {
                    const float z0 = z > 0 ? kWallHalf - reach : -kWallHalf - 0.04F;
                    jamb.open_box(
                        {{x - reach, y, z0}, {x + 0.03F, y + 0.33F, z0 + reach + 0.04F}}, "EWUDSN"
                    );
                }
            }
        });
    }
    mesh.shade_upwards(kFootShade, 1.6F);
    mesh.material(palette.paving).tint(0.78F);
    mesh.quad(
        {-kGateHalf - 0.02F, 0.015F, 1},
        {kGateHalf + 0.02F, 0.015F, 1},
        {kGateHalf + 0.02F, 0.015F, -1},
        {-kGateHalf - 0.02F, 0.015F, -1}
    );
    add_cobbles(mesh, palette, 51, {{-kGateHalf, 0, -1}, {kGateHalf, 0.03F, 1}}, 3, 5);
    gate.turned(0, [&](MeshBuilder& foot) { foot = std::move(mesh); });
    add_quarters(gate, palette, {true, true, inner, inner});
}

void add_gate_top(MeshBuilder& gate, const Palette& palette) {
    constexpr float kArchTop = 0.72F;
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    mesh.arch({{-1, 0, -kWallHalf}, {1, kArchTop, kWallHalf}}, 2 * kGateHalf, 0);
    const Arms arms = {true, false, true, false};
    mesh.shade([](const Vec3& place, const Vec3&) { return place.y > 0.5F ? 0.88F : 1.0F; });
    for (const int turns : {0, 2}) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            // Voussoirs.
            face.material(palette.trim);
            constexpr int kStones = 9;
            for (int i = 0; i < kStones; ++i) {
                const auto at = [](float step, float radius) {
                    const float angle = 3.14159265F * step / kStones;
                    return Point2{radius * std::cos(angle), radius * std::sin(angle)};
                };
                const auto step = static_cast<float>(i);
                const float outer = i == kStones / 2 ? 0.98F : 0.86F;
                const std::array<Point2, 4> stone = {
                    {at(step + 0.04F, kGateHalf - 0.01F),
                     at(step + 0.04F, outer),
                     at(step + 0.96F, outer),
                     at(step + 0.96F, kGateHalf - 0.01F)}};
                face.tint(i % 2 == 0 ? 1.0F : 0.88F);
                face.extrude(stone, kWallHalf - 0.02F, i == kStones / 2 ? 0.7F : 0.65F);
            }
            // A shield over the arch.
            face.material(palette.flag).tint(1);
            const std::array<Point2, 5> shield = {
                {{-0.2F, 1.06F}, {0, 0.82F}, {0.2F, 1.06F}, {0.2F, 1.42F}, {-0.2F, 1.42F}}};
            face.extrude(shield, kParapetOut - 0.02F, kParapetOut + 0.05F);
            face.material(palette.gold);
            const std::array<Point2, 4> charge = {
                {{0, 0.98F}, {0.09F, 1.14F}, {0, 1.3F}, {-0.09F, 1.14F}}};
            face.extrude(charge, kParapetOut + 0.04F, kParapetOut + 0.07F);
        });
    }
    // The portcullis, half raised.
    mesh.material(palette.dark).tint(1);
    for (int i = -2; i <= 2; ++i) {
        const float x = 0.25F * static_cast<float>(i);
        mesh.open_box({{x - 0.025F, -0.5F, -0.025F}, {x + 0.025F, 0.66F, 0.025F}}, "EWDSN");
    }
    for (const float y : {-0.3F, 0.0F, 0.3F}) {
        const float half = y > 0.1F ? 0.58F : kGateHalf;
        mesh.open_box({{-half, y - 0.03F, -0.04F}, {half, y + 0.03F, 0.04F}}, "UDSN");
    }
    mesh.material(palette.stone).tint(0.97F);
    constexpr std::array<Point2, 5> kOverGate = {
        {{kWallHalf, 0.66F},
         {kParapetOut, 0.78F},
         {kParapetOut, kParapet},
         {kParapetIn, kParapet},
         {kParapetIn, kWalk}}};
    loft_wall(mesh, arms, kOverGate);
    mesh.tint(1);
    add_merlons(mesh, arms, {false, false, false, true}, false);
    mesh.material(palette.paving).tint(0.85F);
    loft_wall(mesh, arms, kWalkway);
    gate.placed({0, 2, 0}, 0, 1, [&](MeshBuilder& top) { top = std::move(mesh); });
}

}  // namespace

MeshBuilder make_curtain(const Palette& palette, CurtainShape shape) {
    // As built the meadow lies in the east, in the east and north, or in the corner between them.
    static constexpr std::array<Arms, 3> kArms = {
        {{false, true, false, true}, {false, false, true, true}, {true, true, false, false}}};
    static constexpr std::array<Arms, 3> kOutward = {
        {{true, false, false, false}, {true, true, false, false}, {}}};
    static constexpr std::array<Arms, 3> kCourt = {
        {{false, true, true, false}, {false, false, true, false}, {false, true, true, true}}};
    const auto index = static_cast<std::size_t>(shape);
    const bool concave = shape == CurtainShape::kConcave;
    MeshBuilder mesh;
    add_foot(mesh, palette, kArms[index]);
    add_top(mesh, palette, kArms[index], kOutward[index], concave);
    if (shape == CurtainShape::kStraight) {
        mesh.turned(1, [&](MeshBuilder& face) {
            add_window(face, palette, {-0.06F, 0.06F, 1.05F, 1.85F}, kWallHalf);
        });
    }
    add_quarters(mesh, palette, kCourt[index]);
    return mesh;
}

MeshBuilder make_inner_wall(const Palette& palette) {
    constexpr Arms kAlong = {true, false, true, false};
    MeshBuilder mesh;
    add_foot(mesh, palette, kAlong);
    add_top(mesh, palette, kAlong, {}, false);
    add_quarters(mesh, palette, {true, true, true, true});
    return mesh;
}

MeshBuilder make_gate(const Palette& palette) {
    MeshBuilder mesh;
    mesh.turned(1, [&](MeshBuilder& to_south) {
        add_gate_foot(to_south, palette, false);
        add_gate_top(to_south, palette);
    });
    return mesh;
}

MeshBuilder make_inner_gate(const Palette& palette) {
    MeshBuilder mesh;
    add_gate_foot(mesh, palette, true);
    add_gate_top(mesh, palette);
    return mesh;
}

}  // namespace modelsynth::examples::castle
