#include "solver/examples/castle_towers.h"

#include <array>

namespace modelsynth::examples::castle {

namespace {

constexpr float kDeck = 0.6F;
constexpr float kParapet = 0.95F;
constexpr float kMerlon = 1.5F;
constexpr float kOut = 1.14F;
constexpr float kIn = 0.88F;

constexpr std::array<Point2, 3> kPlinth = {{{1.1F, 0}, {1.1F, 0.42F}, {1, 0.58F}}};
constexpr std::array<Point2, 2> kFootFace = {{{1, 0.58F}, {1, 2}}};
constexpr std::array<Point2, 2> kFace = {{{1, 0}, {1, 2}}};
constexpr std::array<Point2, 2> kUnderParapet = {{{1, 0}, {1, 0.3F}}};
constexpr std::array<Point2, 5> kParapetProfile = {
    {{1, 0.3F}, {kOut, 0.44F}, {kOut, kParapet}, {kIn, kParapet}, {kIn, kDeck}}};

std::vector<Point2> side_outline(float out) { return {{out, 1}, {out, -1}}; }

std::vector<Point2> corner_outline(float out) {
    const float c = kTowerCut;
    return {{out, 1}, {out, c - out}, {out - c, -out}, {-1, -out}};
}

// The faces of a corner piece, each as one that faces south.
void on_corner_faces(MeshBuilder& mesh, const std::function<void(MeshBuilder&, bool)>& add) {
    mesh.turned(1, [&](MeshBuilder& east) { add(east, true); });
    mesh.turned(2, [&](MeshBuilder& north) { add(north, false); });
}

float under_parapet(const Vec3& place, const Vec3& normal) {
    return (place.y > 0.2F ? 0.88F : 1.0F) * (normal.y < -0.5F ? 0.85F : 1.0F);
}

// Quoins on the cut edge between east and north, from course `first` up.
void add_quoins(MeshBuilder& mesh, const Palette& palette, int first) {
    mesh.material(palette.trim).tint(0.95F);
    for (int course = first; course < 6; ++course) {
        const float y = static_cast<float>(course) / 3;
        const float reach = course % 2 == 0 ? 0.06F : 0.22F;
        const float o = 1.03F;
        const float c = kTowerCut + 0.02F;
        const std::array<Point2, 6> outline = {
            {{o, c - o + reach},
             {o, c - o},
             {o - c, -o},
             {o - c - reach, -o},
             {o - c - reach, -0.95F},
             {0.95F, c - o + reach}}};
        mesh.prism(outline, y + 0.015F, y + 0.315F);
    }
    mesh.tint(kStoneTint);
}

void add_corner_merlon(MeshBuilder& mesh) {
    const float o = kOut;
    const float c = kTowerCut;
    const std::array<Point2, 5> outline = {
        {{o, -0.5F}, {o, c - o}, {o - c, -o}, {0.5F, -o}, {kIn - 0.14F, -kIn + 0.14F}}};
    mesh.prism(outline, kParapet, kMerlon);
}

// Paving about a foot: it lies well on the meadow and in a court.
void add_apron(MeshBuilder& mesh, const Palette& palette) {
    mesh.material(palette.paving).tint(kShadyTint);
    mesh.quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
}

}  // namespace

MeshBuilder make_turret_foot(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.trim).tint(kStoneTint);
    loft(mesh, kPlinth, cut_square(kTowerCut));
    mesh.material(palette.stone);
    loft(mesh, kFootFace, cut_square(kTowerCut));
    for (int turns = 0; turns < 4; ++turns) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            add_blocks(
                face,
                palette,
                60 + static_cast<std::uint32_t>(turns),
                {-0.75F, 0.75F, 0.6F, 2},
                1,
                0.5F
            );
        });
    }
    mesh.shade_upwards(kFootShade, 1.6F);
    add_apron(mesh, palette);
    return mesh;
}

MeshBuilder make_turret_storey(const Palette& palette, bool windows) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    loft(mesh, kFace, cut_square(kTowerCut));
    for (int turns = 0; turns < 4; ++turns) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            const auto seed = static_cast<std::uint32_t>(turns);
            if (windows) {
                add_blocks(face, palette, 70 + seed, {-0.75F, 0.75F, 0, 0.6F}, 1, 0.5F);
                add_window(face, palette, {-0.14F, 0.14F, 0.7F, 1.55F}, 1);
            } else {
                add_blocks(face, palette, 80 + seed, {-0.75F, 0.75F, 0, 2}, 1, 0.4F);
            }
        });
    }
    return mesh;
}

