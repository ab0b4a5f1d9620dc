#include "solver/continuous/import/mesh_import.h"

#include "solver/continuous/check/solid_check.h"
#include "solver/continuous/import/attachments.h"
#include "solver/continuous/import/default_spacing.h"
#include "solver/continuous/import/import_objects.h"
#include "solver/continuous/import/import_tolerances.h"
#include "solver/continuous/import/node_places.h"
#include "solver/continuous/import/object_fields.h"
#include "solver/continuous/import/triangle_solids.h"
#include "solver/continuous/import/welding.h"
#include "solver/mesh/glb_scene.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace modelsynth::continuous {

namespace {

constexpr double kGroundTolerance = 1e-4;  // of the extent

// What the extras of a scene or an asset may tell, by the names that fields have in JSON examples.
constexpr std::array<std::string_view, 10> kExampleFields = {
    "name",
    "title",
    "description",
    "spacing",
    "size",
    "density",
    "bounds",
    "dimensions",
    "connected",
    "constraints"};

// Triangles of one object in one node.
struct Soup {
    std::size_t node = 0;  // index into GlbScene::nodes
    ObjectId object = 1;
    std::vector<Triangle> triangles;     // of numbers of points of all soups
    std::vector<std::uint32_t> numbers;  // of the triangles in their node
};

struct SolidOrigin {
    std::size_t node = 0;
    std::vector<std::uint32_t> triangles;  // in the node, by face
};

class Importer {
  public:
    explicit Importer(const std::shared_ptr<const GlbScene>& scene)
        : shared_(scene),
          scene_(*scene),
          refuse_source_([this](const Source& place, const std::string& why) {
              refuse(place.in_file, place.who + why);
          }),
          attachments_(scene, refuse_source_),
          fields_(refuse_source_) {}

