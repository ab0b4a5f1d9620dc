#include "solver/examples/city_places.h"

#include "solver/examples/city_props.h"

#include <array>
#include <cstdint>
#include <utility>

namespace modelsynth::examples {

namespace {

constexpr float kHalf = kCityHalf;
constexpr float kJoint = 0.025F;

void add_flat(MeshBuilder& mesh, float x0, float z0, float x1, float z1, float y) {
    mesh.quad({x0, y, z1}, {x1, y, z1}, {x1, y, z0}, {x0, y, z0});
}

// Slabs of a metre on dark joints; `warmth` reddens them.
void add_slabs(MeshBuilder& mesh, const CityMaterials& m, float warmth) {
    mesh.material(m.paving).tint(0.72F);
    mesh.open_box({{-kHalf, 0, -kHalf}, {kHalf, kPavingTop - 0.02F, kHalf}}, "EWSNU");
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const auto index = static_cast<std::uint32_t>(row * 4 + column);
            const float x = -kHalf + static_cast<float>(column);
            const float z = -kHalf + static_cast<float>(row);
            const float bright = 0.88F + 0.12F * scatter(3, index);
            mesh.tint(bright, bright * (1 - 0.5F * warmth), bright * (1 - warmth));
            add_flat(mesh, x + kJoint, z + kJoint, x + 1 - kJoint, z + 1 - kJoint, kPavingTop);
        }
    }
}

void add_tree_pit(MeshBuilder& mesh, const CityMaterials& m, float scale) {
    mesh.material(m.wood).tint(0.9F);
    mesh.open_box({{-0.6F, 0.1F, -0.6F}, {0.6F, kPavingTop + 0.03F, 0.6F}}, "EWSNU");
    add_tree(mesh, m, kPavingTop, scale);
}

// An old tree in a round bed with a low wall.
void add_round_bed(MeshBuilder& mesh, const CityMaterials& m) {
    constexpr float kWall = kPavingTop + 0.3F;
    mesh.material(m.stone).tint(0.95F);
    mesh.cylinder(0, 0, 1.3F, kPavingTop, kWall, 10);
    mesh.material(m.leaf).tint(0.9F);
    mesh.cylinder(0, 0, 1.15F, kWall, kWall + 0.05F, 10);
    add_tree(mesh, m, kWall, 1.3F);
    mesh.material(m.tile).tint(1);
    mesh.ball({0.75F, kWall + 0.1F, 0.35F}, {0.3F, 0.2F, 0.3F}, 5);
    mesh.ball({-0.5F, kWall + 0.1F, 0.7F}, {0.3F, 0.2F, 0.3F}, 5);
}

// A gutter stone in the middle.
void add_drain(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.stone).tint(0.8F);
    mesh.open_box({{-0.3F, 0.1F, -0.3F}, {0.3F, kPavingTop + 0.03F, 0.3F}}, "EWSNU");
    mesh.material(m.iron).tint(1);
    mesh.open_box({{-0.2F, 0.1F, -0.2F}, {0.2F, kPavingTop + 0.05F, 0.2F}}, "EWSNU");
}

void add_grass(MeshBuilder& mesh, const CityMaterials& m, float east, float north) {
    mesh.material(m.leaf).tint(0.92F, 1, 0.9F);
    mesh.open_box({{-kHalf, 0, north}, {east, kPavingTop, kHalf}}, "EWSNU");
    // Tufts.
    mesh.tint(0.8F, 0.95F, 0.75F);
    for (std::uint32_t i = 0; i < 10; ++i) {
        const float x = -1.7F + 3.0F * scatter(11, i);
        const float z = -1.2F + 2.9F * scatter(12, i);
        const float height = kPavingTop + 0.1F + 0.1F * scatter(13, i);
        mesh.triangle(
            {x - 0.07F, kPavingTop, z}, {x + 0.07F, kPavingTop, z + 0.05F}, {x, height, z}
        );
        mesh.triangle(
            {x + 0.07F, kPavingTop, z + 0.05F}, {x - 0.07F, kPavingTop, z}, {x, height, z}
        );
    }
}

constexpr float kHedge = 1.45F;  // where the hedge begins, from the middle
constexpr float kRim = 1.85F;    // where the kerb begins

// Hedge and kerb on the east, each from north to south.
void add_hedge(MeshBuilder& mesh, const CityMaterials& m, const Point2& kerb, const Point2& hedge) {
    constexpr float kInner = kRim - 0.03F;
    mesh.material(m.stone).tint(0.95F);
    mesh.open_box({{kRim, 0, kerb.u}, {kHalf, 0.27F, kerb.v}}, "EWUSN");
    mesh.material(m.leaf).tint(0.62F, 0.72F, 0.62F);
    mesh.open_box({{kHedge, kPavingTop, hedge.u}, {kInner, 0.72F, hedge.v}}, "EWSN");
    mesh.tint(0.75F, 0.85F, 0.7F);
    mesh.open_box({{kHedge, kPavingTop, hedge.u}, {kInner, 0.72F, hedge.v}}, "U");
}

// Bollards on the east.
void add_bollards(MeshBuilder& mesh, const CityMaterials& m) {
    mesh.material(m.stone).tint(0.95F);
    for (const float z : {-1.0F, 1.0F}) {
        mesh.cylinder(1.7F, z, 0.13F, kPavingTop, 0.75F, 6);
    }
}

