#include "solver/continuous/import/mesh_import.h"

#include "solver/continuous/check/flat.h"
#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/import/default_spacing.h"
#include "solver/continuous/import/node_meshes.h"
#include "solver/continuous/reading/families.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/triangulation/triangulation.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"
#include "solver/mesh/glb_writer.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using examples::prism_upwards;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

using Corners = std::vector<Point>;  // of triangles, three by three

Corners triangles_of(const Polyhedron& solid) {
    Corners corners;
    for (const Face& face : solid.faces) {
        std::vector<Point2> points;
        Loop loop;
        for (const std::uint32_t corner : face) {
            loop.push_back(static_cast<std::uint32_t>(points.size()));
            points.push_back(flattened(solid.corners[corner], area_vector(solid, face)));
        }
        for (const auto& triangle : triangulate(points, loop, {})) {
            for (const std::uint32_t i : triangle) {
                corners.push_back(solid.corners[face[i]]);
            }
        }
    }
    return corners;
}

Corners operator+(Corners a, const Corners& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Corners quad(double y) {
    return {{-5, y, 5}, {5, y, 5}, {5, y, -5}, {-5, y, 5}, {5, y, -5}, {-5, y, -5}};
}

// A file of nodes with one mesh each, written by hand to have anything in it.
class GlbBuilder {
  public:
    // `more`: further members of the node.
    GlbBuilder& node(
        const std::string& name,
        const std::vector<std::pair<int, Corners>>& primitives,
        const std::string& more = ""
    ) {
        std::string list;
        for (const auto& [material, corners] : primitives) {
            const std::string accessor = std::to_string(count_++);
            list += (list.empty() ? "" : ",") + ("{\"attributes\":{\"POSITION\":" + accessor) +
                    "}" + (material < 0 ? "" : ",\"material\":" + std::to_string(material)) + "}";
            accessors_ += (accessors_.empty() ? "" : ",") + ("{\"bufferView\":" + accessor) +
                          ",\"componentType\":5126,\"type\":\"VEC3\",\"count\":" +
                          std::to_string(corners.size()) + "}";
            views_ += (views_.empty() ? "" : ",") +
                      ("{\"buffer\":0,\"byteOffset\":" + std::to_string(data_.size())) +
                      ",\"byteLength\":" + std::to_string(corners.size() * 12) + "}";
            for (const Point& corner : corners) {
                for (const double part : {corner.x(), corner.y(), corner.z()}) {
                    const auto single = static_cast<float>(part);
                    data_.append(reinterpret_cast<const char*>(&single), sizeof single);
                }
            }
        }
        meshes_ += (meshes_.empty() ? "" : ",") + ("{\"primitives\":[" + list) + "]}";
        const std::string number = std::to_string(nodes_count_++);
        nodes_ += (nodes_.empty() ? "" : ",") + ("{\"name\":\"" + name) + "\",\"mesh\":" + number +
                  (more.empty() ? "" : "," + more) + "}";
        roots_ += (roots_.empty() ? "" : ",") + number;
        return *this;
    }

    GlbBuilder& scene_extras(std::string extras) {
        scene_extras_ = ",\"extras\":" + std::move(extras);
        return *this;
    }

    GlbBuilder& asset_extras(std::string extras) {
        asset_extras_ = ",\"extras\":" + std::move(extras);
        return *this;
    }

    [[nodiscard]] std::string bytes() const {
        std::string json =
            "{\"asset\":{\"version\":\"2.0\"" + asset_extras_ +
            "},\"scene\":0,\"scenes\":[{\"nodes\":[" + roots_ + "]" + scene_extras_ +
            "}],\"nodes\":[" + nodes_ + "],\"meshes\":[" + meshes_ + "],\"accessors\":[" +
            accessors_ + "],\"bufferViews\":[" + views_ +
            "],\"buffers\":[{\"byteLength\":" + std::to_string(data_.size()) +
            "}],\"materials\":[{\"name\":\"wall\"},{\"name\":\"roof\",\"pbrMetallicRoughness\":"
            "{\"baseColorFactor\":[1,0,0,1]}},{\"name\":\"ground\"}]}";
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const auto word = [](std::size_t value) {
            const auto number = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&number), sizeof number);
        };
        return "glTF" + word(2) + word(28 + json.size() + data_.size()) + word(json.size()) +
               "JSON" + json + word(data_.size()) + std::string("BIN\0", 4) + data_;
    }

    [[nodiscard]] Result<ImportedExample> read_all() const {
        return read_example_glb(bytes_of(bytes()));
    }

    [[nodiscard]] Result<Example> read() const {
        return read_all().map([](ImportedExample read) { return std::move(read.example); });
    }

    // "pointer: detail" of every fault, one a line.
    [[nodiscard]] std::string faults() const {
        const auto example = read();
        std::string text;
        if (!example) {
            for (const Fault& fault : example.error().faults) {
                text += fault.pointer + ": " + fault.detail + "\n";
            }
        }
        return text;
    }

  private:
    std::string nodes_;
    std::string roots_;
    std::string meshes_;
    std::string accessors_;
    std::string views_;
    std::string data_;
    std::string scene_extras_;
    std::string asset_extras_;
    std::size_t count_ = 0;
    std::size_t nodes_count_ = 0;
};

