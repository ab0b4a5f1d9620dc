#include "solver/continuous/families.h"

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

}  // namespace

Point area_vector(const Polyhedron& solid, const Face& face) {
    Point sum = Point::Zero();
    const Point& origin = solid.corners[face.front()];
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        const Point a = solid.corners[face[i]] - origin;
        const Point b = solid.corners[face[i + 1]] - origin;
        sum += a.cross(b) / 2;
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

Result<Families> find_families(const Example& example) {
    const double extent = extent_of(example);
    Families found;
    const auto family_of = [&](const Point& normal) {
        for (std::size_t family = 0; family < found.normals.size(); ++family) {
            if ((found.normals[family] - normal).norm() < kNormalTolerance) {
                return family;
            }
        }
        found.normals.push_back(normal);
        found.areas.push_back(0);
        return found.normals.size() - 1;
    };
    std::vector<Fault> faults;
    for (std::size_t s = 0; s < example.polyhedra.size(); ++s) {
        const Polyhedron& solid = example.polyhedra[s];
        std::vector<FacePlane>& planes = found.planes.emplace_back();
        for (std::size_t f = 0; f < solid.faces.size(); ++f) {
            const Face& face = solid.faces[f];
            const Point area = area_vector(solid, face);
            if (area.norm() <= extent * extent * 1e-12) {
                faults.push_back({pointer_to(s, f), "a face without area"});
                planes.push_back({kNoFamily, 0});
                continue;
            }
            const Point normal = canonical(cleaned(area.normalized()));
            double offset = 0;
            for (const std::uint32_t corner : face) {
                offset += normal.dot(solid.corners[corner]) / static_cast<double>(face.size());
            }
            const bool is_flat = std::all_of(face.begin(), face.end(), [&](std::uint32_t corner) {
                return std::abs(normal.dot(solid.corners[corner]) - offset) <= kFlatness * extent;
            });
            if (!is_flat) {
                faults.push_back({pointer_to(s, f), "the corners of the face are not in one plane"}
                );
            }
            if (!reaches_into(solid, face, example.bounds)) {
                planes.push_back({kNoFamily, 0});
                continue;
            }
            const std::size_t family = family_of(normal);
            if (family >= kFamiliesMax) {
                return tl::unexpected(Error{
                    ErrorCode::kTooLarge,
                    "the faces of the example have more than " + std::to_string(kFamiliesMax) +
                        " different directions"});
            }
            found.areas[family] += area.norm();
            planes.push_back({static_cast<std::uint8_t>(family), offset});
        }
    }
    if (!faults.empty()) {
        return tl::unexpected(Error{
            ErrorCode::kInvalidArgument, "the example has faces that are no faces", faults});
    }
    if (example.ground) {
        static_cast<void>(family_of(Point::UnitY()));
        if (found.normals.size() > kFamiliesMax) {
            return tl::unexpected(Error{
                ErrorCode::kTooLarge,
                "the faces of the example have more than " + std::to_string(kFamiliesMax) +
                    " different directions"});
        }
    }

    std::vector<std::size_t> order(found.normals.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const Point& na = found.normals[a];
        const Point& nb = found.normals[b];
        const auto key = [](const Point& n, double area) {
            return std::tuple(rank_of(n), -std::round(area * 1e6), -n.x(), -n.y(), -n.z());
        };
        return key(na, found.areas[a]) < key(nb, found.areas[b]);
    });
    std::vector<std::uint8_t> number(order.size());
    Families sorted;
    for (std::size_t i = 0; i < order.size(); ++i) {
        number[order[i]] = static_cast<std::uint8_t>(i);
        sorted.normals.push_back(found.normals[order[i]]);
        sorted.areas.push_back(found.areas[order[i]]);
    }
    sorted.planes = std::move(found.planes);
    for (std::vector<FacePlane>& planes : sorted.planes) {
        for (FacePlane& plane : planes) {
            if (plane.family != kNoFamily) {
                plane.family = number[plane.family];
            }
        }
    }
    // Offsets of one plane but for noise are made one.
    for (std::size_t family = 0; family < sorted.normals.size(); ++family) {
        std::vector<FacePlane*> members;
        for (std::vector<FacePlane>& planes : sorted.planes) {
            for (FacePlane& plane : planes) {
                if (plane.family == family) {
                    members.push_back(&plane);
                }
            }
        }
        std::sort(members.begin(), members.end(), [](const FacePlane* a, const FacePlane* b) {
            return a->offset < b->offset;
        });
        for (std::size_t i = 1; i < members.size(); ++i) {
            if (members[i]->offset - members[i - 1]->offset < kOffsetTolerance * extent) {
                members[i]->offset = members[i - 1]->offset;
            }
        }
    }
    return sorted;
}

}  // namespace modelsynth::continuous