MeshBuilder make_turret_battlement(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    loft(mesh, kUnderParapet, cut_square(kTowerCut));
    for (int turns = 0; turns < 4; ++turns) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            add_corbels(face, palette, -0.8F, 0.8F, 1, 0.36F);
        });
    }
    mesh.shade(under_parapet);
    mesh.material(palette.stone).tint(1);
    loft(mesh, kParapetProfile, cut_square(kTowerCut));
    mesh.tint(1);
    for (int turns = 0; turns < 4; ++turns) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            add_corner_merlon(face);
            face.bevelled_box({{-0.22F, kParapet, kIn}, {0.22F, kMerlon, kOut}}, 0.05F);
        });
    }
    mesh.material(palette.paving).tint(0.85F);
    cap(mesh, cut_square(kTowerCut), kIn, kDeck);
    return mesh;
}

MeshBuilder make_turret_roof(const Palette& palette, bool flag) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    loft(mesh, kUnderParapet, cut_square(kTowerCut));
    for (int turns = 0; turns < 4; ++turns) {
        mesh.turned(turns, [&](MeshBuilder& face) {
            add_corbels(face, palette, -0.8F, 0.8F, 1, 0.36F);
        });
    }
    mesh.shade(under_parapet);
    mesh.material(palette.stone).tint(0.95F);
    constexpr std::array<Point2, 3> kCornice = {{{1, 0.3F}, {1.12F, 0.44F}, {1.12F, 0.56F}}};
    loft(mesh, kCornice, cut_square(kTowerCut));
    mesh.material(palette.slate).tint(0.8F);
    const Outline eaves = cut_square(0.6F);
    constexpr std::array<Point2, 3> kEaves = {{{1, 0.5F}, {1.34F, 0.44F}, {1.34F, 0.5F}}};
    loft(mesh, kEaves, eaves);
    // The cut grows thin with the roof, so that its eight edges meet in the point.
    const Outline spire = [](float out) { return cut_square(out * 0.6F / 1.34F)(out); };
    add_courses(mesh, spire, {1.34F, 0.5F}, {0.95F, 1}, 1);
    add_courses(mesh, spire, {0.95F, 1}, {0, 3.1F}, 4);
    if (flag) {
        add_flag(mesh, palette, {0, 2.9F, 0}, 1.6F);
    } else {
        mesh.material(palette.gold);
        mesh.cone(0, 0, 0.06F, 2.9F, 3.7F, 5);
        mesh.ball({0, 3.2F, 0}, {0.11F, 0.11F, 0.11F}, 6);
    }
    return mesh;
}

MeshBuilder make_foot_corner(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.trim).tint(kStoneTint);
    loft(mesh, kPlinth, corner_outline);
    mesh.material(palette.stone);
    loft(mesh, kFootFace, corner_outline);
    on_corner_faces(mesh, [&](MeshBuilder& face, bool east) {
        add_blocks(
            face,
            palette,
            east ? 91 : 92,
            east ? Panel{-1, 0.5F, 0.6F, 2} : Panel{-0.5F, 1, 0.6F, 2},
            1,
            0.3F
        );
    });
    add_quoins(mesh, palette, 2);
    mesh.shade_upwards(kFootShade, 1.6F);
    add_apron(mesh, palette);
    return mesh;
}