GlbBuilder one(const Corners& corners, const std::string& more = "") {
    GlbBuilder builder;
    builder.node("A", {{0, corners}}, more);
    return builder;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

double volume_of(const Polyhedron& solid) {
    double sum = 0;
    for (const Face& face : solid.faces) {
        sum += area_vector(solid, face).dot(solid.corners[face.front()]) / 3;
    }
    return sum;
}

// Noise as single precision makes it.
Polyhedron turned(Polyhedron solid, double angle, const Point& axis) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    for (Point& corner : solid.corners) {
        corner = turn * corner;
    }
    return solid;
}

TEST(MeshImport, ABoxHasItsSixFacesAgain) {
    const auto example = one(triangles_of(box(1, {0, 0, 0}, {1, 2, 3}))).read();
    ASSERT_TRUE(example) << example.error().message;
    ASSERT_EQ(example->polyhedra.size(), 1U);
    const Polyhedron& solid = example->polyhedra.front();
    EXPECT_EQ(solid.name, "A");
    EXPECT_EQ(solid.corners.size(), 8U);
    EXPECT_EQ(solid.faces.size(), 6U);
    EXPECT_TRUE(std::all_of(solid.faces.begin(), solid.faces.end(), [](const Face& face) {
        return face.size() == 4;
    }));
    EXPECT_DOUBLE_EQ(volume_of(solid), 6);
    ASSERT_EQ(example->objects.size(), 1U);
    EXPECT_EQ(example->objects.front().name, "wall");
    EXPECT_EQ(example->materials.front().name, "wall");
    EXPECT_FALSE(example->ground);
    EXPECT_DOUBLE_EQ(example->spacing, 1);
    EXPECT_TRUE(ExampleReading::make(*example));
}

