#include "solver/continuous/check/solid_check.h"

#include "solver/continuous/reading/reading.h"
#include "solver/examples/solids/built_in_solids.h"
#include "solver/examples/solids/shapes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {
namespace {

using examples::box;
using examples::prism_upwards;

Example example_of(std::vector<Polyhedron> solids) {
    Example example;
    example.materials = {{"stone", {}}};
    example.objects = {{"wall", 0}};
    example.polyhedra = std::move(solids);
    return example;
}

Polyhedron cube() { return box(1, {0, 0, 0}, {1, 1, 1}); }

// One polyhedron with the corners and faces of both.
Polyhedron joined(Polyhedron solid, const Polyhedron& other) {
    const auto first = static_cast<std::uint32_t>(solid.corners.size());
    solid.corners.insert(solid.corners.end(), other.corners.begin(), other.corners.end());
    for (Face face : other.faces) {
        for (std::uint32_t& corner : face) {
            corner += first;
        }
        solid.faces.push_back(std::move(face));
    }
    return solid;
}

Polyhedron turned_inside_out(Polyhedron solid) {
    for (Face& face : solid.faces) {
        std::reverse(face.begin(), face.end());
    }
    return solid;
}

// "pointer: detail" of every fault, one a line.
std::string faults_of(const Example& example) {
    std::string text;
    for (const Fault& fault : find_solid_faults(example)) {
        text += fault.pointer + ": " + fault.detail + "\n";
    }
    return text;
}

std::string faults_of(Polyhedron solid) { return faults_of(example_of({std::move(solid)})); }

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// A closed surface around the y axis with random dents, of 2 * steps * steps triangles or so.
Polyhedron bumpy_ball(std::uint32_t steps) {
    Polyhedron ball;
    ball.corners = {{0, -1, 0}, {0, 1, 0}};
    for (std::uint32_t ring = 1; ring < steps; ++ring) {
        for (std::uint32_t i = 0; i < steps; ++i) {
            const double tilt = std::numbers::pi * ring / steps;
            const double turn = 2 * std::numbers::pi * i / steps;
            const double radius = 1 + 0.2 * ((ring * 7 + i * 13) % 5);
            ball.corners.push_back(
                radius * Point(
                             std::sin(tilt) * std::cos(turn),
                             -std::cos(tilt),
                             std::sin(tilt) * std::sin(turn)
                         )
            );
        }
    }
    const auto corner = [&](std::uint32_t ring, std::uint32_t i) {
        return ring == 0 ? 0 : ring == steps ? 1 : 2 + (ring - 1) * steps + i % steps;
    };
    for (std::uint32_t ring = 0; ring < steps; ++ring) {
        for (std::uint32_t i = 0; i < steps; ++i) {
            if (ring > 0) {
                ball.faces.push_back({corner(ring, i), corner(ring + 1, i), corner(ring, i + 1)});
            }
            if (ring + 1 < steps) {
                ball.faces.push_back(
                    {corner(ring, i + 1), corner(ring + 1, i), corner(ring + 1, i + 1)}
                );
            }
        }
    }
    return ball;
}

TEST(SolidCheck, TakesSolids) {
    EXPECT_EQ(faults_of(cube()), "");
    EXPECT_EQ(
        faults_of(examples::pyramid(1, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0, {0.5, 2, 0})), ""
    );
    EXPECT_EQ(faults_of(bumpy_ball(12)), "");
}

TEST(SolidCheck, TakesTheBuiltInExamples) {
    EXPECT_EQ(faults_of(examples::make_houses()), "");
    EXPECT_EQ(faults_of(examples::make_skyscrapers()), "");
}

TEST(SolidCheck, TakesASolidThatIsNotConvex) {
    EXPECT_EQ(
        faults_of(prism_upwards(1, {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 0, 2)), ""
    );
    // A star whose faces' planes all pass through other faces.
    examples::Outline star;
    for (int i = 0; i < 40; ++i) {
        const double radius = i % 2 == 0 ? 1 : 3;
        const double angle = std::numbers::pi * i / 20;
        star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    EXPECT_EQ(faults_of(prism_upwards(1, star, 0, 2)), "");
}

TEST(SolidCheck, TakesCornersWithinAnEdge) {
    EXPECT_EQ(faults_of(prism_upwards(1, {{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0, 1}}, 0, 1)), "");
}

TEST(SolidCheck, TakesSolidsThatTouchOrOverlap) {
    EXPECT_EQ(faults_of(example_of({cube(), box(1, {1, 0, 0}, {2, 1, 1})})), "");
    EXPECT_EQ(faults_of(example_of({cube(), box(1, {0.5, 0.5, 0.5}, {2, 2, 2})})), "");
    EXPECT_EQ(faults_of(example_of({cube(), cube()})), "");
}

TEST(SolidCheck, TakesASolidThatTouchesItself) {
    // At a face, at an edge, at a corner, with a face that ends on another, and with a hollow.
    EXPECT_EQ(faults_of(joined(cube(), box(1, {1, 0, 0}, {2, 1, 1}))), "");
    EXPECT_EQ(faults_of(joined(cube(), box(1, {1, 1, 0}, {2, 2, 1}))), "");
    EXPECT_EQ(faults_of(joined(cube(), box(1, {1, 1, 1}, {2, 2, 2}))), "");
    EXPECT_EQ(faults_of(joined(cube(), box(1, {0.25, 1, 0.25}, {0.75, 3, 3}))), "");
    EXPECT_EQ(
        faults_of(
            joined(box(1, {0, 0, 0}, {3, 3, 3}), turned_inside_out(box(1, {1, 1, 1}, {2, 2, 2})))
        ),
        ""
    );
}

TEST(SolidCheck, ToleratesNoise) {
    Polyhedron noisy = joined(cube(), box(1, {0.25, 1, 0.25}, {0.75, 3, 3}));
    for (std::size_t i = 0; i < noisy.corners.size(); ++i) {
        noisy.corners[i][static_cast<Eigen::Index>(i % 3)] += i % 2 == 0 ? 5e-7 : -5e-7;
    }
    EXPECT_EQ(faults_of(noisy), "");
}

TEST(SolidCheck, NamesTheEdgesOfAnOpening) {
    Polyhedron open = cube();
    const Face lid = open.faces.back();
    open.faces.pop_back();
    const std::string faults = faults_of(open);
    EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 4) << faults;
    EXPECT_TRUE(contains(
        faults,
        "the edge from " + place_text(open.corners[lid[1]]) + " to " +
            place_text(open.corners[lid[0]]) + " is open"
    )) << faults;
}

TEST(SolidCheck, SaysThatCornersAtOnePlaceAreNotOne) {
    Polyhedron unwelded;
    for (const Face& face : cube().faces) {
        Face own;
        for (const std::uint32_t corner : face) {
            own.push_back(static_cast<std::uint32_t>(unwelded.corners.size()));
            unwelded.corners.push_back(cube().corners[corner]);
        }
        unwelded.faces.push_back(own);
    }
    EXPECT_TRUE(contains(faults_of(unwelded), "faces share an edge only by numbers"));
}

TEST(SolidCheck, NamesEdgesThatRunTheSameWayTwice) {
    Polyhedron twice = cube();
    twice.faces.push_back(twice.faces[2]);
    EXPECT_TRUE(contains(faults_of(twice), "/polyhedra/0/faces/6: the edge from ("));
    EXPECT_TRUE(contains(faults_of(twice), "runs the same way in face 2"));
    Polyhedron flipped = cube();
    std::reverse(flipped.faces[3].begin(), flipped.faces[3].end());
    EXPECT_TRUE(contains(faults_of(flipped), "runs the same way in face"));
}

TEST(SolidCheck, RefusesFacesThatLookInwards) {
    EXPECT_TRUE(
        contains(faults_of(turned_inside_out(cube())), "/polyhedra/0: its faces look inwards")
    );
}

TEST(SolidCheck, RefusesASheet) {
    Polyhedron sheet;
    sheet.corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    sheet.faces = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {0, 3, 1}};
    EXPECT_EQ(faults_of(sheet), "/polyhedra/0: it encloses no space\n");
}

TEST(SolidCheck, NamesTheCornersThatAreNoPlaces) {
    for (const double bad :
         {std::nan(""), std::numeric_limits<double>::infinity(), -1.5e5, 1.01e5}) {
        Polyhedron solid = cube();
        solid.corners[2].y() = bad;
        EXPECT_TRUE(contains(faults_of(solid), "/polyhedra/0/corners/2: ")) << bad;
        EXPECT_EQ(find_solid_faults(example_of({solid})).size(), 1U);
    }
    Polyhedron far = cube();
    for (Point& corner : far.corners) {
        corner.x() += 99'999;
    }
    EXPECT_EQ(faults_of(far), "");
}

TEST(SolidCheck, NamesFacesWhoseNumbersMeanNothing) {
    Polyhedron solid = cube();
    solid.faces[1][2] = 8;
    solid.faces[2][0] = solid.faces[2][1];
    solid.faces[3].resize(2);
    solid.faces[4].clear();
    EXPECT_EQ(
        faults_of(solid),
        "/polyhedra/0/faces/1: corner 8 is not one of the 8 corners of the polyhedron, counted "
        "from 0\n"
        "/polyhedra/0/faces/2: has corner " +
            std::to_string(solid.faces[2][0]) + " at " +
            place_text(solid.corners[solid.faces[2][0]]) +
            " more than once\n"
            "/polyhedra/0/faces/3: has 2 corners; no face has less than 3\n"
            "/polyhedra/0/faces/4: has 0 corners; no face has less than 3\n"
    );
    solid = cube();
    solid.faces.resize(3);
    EXPECT_TRUE(contains(faults_of(solid), "no solid has less than 4"));
    solid.corners.clear();
    solid.faces.clear();
    EXPECT_TRUE(contains(faults_of(solid), "no solid has less than 4"));
}

TEST(SolidCheck, NamesFacesThatCrossThemselves) {
    // A bow tie as a plan: top and bottom cross themselves at one place, all edges are closed.
    const std::string bow_tie = faults_of(prism_upwards(1, {{0, 0}, {2, 2}, {2, 0}, {0, 1}}, 0, 1));
    EXPECT_TRUE(contains(bow_tie, "its border crosses itself at (")) << bow_tie;
    // Through a corner that lies on another edge.
    const std::string at_corner = faults_of(prism_upwards(
        1, {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 0}, {1.5, -1}, {1, 0}, {1, 3}, {0, 3}}, 0, 1
    ));
    EXPECT_TRUE(contains(at_corner, "its border crosses itself at (1, ")) << at_corner;
    // A border that goes on and comes back.
    const std::string thorn =
        faults_of(prism_upwards(1, {{0, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}}, 0, 1));
    EXPECT_TRUE(contains(thorn, "its border crosses itself at (3, ")) << thorn;
}

