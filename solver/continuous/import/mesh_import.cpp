#include "solver/continuous/import/mesh_import.h"

#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/import/default_spacing.h"
#include "solver/continuous/import/import_objects.h"
#include "solver/continuous/import/import_settings.h"
#include "solver/continuous/import/triangle_solids.h"
#include "solver/continuous/import/welding.h"
#include "solver/mesh/glb_scene.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::continuous {

namespace {

// Shares of the extent.
constexpr double kWeldTolerance = 1e-6;
constexpr double kMergeTolerance = 4e-7;  // twice this is flat enough for find_families()
constexpr double kGroundTolerance = 1e-4;

// Triangles of one object in one node.
struct Soup {
    std::size_t node = 0;  // index into GlbScene::nodes
    ObjectId object = 1;
    std::vector<Triangle> triangles;     // of numbers of points of all soups
    std::vector<std::uint32_t> numbers;  // of the triangles in their node
};

struct Source {
    std::size_t node = 0;
    std::vector<std::uint32_t> triangles;  // in the node, by face
};

class Importer {
  public:
    explicit Importer(const GlbScene& scene) : scene_(scene) {}

    Result<Example> run() {
        if (const std::size_t count = triangle_count(); count > kTrianglesMax) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "the scene has " + std::to_string(count) + " triangles, more than " +
                    std::to_string(kTrianglesMax)});
        }
        read_settings();
        for (std::size_t node = 0; node < scene_.nodes.size(); ++node) {
            read_node(node);
        }
        weld_points();
        for (const Soup& soup : soups_) {
            add_solids(soup);
        }
        example_.objects = objects_.types();
        example_.materials = objects_.materials();
        if (faults_.empty()) {
            apply_settings();
        }
        if (faults_.empty()) {
            check_solids();
        }
        if (!faults_.empty()) {
            return tl::unexpected(Error{
                ErrorCode::kInvalidArgument,
                "the scene of the GLB is no example of solids",
                std::move(faults_)});
        }
        example_.spacing = settings_.spacing ? *settings_.spacing : default_spacing(example_);
        return std::move(example_);
    }

  private:
    void refuse(std::string pointer, std::string detail, bool over_limit = false) {
        if (faults_.size() < kSolidFaultsMax) {
            faults_.push_back({std::move(pointer), std::move(detail), over_limit});
        }
    }

    void refuse_node(std::size_t node, const std::string& detail, bool over_limit = false) {
        refuse(
            "/nodes/" + std::to_string(scene_.nodes[node].number),
            "node " + quoted(name_of(node)) + detail,
            over_limit
        );
    }

    [[nodiscard]] const Mesh& mesh_of(std::size_t node) const {
        return scene_.kit.meshes[scene_.nodes[node].mesh];
    }

    [[nodiscard]] std::string_view name_of(std::size_t node) const {
        const std::string& own = scene_.nodes[node].name;
        return own.empty() ? mesh_of(node).name : own;
    }

    [[nodiscard]] std::size_t triangle_count() const {
        std::vector<std::size_t> of_mesh;
        for (const Mesh& mesh : scene_.kit.meshes) {
            std::size_t& count = of_mesh.emplace_back();
            for (const Primitive& primitive : mesh.primitives) {
                count += primitive.indices.size() / 3;
            }
        }
        std::size_t count = 0;
        for (const GlbNode& node : scene_.nodes) {
            count += of_mesh[node.mesh];
        }
        return count;
    }

    void read_settings() {
        read_import_settings(scene_.asset_extras, "/asset/extras", settings_, faults_);
        read_import_settings(
            scene_.extras,
            "/scenes/" + std::to_string(scene_.number) + "/extras",
            settings_,
            faults_
        );
    }

    // The places of the corners of a node's triangles, three by three.
    [[nodiscard]] std::vector<Point> places_of(std::size_t node) const {
        Eigen::Matrix3d turn;
        const auto& frame = scene_.nodes[node].frame;
        for (Eigen::Index column = 0; column < 3; ++column) {
            const auto& image = frame[static_cast<std::size_t>(column)];
            turn.col(column) = Point(image[0], image[1], image[2]);
        }
        const Point origin(frame[3][0], frame[3][1], frame[3][2]);
        // A mirrored mesh is inside out.
        const bool is_mirrored = turn.determinant() < 0;
        std::vector<Point> places;
        for (const Primitive& primitive : mesh_of(node).primitives) {
            for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
                const std::size_t corner = is_mirrored ? i - i % 3 + (3 - i % 3) % 3 : i;
                const Vec3& place = primitive.positions[primitive.indices[corner]];
                places.emplace_back(turn * Point(place.x, place.y, place.z) + origin);
            }
        }
        return places;
    }

    void read_node(std::size_t node) {
        const std::vector<Point> places = places_of(node);
        for (std::size_t i = 0; i < places.size(); ++i) {
            if (!(places[i].array().abs() <= kCoordinateMax).all()) {
                refuse_node(
                    node,
                    ", triangle " + std::to_string(i / 3) + ": a corner is at " +
                        place_text(places[i]) + ", not within 100000 m of the origin"
                );
                return;
            }
        }
        if (!is_ground(node, places)) {
            add_soups(node, places);
        }
    }

    // Whether a node is no solid but stands for the ground.
    bool is_ground(std::size_t node, const std::vector<Point>& places) {
        const Extra* extra = scene_.nodes[node].extras.find("ground");
        const auto* flag = extra == nullptr ? nullptr : std::get_if<bool>(&extra->value);
        const bool is_said = flag != nullptr && *flag;
        Eigen::AlignedBox3d box;
        for (const Point& place : places) {
            box.extend(place);
        }
        if (box.isEmpty()) {
            return false;
        }
        const double tolerance = kGroundTolerance * box.sizes().maxCoeff();
        const bool is_flat = box.sizes().y() <= tolerance;
        const Primitive& first = mesh_of(node).primitives.front();
        if (!is_said &&
            !(is_flat && object_name(scene_.nodes[node], scene_.kit, first) == "ground")) {
            return false;
        }
        if (!is_flat) {
            refuse_node(node, " is said to be the ground, but is not flat and horizontal");
        } else if (std::abs(box.center().y()) > tolerance) {
            refuse_node(
                node,
                " is the ground, which has to be at y = 0, and is at " + place_text(box.center())
            );
        } else {
            const ObjectId object = object_of(node, first);
            if (example_.ground && *example_.ground != object) {
                refuse_node(node, " is ground of another object than another node");
            }
            example_.ground = object;
        }
        return true;
    }

    ObjectId object_of(std::size_t node, const Primitive& primitive) {
        const auto object = objects_.number_of(
            object_name(scene_.nodes[node], scene_.kit, primitive),
            scene_.kit.materials[primitive.material]
        );
        if (!object) {
            const bool over_limit = object.error().code == ErrorCode::kTooLarge;
            refuse_node(node, ": " + object.error().message, over_limit);
        }
        return object.value_or(ObjectId{1});
    }

    void add_soups(std::size_t node, const std::vector<Point>& places) {
        const std::size_t first_soup = soups_.size();
        std::uint32_t number = 0;
        for (const Primitive& primitive : mesh_of(node).primitives) {
            const ObjectId object = object_of(node, primitive);
            auto soup = std::find_if(
                soups_.begin() + static_cast<std::ptrdiff_t>(first_soup),
                soups_.end(),
                [&](const Soup& other) { return other.object == object; }
            );
            if (soup == soups_.end()) {
                soup = soups_.insert(soups_.end(), {node, object, {}, {}});
            }
            for (std::size_t i = 0; i < primitive.indices.size(); i += 3, ++number) {
                const auto first = static_cast<std::uint32_t>(points_.size() + 3 * number);
                soup->triangles.push_back({first, first + 1, first + 2});
                soup->numbers.push_back(number);
            }
        }
        points_.insert(points_.end(), places.begin(), places.end());
    }

    // All nodes' at once, so that faces that touch lie in one plane.
    void weld_points() {
        Eigen::AlignedBox3d box;
        for (const Point& point : points_) {
            box.extend(point);
        }
        extent_ = box.isEmpty() ? 1 : std::max(box.sizes().maxCoeff(), 1e-6);
        const std::vector<std::uint32_t> welded = weld(points_, kWeldTolerance * extent_);
        for (Soup& soup : soups_) {
            std::size_t kept = 0;
            for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
                auto [a, b, c] = soup.triangles[i];
                a = welded[a];
                b = welded[b];
                c = welded[c];
                if (a != b && b != c && c != a) {
                    soup.triangles[kept] = {a, b, c};
                    soup.numbers[kept++] = soup.numbers[i];
                }
            }
            soup.triangles.resize(kept);
            soup.numbers.resize(kept);
        }
    }

    void add_solids(const Soup& soup) {
        if (soup.triangles.empty()) {
            refuse_node(soup.node, " has no triangle with an area");
            return;
        }
        TriangleSolids found =
            find_triangle_solids(points_, soup.triangles, kMergeTolerance * extent_);
        for (const HalfEdge half : found.open) {
            if (faults_.size() >= kSolidFaultsMax) {
                break;
            }
            const Triangle& triangle = soup.triangles[half / 3];
            refuse_node(
                soup.node,
                ", triangle " + std::to_string(soup.numbers[half / 3]) + ": the edge from " +
                    place_text(points_[triangle[half % 3]]) + " to " +
                    place_text(points_[triangle[(half + 1) % 3]]) +
                    " is open: no other triangle of object " +
                    quoted(objects_.types()[soup.object - 1U].name) + " has it the other way round"
            );
        }
        for (TriangleSolid& solid : found.solids) {
            solid.polyhedron.name = shortened(name_of(soup.node));
            solid.polyhedron.object = soup.object;
            Source source = {soup.node, {}};
            for (const std::uint32_t triangle : solid.triangles) {
                source.triangles.push_back(soup.numbers[triangle]);
            }
            sources_.push_back(std::move(source));
            example_.polyhedra.push_back(std::move(solid.polyhedron));
        }
    }

    void apply_settings() {
        example_.bounds = settings_.bounds;
        example_.size = settings_.size.value_or(example_.size);
        example_.density = settings_.density.value_or(example_.density);
        for (const ImportSettings::NamedDimension& dimension : settings_.dimensions) {
            const auto found = std::find_if(
                example_.objects.begin(),
                example_.objects.end(),
                [&](const ObjectType& object) { return object.name == dimension.object; }
            );
            if (found == example_.objects.end()) {
                refuse(dimension.pointer, "no node is of object " + quoted(dimension.object));
                continue;
            }
            const auto number = found - example_.objects.begin() + 1;
            example_.dimensions.push_back({static_cast<ObjectId>(number), dimension.normal});
        }
    }

    // Says of faults which node and triangle they are in.
    void check_solids() {
        for (const Fault& fault : find_solid_faults(example_)) {
            static constexpr std::string_view kPolyhedra = "/polyhedra/";
            static constexpr std::string_view kFaces = "/faces/";
            const std::string_view pointer = fault.pointer;
            if (!pointer.starts_with(kPolyhedra)) {
                refuse("", fault.detail, fault.over_limit);
                continue;
            }
            const Source& source = sources_[number_after(pointer, kPolyhedra)];
            std::string place;
            if (pointer.find(kFaces) != std::string_view::npos) {
                const std::size_t face = number_after(pointer, kFaces);
                place = ", triangle " + std::to_string(source.triangles[face]);
            }
            refuse_node(source.node, place + ": " + fault.detail, fault.over_limit);
        }
    }

    static std::size_t number_after(std::string_view pointer, std::string_view part) {
        std::size_t number = 0;
        const char* const begin = pointer.data() + pointer.find(part) + part.size();
        std::from_chars(begin, pointer.data() + pointer.size(), number);
        return number;
    }

    const GlbScene& scene_;
    ImportSettings settings_;
    Example example_;
    ImportObjects objects_;
    std::vector<Point> points_;
    std::vector<Soup> soups_;
    std::vector<Source> sources_;  // of the example's polyhedra
    std::vector<Fault> faults_;
    double extent_ = 1;
};

}  // namespace

Result<Example> read_example_glb(std::span<const std::byte> bytes) {
    const auto scene = read_glb_scene(bytes);
    if (!scene) {
        return tl::unexpected(scene.error());
    }
    return Importer(*scene).run();
}

}  // namespace modelsynth::continuous