TEST(MeshImport, AnLKeepsItsShape) {
    const Polyhedron l_shape =
        prism_upwards(1, {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1);
    const auto example = one(triangles_of(l_shape)).read();
    ASSERT_TRUE(example);
    EXPECT_EQ(example->polyhedra.front().faces.size(), 8U);
    EXPECT_DOUBLE_EQ(volume_of(example->polyhedra.front()), 4);
}

TEST(MeshImport, AFaceWithAHoleStaysTriangles) {
    // A block with a shaft through it: the outlines of top and bottom are two.
    Corners corners;
    const std::array<Point2, 8> plan = {
        {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {1, 2}, {2, 2}, {2, 1}}};
    const Loop outer = {0, 1, 2, 3};
    const std::vector<Loop> holes = {{4, 5, 6, 7}};
    const auto place = [&](std::uint32_t i, double y) { return Point(plan[i][0], y, -plan[i][1]); };
    for (const auto& [a, b, c] : triangulate(plan, outer, holes)) {
        corners = corners + Corners{place(a, 1), place(b, 1), place(c, 1)};
        corners = corners + Corners{place(c, 0), place(b, 0), place(a, 0)};
    }
    for (const Loop& loop : {outer, holes.front()}) {
        for (std::size_t i = 0; i < 4; ++i) {
            const std::uint32_t a = loop[i];
            const std::uint32_t b = loop[(i + 1) % 4];
            corners = corners + Corners{place(a, 0), place(b, 0), place(b, 1)};
            corners = corners + Corners{place(a, 0), place(b, 1), place(a, 1)};
        }
    }
    const auto example = one(corners).read();
    ASSERT_TRUE(example) << one(corners).faults();
    EXPECT_EQ(example->polyhedra.front().faces.size(), 8U + 2 * 8);
    EXPECT_DOUBLE_EQ(volume_of(example->polyhedra.front()), 8);
}

TEST(MeshImport, NodesStandWhereTheSceneHasThem) {
    auto kit = std::make_shared<Kit>();
    kit->materials = {{"stone", {}}};
    Primitive primitive;
    for (const Point& corner : triangles_of(box(1, {-1, 0, -1}, {1, 1, 1}))) {
        primitive.indices.push_back(static_cast<std::uint32_t>(primitive.positions.size()));
        primitive.positions.push_back(
            {static_cast<float>(corner.x()),
             static_cast<float>(corner.y()),
             static_cast<float>(corner.z())}
        );
    }
    primitive.normals.resize(primitive.positions.size(), {0, 1, 0});
    primitive.colors.resize(primitive.positions.size(), {255, 255, 255});
    kit->meshes = {{"block", {primitive}}};
    Scene scene;
    scene.kit = kit;
    scene.names = {"first", "second"};
    scene.groups = {{"", {{0, 0, {10, 0, 0}, 0}}}, {"group", {{0, 1, {13, 5, 0}, 1}}}};
    const auto glb = write_glb(scene);
    ASSERT_TRUE(glb);
    const auto read = read_example_glb(bytes_of(*glb));
    ASSERT_TRUE(read) << read.error().message;
    const Example* const example = &read->example;
    ASSERT_EQ(example->polyhedra.size(), 2U);
    Eigen::AlignedBox3d second;
    for (const Point& corner : example->polyhedra[1].corners) {
        second.extend(corner);
    }
    EXPECT_LT((second.min() - Point(12, 5, -1)).norm(), 1e-6);
    EXPECT_LT((second.max() - Point(14, 6, 1)).norm(), 1e-6);
    EXPECT_EQ(example->objects.front().name, "stone");
}

TEST(MeshImport, MirroredNodesAreNotInsideOut) {
    const auto example =
        one(triangles_of(box(1, {0, 0, 0}, {1, 2, 3})), R"("scale":[-1,1,2])").read();
    ASSERT_TRUE(example);
    EXPECT_DOUBLE_EQ(volume_of(example->polyhedra.front()), 12);
}

TEST(MeshImport, ObjectsAreNamedByExtrasOrMaterial) {
    GlbBuilder builder;
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    const Corners lid = triangles_of(box(1, {0, 1, 0}, {1, 2, 1}));
    builder.node("house", {{0, cube}, {1, lid}})
        .node("tower", {{1, cube}}, R"("translation":[3,0,0],"extras":{"object":"tower"})")
        .node("bare", {{-1, cube}}, R"("translation":[6,0,0],"extras":{"object":7})");
    const auto example = builder.read();
    ASSERT_TRUE(example) << builder.faults();
    ASSERT_EQ(example->polyhedra.size(), 4U);
    std::vector<std::string> names;
    for (const Polyhedron& solid : example->polyhedra) {
        names.push_back(example->objects[solid.object - 1U].name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"wall", "roof", "tower", "default"}));
    EXPECT_EQ(example->materials[example->objects[2].material].name, "roof");
}

TEST(MeshImport, AnObjectHasOneMaterial) {
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    GlbBuilder builder;
    builder.node("A", {{0, cube}}, R"("extras":{"object":"x"})")
        .node("B", {{1, cube}}, R"("translation":[3,0,0],"extras":{"object":"x"})");
    EXPECT_EQ(
        builder.faults(),
        "/nodes/1: node \"B\": object \"x\" has material \"roof\" here and another one, \"wall\", "
        "before\n"
    );
}

TEST(MeshImport, NamesOfAnyLengthAreCutBetweenCharacters) {
    std::string name;
    for (int i = 0; i < 100; ++i) {
        name += "\u00fc\u4e16";
    }
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    const auto example = GlbBuilder().node(name, {{0, cube}}).read();
    ASSERT_TRUE(example);
    const std::string& cut = example->polyhedra.front().name;
    EXPECT_EQ(cut, name.substr(0, 62) + "...");
    GlbBuilder builder;
    builder.node("A", {{0, cube}}, R"("extras":{"object":")" + name + "\"}");
    EXPECT_TRUE(contains(builder.faults(), "has too long a name")) << builder.faults();
}