    Result<ImportedExample> run() {
        if (const std::size_t count = triangle_count(); count > kTrianglesMax) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "the scene has " + std::to_string(count) + " triangles, more than " +
                    std::to_string(kTrianglesMax)});
        }
        read_said();
        find_materials();
        for (std::size_t node = 0; node < scene_.nodes.size(); ++node) {
            read_node(node);
        }
        weld_points();
        for (const Soup& soup : soups_) {
            add_solids(soup);
        }
        example_.objects = objects_.types();
        example_.materials = objects_.materials();
        attachments_.give_to(made_);
        if (faults_.empty()) {
            check_solids();
        }
        if (!faults_.empty()) {
            return tl::unexpected(Error{
                ErrorCode::kInvalidArgument,
                "the scene of the GLB is no example of solids",
                std::move(faults_)});
        }
        example_.spacing = default_spacing(example_);
        add_said(fields_.fields());
        return std::move(made_);
    }

  private:
    void refuse(std::string pointer, std::string detail, bool over_limit = false) {
        if (faults_.size() < kSolidFaultsMax) {
            faults_.push_back({std::move(pointer), std::move(detail), over_limit});
        }
    }

    void refuse_node(std::size_t node, const std::string& detail, bool over_limit = false) {
        const Source place = source_of(scene_, node);
        refuse(place.in_file, place.who + detail, over_limit);
    }

    [[nodiscard]] const Mesh& mesh_of(std::size_t node) const {
        return scene_.kit.meshes[scene_.nodes[node].mesh];
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

    [[nodiscard]] SharedExtra share(const Extra& extras) const { return {shared_, &extras}; }

    void add_said(std::vector<SaidField> fields) {
        for (SaidField& field : fields) {
            made_.said.push_back(std::move(field));
        }
    }

    // Of the scene last, since what is said last counts.
    void read_said() {
        const std::string scene = "/scenes/" + std::to_string(scene_.number) + "/extras";
        add_said(said_fields(
            share(scene_.asset_extras), kExampleFields, {"", "/asset/extras", "the file"}
        ));
        add_said(said_fields(share(scene_.extras), kExampleFields, {"", scene, "the scene"}));
    }

    void find_materials() {
        for (const GlbNode& node : scene_.nodes) {
            if (node.extras.find("decorates") != nullptr || !shaped_object(node).empty()) {
                continue;
            }
            for (const Primitive& primitive : scene_.kit.meshes[node.mesh].primitives) {
                materials_.emplace(object_name(node, scene_.kit, primitive), primitive.material);
            }
        }
    }

    void read_node(std::size_t node) {
        const std::vector<Point> places = places_of(scene_, node);
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
        const GlbNode& source = scene_.nodes[node];
        if (source.extras.find("decorates") != nullptr) {
            read_decoration(node);
        } else if (!shaped_object(source).empty()) {
            attachments_.add_shape(node);
        } else if (!is_ground(node, places)) {
            add_soups(node, places);
        }
    }

    // Looks like the object that it would be a solid of, or just like what it decorates.
    void read_decoration(std::size_t node) {
        const GlbNode& source = scene_.nodes[node];
        const std::vector<Primitive>& primitives = mesh_of(node).primitives;
        const auto own = materials_.find(decorated_object(source));
        const bool looks_so = primitives.empty() ||
                              (source.extras.find("object") == nullptr && own != materials_.end() &&
                               own->second == primitives.front().material);
        attachments_.add_decoration(node, looks_so ? kEmpty : object_of(node, primitives.front()));
    }

    bool has_ground_flag(std::size_t node) {
        const Extra* extra = scene_.nodes[node].extras.find("ground");
        if (extra == nullptr) {
            return false;
        }
        if (const auto* flag = std::get_if<bool>(&extra->value)) {
            return *flag;
        }
        const auto* number = std::get_if<double>(&extra->value);  // older editors' flags
        if (number == nullptr || (*number != 0 && *number != 1)) {
            refuse_node(node, " has a property \"ground\" that is neither true nor false");
            return false;
        }
        return *number == 1;
    }

    // Whether a node is no solid but stands for the ground.
    bool is_ground(std::size_t node, const std::vector<Point>& places) {
        const bool is_said = has_ground_flag(node);
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
            return ObjectId{1};
        }
        read_object_extras(*object, node, primitive.material);
        return *object;
    }

    void read_object_extras(ObjectId object, std::size_t node, std::size_t material) {
        if (object > object_count_) {
            object_count_ = object;
            made_.sources.push_back(
                source_of(scene_, node, "/objects/" + std::to_string(object - 1))
            );
        }
        const Extra& of_node = scene_.nodes[node].extras;
        if (of_node.find("decorates") == nullptr) {
            fields_.read_node(object, share(of_node), extras_of(scene_, node));
        }
        fields_.read_material(
            object,
            share(scene_.material_extras[material]),
            {"",
             "/materials/" + std::to_string(material) + "/extras",
             "material " + quoted(scene_.kit.materials[material].name)}
        );
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
        extent_ = extent_of(box);
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
            solid.polyhedron.name = shortened(name_of(scene_, soup.node));
            solid.polyhedron.object = soup.object;
            SolidOrigin source = {soup.node, {}};
            for (const std::uint32_t triangle : solid.triangles) {
                source.triangles.push_back(soup.numbers[triangle]);
            }
            made_.sources.push_back(source_of(
                scene_, soup.node, "/polyhedra/" + std::to_string(example_.polyhedra.size())
            ));
            origins_.push_back(std::move(source));
            example_.polyhedra.push_back(std::move(solid.polyhedron));
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
            const SolidOrigin& source = origins_[number_after(pointer, kPolyhedra)];
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

    std::shared_ptr<const GlbScene> shared_;
    const GlbScene& scene_;
    ImportedExample made_;
    Example& example_ = made_.example;
    RefuseSource refuse_source_;
    Attachments attachments_;
    ObjectFields fields_;
    std::map<std::string, std::uint32_t, std::less<>> materials_;  // of objects that have solids
    ObjectId object_count_ = 0;
    ImportObjects objects_;
    std::vector<Point> points_;
    std::vector<Soup> soups_;
    std::vector<SolidOrigin> origins_;  // of the example's polyhedra
    std::vector<Fault> faults_;
    double extent_ = 1;
};

}  // namespace

Result<ImportedExample> read_example_glb(std::span<const std::byte> bytes) {
    auto scene = read_glb_scene(bytes);
    if (!scene) {
        return tl::unexpected(std::move(scene.error()));
    }
    return Importer(std::make_shared<const GlbScene>(std::move(*scene))).run();
}

}  // namespace modelsynth::continuous