TEST(SolidCheck, NamesFacesThatCross) {
    const Polyhedron boxes = joined(cube(), box(1, {0.25, 0.5, 0.25}, {0.75, 2, 0.75}));
    const std::string faults = faults_of(boxes);
    EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 4) << faults;
    EXPECT_TRUE(contains(faults, " crosses face ") || contains(faults, ": crosses face "))
        << faults;
    EXPECT_TRUE(contains(faults, " at (0.5, 1, 0.25) m")) << faults;
    // One face goes through a hollow of another's outline: the planes cross, the faces do not.
    const Polyhedron frame =
        prism_upwards(1, {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 0, 1);
    EXPECT_EQ(faults_of(joined(frame, box(1, {1.25, -1, -2.5}, {1.75, 2, -1.5}))), "");
    EXPECT_NE(faults_of(joined(frame, box(1, {1.25, -1, -2.5}, {1.75, 2, -0.5}))), "");
}

TEST(SolidCheck, NamesFacesThatLieOnEachOther) {
    const std::string faults = faults_of(joined(cube(), box(1, {0.5, 0, 0}, {1.5, 1, 1})));
    EXPECT_TRUE(contains(faults, "lies on face ")) << faults;
}

TEST(SolidCheck, NamesNumbersOfObjectsAndMaterialsThatAreNone) {
    Example example = example_of({cube(), cube(), cube()});
    example.polyhedra[1].object = 2;
    example.polyhedra[2].object = 0;
    example.objects[0].material = 1;
    example.ground = ObjectId{7};
    example.bounds = Bounds{{0, 0, 0}, {1, 0, 1}};
    example.dimensions = {{1, {0, 1, 0}}, {3, {0, 0, 0}}};
    const std::string faults = faults_of(example);
    EXPECT_TRUE(contains(faults, "/polyhedra/1/object: object 2 is")) << faults;
    EXPECT_TRUE(contains(faults, "/polyhedra/2/object: object 0 is")) << faults;
    EXPECT_TRUE(contains(faults, "/objects/0/material: material 1 is")) << faults;
    EXPECT_TRUE(contains(faults, "/ground: object 7 is")) << faults;
    EXPECT_TRUE(contains(faults, "/bounds: from (0, 0, 0) m to (1, 0, 1) m")) << faults;
    EXPECT_TRUE(contains(faults, "/dimensions/1/object: object 3 is")) << faults;
    EXPECT_TRUE(contains(faults, "/dimensions/1/normal: ")) << faults;
    EXPECT_EQ(std::count(faults.begin(), faults.end(), '\n'), 7) << faults;
}