TEST(MeshImport, ClosedPartsOfAMeshAreSolids) {
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    // Apart; at a face; at an edge; at a corner; one in the other.
    for (const Point& by :
         {Point(3, 0, 0), Point(1, 0, 0), Point(1, 1, 0), Point(1, 1, 1), Point(0.5, 0.5, 0.5)}) {
        const Corners other = triangles_of(examples::moved(box(1, {0, 0, 0}, {1, 1, 1}), by));
        const auto builder = one(cube + other);
        const auto example = builder.read();
        ASSERT_TRUE(example) << builder.faults();
        ASSERT_EQ(example->polyhedra.size(), 2U);
        for (const Polyhedron& solid : example->polyhedra) {
            EXPECT_EQ(solid.faces.size(), 6U);
            EXPECT_DOUBLE_EQ(volume_of(solid), 1);
        }
    }
}

TEST(MeshImport, AHollowIsPartOfWhatIsAroundIt) {
    Corners hollow = triangles_of(box(1, {1, 1, 1}, {2, 2, 2}));
    std::reverse(hollow.begin(), hollow.end());
    const auto builder = one(triangles_of(box(1, {0, 0, 0}, {3, 3, 3})) + hollow);
    const auto example = builder.read();
    ASSERT_TRUE(example) << builder.faults();
    ASSERT_EQ(example->polyhedra.size(), 1U);
    EXPECT_DOUBLE_EQ(volume_of(example->polyhedra.front()), 26);
}

TEST(MeshImport, NamesTheOpenEdges) {
    Corners open = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    open.resize(open.size() - 3);
    const std::string faults = one(open).faults();
    EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 3) << faults;
    EXPECT_TRUE(contains(faults, "/nodes/0: node \"A\", triangle 10: the edge from (")) << faults;
    EXPECT_TRUE(contains(faults, "is open: no other triangle of object \"wall\"")) << faults;
    // Closed, but of two materials.
    Corners closed = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    GlbBuilder two;
    two.node(
        "B", {{0, {closed.begin(), closed.begin() + 6}}, {1, {closed.begin() + 6, closed.end()}}}
    );
    EXPECT_TRUE(contains(two.faults(), "triangle of object \"roof\"")) << two.faults();
}

TEST(MeshImport, RefusesWhatIsNoSolid) {
    Corners inverted = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    std::reverse(inverted.begin(), inverted.end());
    EXPECT_TRUE(contains(one(inverted).faults(), "/nodes/0: node \"A\": its faces look inwards"));
    Corners twice = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    twice.insert(twice.end(), twice.begin(), twice.begin() + 3);
    EXPECT_TRUE(contains(one(twice).faults(), "is open")) << one(twice).faults();
    EXPECT_TRUE(contains(one(quad(1)).faults(), "is open"));
    EXPECT_TRUE(contains(
        one(triangles_of(box(1, {0, 0, 0}, {1, 1, 1})), R"("scale":[0,0,0])").faults(),
        "no triangle with an area"
    ));
    EXPECT_TRUE(contains(
        one(triangles_of(box(1, {0, 0, 0}, {1, 1, 1})), R"("translation":[1e300,0,0])").faults(),
        "not within 100000 m"
    ));
    // A twisted box: its middle is where its sides go through each other.
    Polyhedron twisted = box(1, {0, 0, 0}, {1, 1, 1});
    for (Point& corner : twisted.corners) {
        if (corner.y() > 0.5) {
            corner = Point(1.2 - corner.x(), corner.y(), 1.1 - corner.z());
        }
    }
    EXPECT_TRUE(contains(one(triangles_of(twisted)).faults(), "node \"A\", triangle "));
    const auto nothing = GlbBuilder().node("G", {{2, quad(0)}}).faults();
    EXPECT_EQ(nothing, ": an example needs at least one polyhedron\n");
}

