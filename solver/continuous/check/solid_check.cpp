#include "solver/continuous/check/solid_check.h"

#include "solver/continuous/check/face_crossings.h"
#include "solver/continuous/check/self_crossing.h"
#include "solver/continuous/reading/families.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

namespace modelsynth::continuous {

namespace {

// Corners nearer to a plane than this share of the extent lie in it: twice of what faces may be
// off flat (find_families()), so that what counts as flat there never crosses its neighbours here.
constexpr double kTouchTolerance = 2e-6;

std::string at_polyhedron(std::size_t polyhedron) {
    return "/polyhedra/" + std::to_string(polyhedron);
}

std::string at_face(std::size_t polyhedron, std::size_t face) {
    return at_polyhedron(polyhedron) + "/faces/" + std::to_string(face);
}

bool is_place(const Point& point) {
    // Not a number is not below the limit, either.
    return (point.array().abs() <= kCoordinateMax).all();
}

struct Edge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t face = 0;

    friend auto operator<=>(const Edge&, const Edge&) = default;
};

// The volume, positive if the faces look outwards.
double volume_of(const Polyhedron& solid) {
    const Point& origin = solid.corners[solid.faces.front().front()];
    double sum = 0;
    for (const Face& face : solid.faces) {
        sum += area_vector(solid, face).dot(solid.corners[face.front()] - origin);
    }
    return sum / 3;
}

// Says why an edge is open though another seems to be there.
std::string twin_text(const Polyhedron& solid, const Edge& edge) {
    for (const std::uint32_t end : {edge.from, edge.to}) {
        for (std::uint32_t other = 0; other < solid.corners.size(); ++other) {
            if (other != end && solid.corners[other] == solid.corners[end]) {
                return "; corner " + std::to_string(other) + " is where corner " +
                       std::to_string(end) + " is, and faces share an edge only by numbers";
            }
        }
    }
    return "";
}

class SolidCheck {
  public:
    explicit SolidCheck(const Example& example) : example_(example) {}

    std::vector<Fault> run() {
        check_limits();
        if (!faults_.empty()) {
            return std::move(faults_);
        }
        check_objects();
        check_bounds();
        check_dimensions();
        check_connected();
        std::vector<bool> is_sound;
        Eigen::AlignedBox3d box;
        for (std::size_t i = 0; i < example_.polyhedra.size(); ++i) {
            is_sound.push_back(check_numbers(i));
            for (const Point& corner : example_.polyhedra[i].corners) {
                if (is_place(corner)) {
                    box.extend(corner);
                }
            }
        }
        tolerance_ = kTouchTolerance * (box.isEmpty() ? 1 : box.sizes().maxCoeff());
        for (std::size_t i = 0; i < example_.polyhedra.size() && !is_full(); ++i) {
            if (is_sound[i]) {
                check_shape(i);
            }
        }
        return std::move(faults_);
    }

  private:
    [[nodiscard]] bool is_full() const { return faults_.size() >= kSolidFaultsMax; }

    void add(std::string pointer, std::string detail, bool over_limit = false) {
        if (!is_full()) {
            faults_.push_back({std::move(pointer), std::move(detail), over_limit});
        }
    }

    void limit(std::string pointer, std::size_t count, std::size_t count_max, const char* what) {
        if (count > count_max) {
            add(std::move(pointer),
                "has " + std::to_string(count) + what + ", more than " + std::to_string(count_max),
                true);
        }
    }

    void check_limits() {
        if (example_.polyhedra.empty()) {
            add("/polyhedra", "an example needs at least one polyhedron");
        }
        limit("/polyhedra", example_.polyhedra.size(), kPolyhedraMax, " polyhedra");
        limit("/objects", example_.objects.size(), kObjectTypesMax, " object types");
        std::size_t faces = 0;
        std::size_t corners = 0;
        std::size_t corners_of_faces = 0;
        for (std::size_t i = 0; i < example_.polyhedra.size(); ++i) {
            const Polyhedron& solid = example_.polyhedra[i];
            faces += solid.faces.size();
            corners += solid.corners.size();
            for (std::size_t f = 0; f < solid.faces.size(); ++f) {
                const std::size_t count = solid.faces[f].size();
                corners_of_faces += count;
                limit(at_face(i, f), count, kCornersOfFaceMax, " corners");
            }
        }
        limit("/polyhedra", faces, kFacesMax, " faces in all");
        limit("/polyhedra", corners, kCornersMax, " corners in all");
        limit("/polyhedra", corners_of_faces, kCornersMax, " corners of faces in all");
    }

