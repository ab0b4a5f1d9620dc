#include "solver/continuous/reading/families.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace modelsynth::continuous {

namespace {

// Corners may lie off their face's plane by this share of the example's extent.
constexpr double kFlatness = 1e-6;

std::string pointer_to(std::size_t solid, std::size_t face) {
    return "/polyhedra/" + std::to_string(solid) + "/faces/" + std::to_string(face);
}

Point canonical(const Point& normal) {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) > kNormalTolerance) {
            // Adding 0 makes a plain 0 of its negative.
            return (normal[axis] < 0 ? Point(-normal) : normal) + Point::Zero();
        }
    }
    return normal;
}

// Parts that are 0 or 1 but for noise are made so: most examples have walls and floors.
Point cleaned(Point normal) {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(normal[axis]) < kNormalTolerance) {
            normal[axis] = 0;
        }
    }
    return normal.normalized();
}

bool reaches_into(const Polyhedron& solid, const Face& face, const std::optional<Bounds>& bounds) {
    if (!bounds) {
        return true;
    }
    for (int axis = 0; axis < 3; ++axis) {
        double low = solid.corners[face.front()][axis];
        double high = low;
        for (const std::uint32_t corner : face) {
            low = std::min(low, solid.corners[corner][axis]);
            high = std::max(high, solid.corners[corner][axis]);
        }
        if (high <= bounds->min[axis] || low >= bounds->max[axis]) {
            return false;
        }
    }
    return true;
}

// 0: horizontal planes; 1: upright ones along the axes; 2: the rest.
int rank_of(const Point& normal) {
    if (std::abs(normal.y()) > 1 - kNormalTolerance) {
        return 0;
    }
    return normal.cwiseAbs().maxCoeff() > 1 - kNormalTolerance ? 1 : 2;
}

// Gathers the faces of examples into families, in the order in which they come.
class FamilyFinder {
  public:
    explicit FamilyFinder(double extent) : extent_(extent) {}

    // False when there are too many families.
    bool add(const Example& example) {
        for (std::size_t s = 0; s < example.polyhedra.size(); ++s) {
            const Polyhedron& solid = example.polyhedra[s];
            std::vector<FacePlane>& planes = found_.planes.emplace_back();
            for (std::size_t f = 0; f < solid.faces.size(); ++f) {
                planes.push_back(plane_of(solid, solid.faces[f], example.bounds, pointer_to(s, f)));
                if (found_.normals.size() > kFamiliesMax) {
                    return false;
                }
            }
        }
        if (example.ground) {
            static_cast<void>(family_of(Point::UnitY()));
        }
        return found_.normals.size() <= kFamiliesMax;
    }

    [[nodiscard]] std::vector<Fault> take_faults() { return std::move(faults_); }

    Families finish() && {
        sort();
        join_offsets();
        return std::move(found_);
    }

  private:
    FacePlane plane_of(
        const Polyhedron& solid,
        const Face& face,
        const std::optional<Bounds>& bounds,
        const std::string& pointer
    ) {
        const Point area = area_vector(solid, face);
        if (area.norm() <= extent_ * extent_ * 1e-12) {
            faults_.push_back({pointer, "a face without area"});
            return {kNoFamily, 0};
        }
        const Point normal = canonical(cleaned(area.normalized()));
        double offset = 0;
        for (const std::uint32_t corner : face) {
            offset += normal.dot(solid.corners[corner]) / static_cast<double>(face.size());
        }
        const bool is_flat = std::all_of(face.begin(), face.end(), [&](std::uint32_t corner) {
            return std::abs(normal.dot(solid.corners[corner]) - offset) <= kFlatness * extent_;
        });
        if (!is_flat) {
            faults_.push_back({pointer, "the corners of the face are not in one plane"});
        }
        if (!reaches_into(solid, face, bounds)) {
            return {kNoFamily, 0};
        }
        const std::size_t family = family_of(normal);
        found_.areas[family] += area.norm();
        return {static_cast<std::uint8_t>(family), offset};
    }

    std::size_t family_of(const Point& normal) {
        for (std::size_t family = 0; family < found_.normals.size(); ++family) {
            if ((found_.normals[family] - normal).norm() < kNormalTolerance) {
                return family;
            }
        }
        found_.normals.push_back(normal);
        found_.areas.push_back(0);
        return found_.normals.size() - 1;
    }

    void sort() {
        std::vector<std::size_t> order(found_.normals.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const auto key = [&](std::size_t family) {
                const Point& n = found_.normals[family];
                const double area = -std::round(found_.areas[family] * 1e6);
                return std::tuple(rank_of(n), area, -n.x(), -n.y(), -n.z());
            };
            return key(a) < key(b);
        });
        std::vector<std::uint8_t> number(order.size());
        std::vector<Point> normals;
        std::vector<double> areas;
        for (std::size_t i = 0; i < order.size(); ++i) {
            number[order[i]] = static_cast<std::uint8_t>(i);
            normals.push_back(found_.normals[order[i]]);
            areas.push_back(found_.areas[order[i]]);
        }
        found_.normals = std::move(normals);
        found_.areas = std::move(areas);
        for (std::vector<FacePlane>& planes : found_.planes) {
            for (FacePlane& plane : planes) {
                plane.family = plane.family == kNoFamily ? kNoFamily : number[plane.family];
            }
        }
    }

    // Offsets of one plane but for noise are made one.
    void join_offsets() {
        std::vector<std::vector<FacePlane*>> members(found_.normals.size());
        for (std::vector<FacePlane>& planes : found_.planes) {
            for (FacePlane& plane : planes) {
                if (plane.family != kNoFamily) {
                    members[plane.family].push_back(&plane);
                }
            }
        }
        for (std::vector<FacePlane*>& family : members) {
            std::sort(family.begin(), family.end(), [](const FacePlane* a, const FacePlane* b) {
                return a->offset < b->offset;
            });
            for (std::size_t i = 1; i < family.size(); ++i) {
                if (family[i]->offset - family[i - 1]->offset < kOffsetTolerance * extent_) {
                    family[i]->offset = family[i - 1]->offset;
                }
            }
        }
    }

    double extent_;
    Families found_;
    std::vector<Fault> faults_;
};

}  // namespace

Point area_vector(std::span<const Point> points, std::span<const std::uint32_t> loop) {
    Point sum = Point::Zero();
    const Point& origin = points[loop.front()];
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        sum += (points[loop[i]] - origin).cross(points[loop[i + 1]] - origin) / 2;
    }
    return sum;
}

double extent_of(const Example& example) {
    Eigen::AlignedBox3d box;
    for (const Polyhedron& solid : example.polyhedra) {
        for (const Point& corner : solid.corners) {
            box.extend(corner);
        }
    }
    return box.isEmpty() ? 1 : std::max(box.sizes().maxCoeff(), 1e-9);
}

Result<Families> find_families(std::span<const Example> examples) {
    FamilyFinder finder(extent_of(examples.front()));
    std::vector<Fault> faults;
    for (const Example& example : examples) {
        if (!finder.add(example)) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "the faces of the example have more than " + std::to_string(kFamiliesMax) +
                    " different directions"});
        }
        if (faults = finder.take_faults(); !faults.empty()) {
            return tl::unexpected(Error{
                ErrorCode::kInvalidArgument, "the example has faces that are no faces", faults});
        }
    }
    return std::move(finder).finish();
}

}  // namespace modelsynth::continuous