TEST(MeshImport, AFlatNodeIsTheGround) {
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    GlbBuilder by_name;
    by_name.node("house", {{0, cube}}).node("meadow", {{2, quad(0)}});
    auto example = by_name.read();
    ASSERT_TRUE(example) << by_name.faults();
    ASSERT_TRUE(example->ground);
    EXPECT_EQ(example->objects[*example->ground - 1U].name, "ground");
    EXPECT_EQ(example->polyhedra.size(), 1U);
    EXPECT_TRUE(ExampleReading::make(*example));

    GlbBuilder by_flag;
    by_flag.node("meadow", {{1, quad(0)}}, R"("extras":{"ground":true,"object":"grass"})")
        .node("house", {{0, cube}});
    example = by_flag.read();
    ASSERT_TRUE(example) << by_flag.faults();
    EXPECT_EQ(example->objects[*example->ground - 1U].name, "grass");

    GlbBuilder by_number;  // as Blender 3.4 writes a True
    by_number.node("meadow", {{1, quad(0)}}, R"("extras":{"ground":1,"object":"grass"})")
        .node("house", {{0, cube}}, R"("extras":{"ground":0})");
    example = by_number.read();
    ASSERT_TRUE(example) << by_number.faults();
    EXPECT_EQ(example->objects[*example->ground - 1U].name, "grass");
    EXPECT_EQ(example->polyhedra.size(), 1U);

    for (const char* other : {R"("yes")", "2", "null", "[true]"}) {
        GlbBuilder unclear;
        unclear.node("house", {{0, cube}}, std::string(R"("extras":{"ground":)") + other + "}");
        EXPECT_EQ(
            unclear.faults(),
            "/nodes/0: node \"house\" has a property \"ground\" that is neither true nor false\n"
        ) << other;
    }

    GlbBuilder wrong;
    wrong.node("house", {{0, cube}}, R"("extras":{"ground":true})")
        .node("high", {{2, quad(1)}})
        .node("G", {{2, quad(0)}})
        .node("H", {{0, quad(0)}}, R"("extras":{"ground":true})");
    EXPECT_EQ(
        wrong.faults(),
        "/nodes/0: node \"house\" is said to be the ground, but is not flat and horizontal\n"
        "/nodes/1: node \"high\" is the ground, which has to be at y = 0, and is at (0, 1, 0) m\n"
        "/nodes/3: node \"H\" is ground of another object than another node\n"
    );
}

// "in_example from in_file of who", a line each.
std::string said_by(const GlbBuilder& builder) {
    const auto read = builder.read_all();
    std::string text;
    if (read) {
        for (const SaidField& field : read->said) {
            text += field.source.in_example + " from " + field.source.in_file + " of " +
                    field.source.who + "\n";
        }
    }
    return text + builder.faults();
}

TEST(MeshImport, TellsWhatExtrasSayOfTheExample) {
    GlbBuilder builder = one(triangles_of(box(1, {0, 0, 0}, {1, 1, 1})));
    builder.asset_extras(R"({"spacing":3,"program":"x"})")
        .scene_extras(R"({"spacing":2,"constraints":[],"name":7})");
    EXPECT_EQ(
        said_by(builder),
        "/spacing from /asset/extras/spacing of the file\n"
        "/name from /scenes/0/extras/name of the scene\n"
        "/spacing from /scenes/0/extras/spacing of the scene\n"
        "/constraints from /scenes/0/extras/constraints of the scene\n"
    );
    const auto read = builder.read_all();
    EXPECT_EQ(*read->said[3].value, Extra{Extra::List()});  // empty, and said
}

TEST(MeshImport, TellsWhatExtrasSayOfObjects) {
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    GlbBuilder builder;
    builder.node("A", {{0, cube}}, R"("extras":{"weight":2147483648,"more":1})")
        .node("B", {{0, cube}}, R"("translation":[3,0,0],"extras":{"weight":2147483648})")
        .node("C", {{1, cube}}, R"("translation":[6,0,0],"extras":{"decorations":"[]"})");
    EXPECT_EQ(
        said_by(builder),
        "/objects/0/weight from /nodes/0/extras/weight of node \"A\"\n"
        "/objects/1/decorations from /nodes/2/extras/decorations of node \"C\"\n"
    );
    EXPECT_EQ(*builder.read_all()->said[0].value, Extra{2147483648.0});
    builder.node("D", {{0, cube}}, R"("translation":[9,0,0],"extras":{"weight":3})");
    EXPECT_EQ(
        builder.faults(), "/nodes/3/extras/weight: node \"D\" says otherwise than node \"A\"\n"
    );
}