// Boards of a white fence on the east, from z0 to z1.
void add_fence(MeshBuilder& mesh, const CityMaterials& m, float z0, float z1) {
    constexpr float kAt = 1.88F;
    mesh.material(m.plaster).tint(0.95F);
    for (const float y : {0.35F, 0.7F}) {
        mesh.open_box({{kAt - 0.03F, y, z0}, {kAt, y + 0.08F, z1}}, "EWUDSN");
    }
    for (float z = z0 + 0.1F; z < z1 - 0.05F; z += 0.4F) {
        mesh.open_box({{kAt, kPavingTop, z}, {kAt + 0.04F, 0.95F, z + 0.16F}}, "EWSNU");
    }
}

MeshBuilder shaded(MeshBuilder mesh) {
    mesh.shade([](const Vec3& position, const Vec3& normal) {
        const float under = normal.y < -0.3F ? 0.85F : 1.0F;
        return under * (position.y < 0.05F && normal.y < 0.5F ? 0.8F : 1.0F);
    });
    return mesh;
}

}  // namespace

MeshBuilder make_lane(const CityMaterials& materials, LanePart part) {
    MeshBuilder mesh;
    add_slabs(mesh, materials, 0.2F);
    switch (part) {
        case LanePart::kNone:
            break;
        case LanePart::kTree:
            add_tree_pit(mesh, materials, 0.85F);
            break;
        case LanePart::kBigTree:
            add_round_bed(mesh, materials);
            break;
        case LanePart::kDrain:
            add_drain(mesh, materials);
            break;
        case LanePart::kBench:
            add_bench(mesh, materials);
            break;
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_verge(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_slabs(mesh, materials, 0);
    add_table(mesh, materials, -0.3F, -1.0F);
    mesh.placed({0, 0, 1.0F}, 0, 1, [&](MeshBuilder& part) {
        add_tree_pit(part, materials, 0.8F);
    });
    return shaded(std::move(mesh));
}

MeshBuilder make_square_edge(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_slabs(mesh, materials, 0.12F);
    add_bollards(mesh, materials);
    return shaded(std::move(mesh));
}

MeshBuilder make_square_corner(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_slabs(mesh, materials, 0.12F);
    add_tree_pit(mesh, materials, 0.9F);
    return shaded(std::move(mesh));
}

MeshBuilder make_square_middle(const CityMaterials& materials, bool has_fountain) {
    MeshBuilder mesh;
    add_slabs(mesh, materials, 0.12F);
    if (has_fountain) {
        add_fountain(mesh, materials);
    } else {
        add_stall(mesh, materials);
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_lawn(const CityMaterials& materials, LawnPart part) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kHalf, -kHalf);
    switch (part) {
        case LawnPart::kTree:
            add_tree(mesh, materials, kPavingTop, 1.25F);
            break;
        case LawnPart::kFlowers:
            mesh.material(materials.leaf).tint(0.7F, 0.85F, 0.7F);
            mesh.ball({-0.7F, 0.45F, 0.5F}, {0.75F, 0.6F, 0.7F}, 8);
            mesh.tint(0.85F);
            mesh.ball({0.6F, 0.4F, -0.6F}, {0.6F, 0.5F, 0.65F}, 8);
            mesh.material(materials.tile).tint(1);
            mesh.ball({0.5F, 0.3F, 0.7F}, {0.4F, 0.3F, 0.4F}, 6);
            mesh.material(materials.glow).tint(1);
            mesh.ball({-0.6F, 0.25F, -0.9F}, {0.45F, 0.25F, 0.35F}, 6);
            break;
    }
    return shaded(std::move(mesh));
}

MeshBuilder make_lawn_edge(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kRim, -kHalf);
    add_hedge(mesh, materials, {-kHalf, kHalf}, {-kHalf, kHalf});
    return shaded(std::move(mesh));
}

MeshBuilder make_lawn_corner(const CityMaterials& materials) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kRim, -kRim);
    add_hedge(mesh, materials, {-kHalf, kHalf}, {-kRim + 0.03F, kHalf});
    mesh.turned(1, [&](MeshBuilder& north) {
        add_hedge(north, materials, {-kHalf, kRim}, {-kHalf, kHedge});
    });
    return shaded(std::move(mesh));
}

MeshBuilder make_garden(const CityMaterials& materials, GardenEnd end) {
    MeshBuilder mesh;
    add_grass(mesh, materials, kHalf, -kHalf);
    add_fence(mesh, materials, -kHalf, kHalf);
    // Made for an end in the north.
    const auto add_end = [&](MeshBuilder& part) {
        part.turned(1, [&](MeshBuilder& north) { add_fence(north, materials, -kHalf, kHalf); });
        add_tree(part, materials, kPavingTop, 0.8F);
    };
    switch (end) {
        case GardenEnd::kNone:
            mesh.material(materials.wood).tint(0.85F);
            mesh.open_box({{0.3F, kPavingTop, -1.2F}, {1.3F, 0.24F, 0.9F}}, "EWSNU");
            mesh.material(materials.leaf).tint(0.7F, 0.9F, 0.6F);
            for (const float z : {-0.9F, -0.3F, 0.3F}) {
                mesh.ball({0.8F, 0.3F, z}, {0.35F, 0.25F, 0.22F}, 5);
            }
            break;
        case GardenEnd::kLeft:
            add_end(mesh);
            break;
        case GardenEnd::kRight:
            // A half turn and a mirror take north to south and leave east where it is.
            mesh.turned(2, [&](MeshBuilder& part) { part.mirrored(add_end); });
            break;
    }
    return shaded(std::move(mesh));
}

}  // namespace modelsynth::examples