TEST(SolidCheck, HoldsItsLimitsAtTheirEdges) {
    EXPECT_EQ(faults_of(example_of({})), "/polyhedra: an example needs at least one polyhedron\n");
    std::vector<Polyhedron> many(
        kPolyhedraMax, examples::pyramid(1, {{0, 0}, {1, 0}, {0, 1}}, 0, {0, 1, 0})
    );
    EXPECT_EQ(faults_of(example_of(many)), "");
    many.push_back(many.front());
    const auto too_many = find_solid_faults(example_of(many));
    ASSERT_EQ(too_many.size(), 1U);
    EXPECT_EQ(too_many.front().pointer, "/polyhedra");
    EXPECT_TRUE(too_many.front().over_limit);

    for (const std::size_t corners : {kCornersOfFaceMax, kCornersOfFaceMax + 1}) {
        examples::Outline round;
        for (std::size_t i = 0; i < corners; ++i) {
            const double angle =
                2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
            round.push_back({std::cos(angle), std::sin(angle)});
        }
        const auto faults = find_solid_faults(example_of({prism_upwards(1, round, 0, 1)}));
        EXPECT_EQ(faults.size(), corners > kCornersOfFaceMax ? 2U : 0U);
        EXPECT_TRUE(std::all_of(faults.begin(), faults.end(), [](const Fault& fault) {
            return fault.over_limit;
        }));
    }
}