TEST(MeshImport, TakesNodesForShapesAndDecorations) {
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    const Corners gem =
        triangles_of(examples::pyramid(1, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0, {0.5, 1, -0.5}));
    const Corners profile = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    GlbBuilder builder;
    builder.node("gem", {{1, gem}}, R"("extras":{"shape":"wall","even":"x z"})")
        .node("house", {{0, cube}})
        .node(
            "coping",
            {{0, profile}},
            R"("translation":[7,0,0],"extras":{"decorates":"wall",)"
            R"("edges":"up side"})"
        )
        .node(
            "ball",
            {{1, gem}},
            R"("translation":[9,0,0],"scale":[2,2,2],"extras":)"
            R"({"decorates":"wall","corners":"any any any","smooth":0})"
        );
    EXPECT_EQ(
        said_by(builder),
        "/objects/0/shape/even from /nodes/0/extras/even of node \"gem\"\n"
        "/objects/0/decorations/0/edges from /nodes/2/extras/edges of node \"coping\"\n"
        "/objects/0/decorations/1/corners from /nodes/3/extras/corners of node \"ball\"\n"
        "/objects/0/decorations/1/mesh/smooth from /nodes/3/extras/smooth of node \"ball\"\n"
    );
    const Example example = builder.read_all()->example;
    EXPECT_EQ(example.polyhedra.size(), 1U);
    ASSERT_EQ(example.objects.size(), 2U);
    ASSERT_NE(example.objects[0].shape, nullptr);
    EXPECT_EQ(example.objects[0].shape->faces.size(), 5U);
    ASSERT_EQ(example.objects[0].decorations.size(), 2U);
    const auto& coping = std::get<EdgeDecoration>(example.objects[0].decorations[0]);
    EXPECT_EQ(coping.profile, (std::vector<ProfilePoint>{{0, 0}, {2, 0}, {2, 1}, {0, 1}}));
    EXPECT_EQ(coping.look, kEmpty);
    const auto& ball = std::get<CornerDecoration>(example.objects[0].decorations[1]);
    EXPECT_EQ(example.objects[ball.look - 1U].name, "roof");
    Eigen::AlignedBox3d box;
    for (const Point& corner : ball.mesh->corners) {
        box.extend(corner);
    }
    EXPECT_EQ(box.max(), Point(2, 2, 0));
}

TEST(MeshImport, NamesNodesThatAreNoShapesOrDecorations) {
    const Corners cube = triangles_of(box(1, {0, 0, 0}, {1, 1, 1}));
    Corners open = cube;
    open.resize(open.size() - 3);
    GlbBuilder builder;
    builder.node("house", {{0, cube}})
        .node("a", {{0, cube}}, R"("extras":{"shape":"door"})")
        .node("b", {{0, open}}, R"("extras":{"shape":"wall"})")
        .node("c", {{0, cube}}, R"("extras":{"decorates":"wall","edges":"up side"})")
        .node("d", {{0, cube}}, R"("extras":{"decorates":"wall"})")
        .node("e", {{0, cube}}, R"("extras":{"decorates":7,"corners":"any any any"})");
    const std::string faults = builder.faults();
    for (const char* fault :
         {"/nodes/1/extras/shape: node \"a\": no other node is of object \"door\"\n",
          "/nodes/2: node \"b\" is not closed: the edge from ",
          "/nodes/3: node \"c\" is to be swept along edges, but is no flat mesh",
          "/nodes/4: node \"d\" decorates \"wall\", and must have \"edges\" or \"corners\"\n",
          "/nodes/5/extras/decorates: node \"e\": no other node is of object \"\"\n"}) {
        EXPECT_TRUE(contains(faults, fault)) << faults;
    }
}