    [[nodiscard]] bool is_object(ObjectId object) const {
        return object != kEmpty && object <= example_.objects.size();
    }

    void check_object(std::string pointer, ObjectId object) {
        if (!is_object(object)) {
            add(std::move(pointer),
                "object " + std::to_string(object) + " is not one of the " +
                    std::to_string(example_.objects.size()) + " object types, counted from 1");
        }
    }

    void check_objects() {
        for (std::size_t i = 0; i < example_.objects.size(); ++i) {
            const std::uint32_t material = example_.objects[i].material;
            if (material >= example_.materials.size()) {
                add("/objects/" + std::to_string(i) + "/material",
                    "material " + std::to_string(material) + " is not one of the " +
                        std::to_string(example_.materials.size()) + " materials, counted from 0");
            }
        }
        if (example_.ground) {
            check_object("/ground", *example_.ground);
        }
    }

    void check_bounds() {
        if (!example_.bounds) {
            return;
        }
        if (!is_place(example_.bounds->min) || !is_place(example_.bounds->max)) {
            add("/bounds", "a bound is not a number of at most 100000 m");
        } else if ((example_.bounds->min.array() >= example_.bounds->max.array()).any()) {
            add("/bounds",
                "from " + place_text(example_.bounds->min) + " to " +
                    place_text(example_.bounds->max) + " there is no space");
        }
    }

    void check_dimensions() {
        for (std::size_t i = 0; i < example_.dimensions.size(); ++i) {
            const std::string pointer = "/dimensions/" + std::to_string(i);
            check_object(pointer + "/object", example_.dimensions[i].object);
            const Point& normal = example_.dimensions[i].normal;
            if (!is_place(normal) || normal.norm() < 1e-9) {
                add(pointer + "/normal", "a normal needs a direction");
            }
        }
    }

    void check_connected() {
        for (std::size_t i = 0; i < example_.connected.size(); ++i) {
            for (std::size_t j = 0; j < example_.connected[i].size(); ++j) {
                const std::string pointer =
                    "/connected/" + std::to_string(i) + "/" + std::to_string(j);
                check_object(pointer, example_.connected[i][j]);
            }
        }
    }

    // Whether all numbers of a polyhedron mean something, so that its shape can be looked at.
    bool check_numbers(std::size_t number) {
        const Polyhedron& solid = example_.polyhedra[number];
        const std::size_t before = faults_.size();
        for (std::size_t c = 0; c < solid.corners.size(); ++c) {
            if (!is_place(solid.corners[c])) {
                add(at_polyhedron(number) + "/corners/" + std::to_string(c),
                    "the corner is at " + place_text(solid.corners[c]) +
                        ", which is not within 100000 m of the origin");
            }
        }
        if (solid.faces.size() < 4) {
            add(at_polyhedron(number),
                "has " + std::to_string(solid.faces.size()) + " faces; no solid has less than 4");
        }
        for (std::size_t f = 0; f < solid.faces.size(); ++f) {
            check_face_numbers(number, f);
        }
        const bool is_sound = faults_.size() == before && !is_full();
        check_object(at_polyhedron(number) + "/object", solid.object);
        return is_sound;
    }

    void check_face_numbers(std::size_t number, std::size_t f) {
        const Polyhedron& solid = example_.polyhedra[number];
        Face sorted = solid.faces[f];
        if (sorted.size() < 3) {
            add(at_face(number, f),
                "has " + std::to_string(sorted.size()) + " corners; no face has less than 3");
            return;
        }
        std::sort(sorted.begin(), sorted.end());
        if (sorted.back() >= solid.corners.size()) {
            add(at_face(number, f),
                "corner " + std::to_string(sorted.back()) + " is not one of the " +
                    std::to_string(solid.corners.size()) +
                    " corners of the polyhedron, counted from 0");
            return;
        }
        const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
        if (twice != sorted.end()) {
            add(at_face(number, f),
                "has corner " + std::to_string(*twice) + " at " +
                    place_text(solid.corners[*twice]) + " more than once");
        }
    }