MeshBuilder make_foot_side(const Palette& palette, bool door) {
    MeshBuilder mesh;
    mesh.material(palette.trim).tint(kStoneTint);
    loft(mesh, kPlinth, side_outline);
    mesh.material(palette.stone);
    loft(mesh, kFootFace, side_outline);
    mesh.turned(1, [&](MeshBuilder& face) {
        if (!door) {
            add_blocks(face, palette, 95, {-1, 1, 0.6F, 1.05F}, 1, 0.4F);
            add_window(face, palette, {-0.2F, 0.2F, 0.95F, 1.7F}, 1);
            return;
        }
        constexpr float kHalf = 0.42F;
        constexpr float kHead = 1.25F;
        face.material(palette.wood).tint(1);
        for (int i = 0; i < 4; ++i) {
            const float x = -kHalf + 0.21F * static_cast<float>(i);
            face.tint(i % 2 == 0 ? 1.0F : 0.86F);
            face.quad(
                {x, 0, 1.13F}, {x + 0.21F, 0, 1.13F}, {x + 0.21F, kHead, 1.13F}, {x, kHead, 1.13F}
            );
        }
        face.tint(0.9F).triangle({-kHalf, kHead, 1.13F}, {kHalf, kHead, 1.13F}, {0, 1.62F, 1.13F});
        face.material(palette.dark).tint(1);
        for (const float y : {0.35F, 0.95F}) {
            face.open_box({{-kHalf, y, 1.1F}, {0.3F, y + 0.07F, 1.15F}}, "EUDS");
        }
        face.material(palette.trim);
        for (const float sign : {-1.0F, 1.0F}) {
            const float x = sign > 0 ? kHalf : -kHalf - 0.18F;
            face.open_box({{x, 0, 0.99F}, {x + 0.18F, kHead, 1.24F}}, "EWS");
        }
        const std::array<Point2, 4> left = {
            {{-kHalf - 0.24F, kHead}, {-kHalf, kHead}, {0, 1.62F}, {0, 1.84F}}};
        const std::array<Point2, 4> right = {
            {{kHalf, kHead}, {kHalf + 0.24F, kHead}, {0, 1.84F}, {0, 1.62F}}};
        face.extrude(left, 0.99F, 1.28F).extrude(right, 0.99F, 1.28F);
        face.material(palette.paving);
        face.bevelled_box({{-0.6F, 0, 1}, {0.6F, 0.12F, 1.42F}}, 0.04F);
    });
    mesh.shade_upwards(kFootShade, 1.6F);
    add_apron(mesh, palette);
    return mesh;
}

MeshBuilder make_storey_corner(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    loft(mesh, kFace, corner_outline);
    on_corner_faces(mesh, [&](MeshBuilder& face, bool east) {
        add_blocks(
            face,
            palette,
            east ? 101 : 102,
            east ? Panel{-1, 0.5F, 0, 0.68F} : Panel{-0.5F, 1, 0, 0.68F},
            1,
            0.3F
        );
        add_window(face, palette, {-0.1F, 0.1F, 0.75F, 1.6F}, 1);
    });
    add_quoins(mesh, palette, 0);
    return mesh;
}

MeshBuilder make_storey_side(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    loft(mesh, kFace, side_outline);
    mesh.turned(1, [&](MeshBuilder& face) {
        add_blocks(face, palette, 105, {-1, 1, 0, 0.6F}, 1, 0.4F);
        add_window(face, palette, {-0.25F, 0.25F, 0.65F, 1.6F}, 1);
        face.material(palette.slate).tint(0.9F);
        for (const float sign : {-1.0F, 1.0F}) {
            const float x = sign > 0 ? 0.38F : -0.64F;
            face.open_box({{x, 0.64F, 0.99F}, {x + 0.26F, 1.4F, 1.05F}}, "EWUDS");
        }
    });
    return mesh;
}

MeshBuilder make_inside(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.wood);
    mesh.quad({-0.9F, 0.1F, 0.9F}, {0.9F, 0.1F, 0.9F}, {0.9F, 0.1F, -0.9F}, {-0.9F, 0.1F, -0.9F});
    return mesh;
}

MeshBuilder make_battlement_corner(const Palette& palette) {
    MeshBuilder mesh;
    mesh.material(palette.stone).tint(kStoneTint);
    loft(mesh, kUnderParapet, corner_outline);
    on_corner_faces(mesh, [&](MeshBuilder& face, bool) {
        add_corbels(face, palette, -1, 1, 1, 0.36F);
    });
    mesh.shade(under_parapet);
    mesh.material(palette.stone).tint(1);
    loft(mesh, kParapetProfile, corner_outline);
    mesh.tint(1);
    add_corner_merlon(mesh);
    on_corner_faces(mesh, [](MeshBuilder& face, bool east) {
        const float x = east ? -0.75F : 0.25F;
        face.bevelled_box({{x, kParapet, kIn}, {x + 0.5F, kMerlon, kOut}}, 0.05F);
    });
    mesh.material(palette.paving).tint(0.85F);
    const std::vector<Point2> edge = corner_outline(kIn);
    for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
        mesh.triangle(
            {-1, kDeck, 1}, {edge[i].u, kDeck, edge[i].v}, {edge[i + 1].u, kDeck, edge[i + 1].v}
        );
    }
    mesh.placed({0, kDeck, 0}, 0, 1, [&](MeshBuilder& level) {
        add_cobbles(level, palette, 112, {{-1, 0, -kIn}, {0.5F, 0.012F, 1}}, 2, 3);
        level.shade([](const Vec3&, const Vec3&) { return 0.93F; });
    });
    return mesh;
}

}  // namespace modelsynth::examples::castle