TEST(NodeMeshes, CutFacesThatAreNotConvex) {
    const auto shape = shape_of_mesh(
        triangles_of(prism_upwards(1, {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1))
    );
    ASSERT_TRUE(shape) << shape.error();
    EXPECT_EQ(shape->corners.size(), 12U);
    EXPECT_EQ(shape->faces.size(), 6U + 2 * 4U);  // sides, and four triangles at either end
    Example example;
    example.materials = {{}};
    example.objects = {{"shape"}};
    example.polyhedra = {{"shape", 1, shape->corners, shape->faces}};
    EXPECT_TRUE(find_solid_faults(example).empty());
}

TEST(NodeMeshes, ProfilesAreOneOutline) {
    const Corners square = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    Corners both = square;
    for (const Point& corner : square) {
        both.push_back(corner + Point(5, 0, 0));
    }
    EXPECT_TRUE(profile_of_mesh(square));
    EXPECT_FALSE(profile_of_mesh(both));
    Corners twice = square;
    twice.insert(twice.end(), square.begin(), square.end());
    EXPECT_FALSE(profile_of_mesh(twice));
    EXPECT_FALSE(profile_of_mesh(Corners(3, Point(1, 2, 3))));
    EXPECT_FALSE(profile_of_mesh(quad(0)));
}

TEST(MeshImport, ToleratesTheNoiseOfSinglePrecision) {
    const Point axis(1, 2, -3);
    const Polyhedron lower =
        turned(prism_upwards(1, {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 1), 0.7, axis);
    const Polyhedron upper = turned(box(1, {0, 1, -2}, {1, 2.5, 0}), 0.7, axis);
    const auto builder = one(triangles_of(lower) + triangles_of(upper));
    const auto example = builder.read();
    ASSERT_TRUE(example) << builder.faults();
    ASSERT_EQ(example->polyhedra.size(), 2U);
    EXPECT_EQ(example->polyhedra[0].faces.size(), 8U);
    EXPECT_EQ(example->polyhedra[1].faces.size(), 6U);
    const auto families = find_families(std::span(&*example, 1));
    ASSERT_TRUE(families);
    EXPECT_EQ(families->normals.size(), 3U);
    EXPECT_NEAR(example->spacing, 1, 1e-5);
}

TEST(MeshImport, MergesAPlaneOfManySmallTriangles) {
    // A box whose sides are divided, turned, and off by what single precision makes of it.
    constexpr int kSteps = 20;
    std::mt19937_64 random(1);
    Corners corners;
    for (const auto& [u, v] : std::vector<std::pair<Point, Point>>{
             {{1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, 1}}, {{0, 0, 1}, {1, 0, 0}}}) {
        for (int i = 0; i < kSteps * kSteps; ++i) {
            const auto at = [&](int a, int b, double side) {
                const double p = 10.0 * (i / kSteps + a) / kSteps;
                const double q = 10.0 * (i % kSteps + b) / kSteps;
                return Point(p * u + q * v + 10 * side * u.cross(v));
            };
            corners = corners + Corners{at(0, 0, 1), at(1, 0, 1), at(1, 1, 1)} +
                      Corners{at(0, 0, 1), at(1, 1, 1), at(0, 1, 1)} +
                      Corners{at(1, 1, 0), at(1, 0, 0), at(0, 0, 0)} +
                      Corners{at(0, 1, 0), at(1, 1, 0), at(0, 0, 0)};
        }
    }
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.4, Point(3, 1, 2).normalized()).toRotationMatrix();
    for (Point& corner : corners) {
        corner = turn * corner;
    }
    const auto builder = one(corners);
    const auto example = builder.read();
    ASSERT_TRUE(example) << builder.faults();
    ASSERT_EQ(example->polyhedra.size(), 1U);
    EXPECT_EQ(example->polyhedra.front().faces.size(), 6U);
    EXPECT_NEAR(volume_of(example->polyhedra.front()), 1000, 1e-2);
}

TEST(MeshImport, TrianglesWithoutHeightJoinAFace) {
    // One side is divided at the middle of an edge; a triangle without height joins it to the next.
    Corners corners;
    const Polyhedron cube = box(1, {0, 0, 0}, {1, 1, 1});
    for (const Face& face : cube.faces) {
        std::vector<Point> at;
        for (const std::uint32_t corner : face) {
            at.push_back(cube.corners[corner]);
        }
        if (area_vector(cube, face).y() > 0.5) {
            const Point middle = (at[0] + at[1]) / 2;
            corners = corners + Corners{at[0], middle, at[3]} + Corners{middle, at[1], at[2]} +
                      Corners{middle, at[2], at[3]} + Corners{at[0], at[1], middle};
        } else {
            corners = corners + Corners{at[0], at[1], at[2]} + Corners{at[0], at[2], at[3]};
        }
    }
    const auto builder = one(corners);
    const auto example = builder.read();
    ASSERT_TRUE(example) << builder.faults();
    EXPECT_EQ(example->polyhedra.front().faces.size(), 6U);
    EXPECT_TRUE(ExampleReading::make(*example));
}

TEST(MeshImport, ReadsTheBuiltInExamplesBack) {
    for (const Example& original : {examples::make_houses(), examples::make_skyscrapers()}) {
        GlbBuilder builder;
        for (const Polyhedron& solid : original.polyhedra) {
            builder.node(
                "solid",
                {{-1, triangles_of(solid)}},
                R"("extras":{"object":")" + original.objects[solid.object - 1U].name + "\"}"
            );
        }
        const auto example = builder.read();
        ASSERT_TRUE(example) << builder.faults();
        ASSERT_EQ(example->polyhedra.size(), original.polyhedra.size());
        for (std::size_t i = 0; i < original.polyhedra.size(); ++i) {
            EXPECT_EQ(example->polyhedra[i].faces.size(), original.polyhedra[i].faces.size());
            EXPECT_NEAR(volume_of(example->polyhedra[i]), volume_of(original.polyhedra[i]), 1e-4);
        }
    }
}