TEST(SolidCheck, NamesNoMoreFaultsThanOneReads) {
    std::vector<Polyhedron> sheets(40, cube());
    for (Polyhedron& sheet : sheets) {
        sheet.faces.resize(5);
    }
    EXPECT_EQ(find_solid_faults(example_of(sheets)).size(), kSolidFaultsMax);
}

TEST(SolidCheck, ChecksAsManyFacesAsItTakes) {
    const Polyhedron ball = bumpy_ball(100);
    ASSERT_GT(ball.faces.size(), 19'000U);
    ASSERT_LE(ball.faces.size(), kFacesMax);
    EXPECT_EQ(faults_of(ball), "");
}

TEST(SolidCheck, EndsWhereAllFacesAreBesideEachOther) {
    // Needles through one place: all cross each other.
    Polyhedron needles;
    for (int i = 0; i < 3000; ++i) {
        const double turn = 0.002 * i;
        const Point end = 100 * Point(std::cos(turn), 0.3 + 0.0001 * i, std::sin(turn));
        const auto first = static_cast<std::uint32_t>(needles.corners.size());
        needles.corners.insert(
            needles.corners.end(), {-end, -end + Point(0.5, 0, 0), -end + Point(0, 0.5, 0), end}
        );
        const Eigen::Matrix3d parts =
            (Eigen::Matrix3d() << Point(0.5, 0, 0), Point(0, 0.5, 0), 2 * end).finished();
        const bool is_right_handed = parts.determinant() < 0;
        for (const Face& face : {Face{0, 1, 2}, Face{0, 3, 1}, Face{1, 3, 2}, Face{2, 3, 0}}) {
            Face own;
            for (const std::uint32_t corner : face) {
                own.push_back(first + corner);
            }
            if (!is_right_handed) {
                std::reverse(own.begin(), own.end());
            }
            needles.faces.push_back(own);
        }
    }
    const auto faults = find_solid_faults(example_of({needles}));
    EXPECT_FALSE(faults.empty());
    EXPECT_LE(faults.size(), kSolidFaultsMax);
}

TEST(SolidCheck, EndsWhereNoneOfThemCross) {
    // Boxes within boxes, slanted so that all faces' own boxes meet.
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.6, Point(1, 2, 3).normalized()).toRotationMatrix();
    Polyhedron nested;
    for (int i = 0; i < 3000; ++i) {
        const double half = 100 + 0.01 * i;
        const Polyhedron shell = box(1, {-half, -half, -half}, {half, half, half});
        nested = joined(std::move(nested), i % 2 == 1 ? shell : turned_inside_out(shell));
    }
    for (Point& corner : nested.corners) {
        corner = turn * corner;
    }
    const auto faults = find_solid_faults(example_of({nested}));
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_TRUE(faults.front().over_limit) << faults.front().detail;
}

TEST(SolidCheck, ComesBeforeAnExampleIsRead) {
    Polyhedron open = cube();
    open.faces.pop_back();
    const auto reading = ExampleReading::make(example_of({open}));
    ASSERT_FALSE(reading);
    EXPECT_EQ(reading.error().code, ErrorCode::kInvalidArgument);
    EXPECT_EQ(reading.error().message, "the example has polyhedra that are no solids");
    EXPECT_EQ(reading.error().faults.size(), 4U);
    EXPECT_TRUE(ExampleReading::make(example_of({cube()})));
}

}  // namespace
}  // namespace modelsynth::continuous