    void check_shape(std::size_t number) {
        const Polyhedron& solid = example_.polyhedra[number];
        const std::size_t before = faults_.size();
        for (std::size_t f = 0; f < solid.faces.size(); ++f) {
            if (const auto place = find_self_crossing(solid, solid.faces[f], tolerance_)) {
                add(at_face(number, f), "its border crosses itself at " + place_text(*place));
            }
        }
        check_closed(number);
        if (faults_.size() > before) {
            return;  // what follows would say it again in other words
        }
        check_orientation(number);
        check_crossings(number);
    }

    void check_closed(std::size_t number) {
        const Polyhedron& solid = example_.polyhedra[number];
        std::vector<Edge> edges;
        for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
            const Face& face = solid.faces[f];
            for (std::size_t i = 0; i < face.size(); ++i) {
                edges.push_back({face[i], face[(i + 1) % face.size()], f});
            }
        }
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0; i < edges.size() && !is_full(); ++i) {
            const Edge& edge = edges[i];
            const std::string name = "the edge from " + place_text(solid.corners[edge.from]) +
                                     " to " + place_text(solid.corners[edge.to]);
            if (i > 0 && edges[i - 1].from == edge.from && edges[i - 1].to == edge.to) {
                add(at_face(number, edge.face),
                    name + " runs the same way in face " + std::to_string(edges[i - 1].face));
                continue;
            }
            const Edge reverse = {edge.to, edge.from, 0};
            const auto found = std::lower_bound(edges.begin(), edges.end(), reverse);
            if (found == edges.end() || found->from != edge.to || found->to != edge.from) {
                add(at_face(number, edge.face),
                    name + " is open: no other face has it the other way round" +
                        twin_text(solid, edge));
            }
        }
    }

    void check_orientation(std::size_t number) {
        const Polyhedron& solid = example_.polyhedra[number];
        double surface = 0;
        for (const Face& face : solid.faces) {
            surface += area_vector(solid, face).norm();
        }
        const double volume = volume_of(solid);
        if (std::abs(volume) <= surface * tolerance_) {
            add(at_polyhedron(number), "it encloses no space");
        } else if (volume < 0) {
            add(at_polyhedron(number),
                "its faces look inwards: corners must be counter-clockwise seen from outside");
        }
    }

    void check_crossings(std::size_t number) {
        const auto crossings = find_crossings(
            example_.polyhedra[number], tolerance_, kSolidFaultsMax - faults_.size(), work_
        );
        if (!crossings) {
            add(at_polyhedron(number),
                "too many of its faces are beside each other to see whether they cross",
                true);
            return;
        }
        for (const FaceCrossing& crossing : *crossings) {
            add(at_face(number, crossing.second),
                (crossing.is_overlap ? "lies on face " : "crosses face ") +
                    std::to_string(crossing.first) + " at " + place_text(crossing.place));
        }
    }

    const Example& example_;
    double tolerance_ = 0;
    std::size_t work_ = kCrossingWorkMax;
    std::vector<Fault> faults_;
};

}  // namespace

std::vector<Fault> find_solid_faults(const Example& example) { return SolidCheck(example).run(); }

std::string place_text(const Point& point) {
    std::string text = "(";
    for (int axis = 0; axis < 3; ++axis) {
        std::array<char, 32> digits;
        const auto end = std::to_chars(
                             digits.data(),
                             digits.data() + digits.size(),
                             point[axis] + 0.0,  // no -0
                             std::chars_format::general,
                             6
        )
                             .ptr;
        text.append(axis > 0 ? ", " : "").append(digits.data(), end);
    }
    return text + ") m";
}

}  // namespace modelsynth::continuous