TEST(MeshImport, HoldsItsLimitOfTriangles) {
    Corners many;
    for (std::size_t i = 0; i <= kTrianglesMax; ++i) {
        many.insert(many.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    }
    const auto example = one(many).read();
    ASSERT_FALSE(example);
    EXPECT_EQ(example.error().code, ErrorCode::kTooLarge) << example.error().message;
    many.resize(3 * kTrianglesMax);
    EXPECT_TRUE(contains(one(many).faults(), "is open"));
}

TEST(MeshImport, EndsWhateverTheTrianglesAre) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        Corners corners;
        const std::uint64_t size = 2 + seed % 3;
        for (std::uint64_t i = 3 * (4 + random() % 200); i > 0; --i) {
            corners.push_back(Point(
                static_cast<double>(random() % size),
                static_cast<double>(random() % size),
                static_cast<double>(random() % size)
            ));
        }
        if (seed % 2 == 1) {
            // Closed, at least as far as numbers go.
            for (std::size_t i = corners.size(); i > 0; i -= 3) {
                corners.insert(corners.end(), {corners[i - 1], corners[i - 2], corners[i - 3]});
            }
        }
        const auto example = one(corners).read();
        if (example) {
            EXPECT_TRUE(find_solid_faults(*example).empty());
        } else {
            EXPECT_FALSE(example.error().faults.empty());
        }
    }
}

TEST(MeshImport, RefusesEveryTruncation) {
    const std::string glb = one(triangles_of(box(1, {0, 0, 0}, {1, 1, 1}))).bytes();
    for (std::size_t length = 0; length < glb.size(); ++length) {
        EXPECT_FALSE(read_example_glb(bytes_of(glb.substr(0, length)))) << length;
    }
}

TEST(DefaultSpacing, IsTheLeastDistanceOfParallelFaces) {
    Example example;
    example.objects = {{"wall", 0}};
    example.polyhedra = {box(1, {0, 0, 0}, {10, 4, 3}), box(1, {2, 4, 0.5}, {4, 5.5, 2.25})};
    EXPECT_DOUBLE_EQ(default_spacing(example), 0.5);
    example.polyhedra[1] = box(1, {2, 4, 0.005}, {4, 5.5, 2.25});
    EXPECT_DOUBLE_EQ(default_spacing(example), 0.75);
    example.polyhedra = {box(1, {0, 0.25, 0}, {10, 4, 3})};
    example.ground = ObjectId{1};
    EXPECT_DOUBLE_EQ(default_spacing(example), 0.25);
    example.ground.reset();
    example.polyhedra = {examples::pyramid(1, {{0, 0}, {1, 0}, {0, 1}}, 0, {0.2, 1, -0.2})};
    EXPECT_EQ(default_spacing(example), 1);
}

}  // namespace
}  // namespace modelsynth::continuous
