#include "solver/continuous/origin.h"

#include "solver/continuous/constraints/coverage.h"
#include "solver/continuous/planes/arrangement.h"
#include "solver/continuous/planes/model_planes.h"
#include "solver/continuous/planes/vertex_finder.h"
#include "solver/continuous/problem.h"
#include "solver/continuous/reading/reading.h"
#include "solver/continuous/symmetry/plane_images.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace modelsynth::continuous {

namespace {

constexpr double kSamePlace = 1e-6;  // of the model's extent

Point place_of(const Origin& origin) { return {origin.at[0], origin.at[1], origin.at[2]}; }

// A model of the origin's size with the planes that the new one has in its place.
Parameters parameters_of(const Parameters& parameters, const Origin& origin) {
    if (origin.size == parameters.size) {
        return parameters;
    }
    Parameters older = parameters;
    older.size = origin.size;
    older.boundary = {};
    older.constraints.emplace();
    for (FamilyOffsets& family : older.offsets) {
        const Point normal = Point(family.normal[0], family.normal[1], family.normal[2]);
        const double moved = normal.normalized().dot(place_of(origin));
        for (double& offset : family.offsets) {
            offset -= moved;
        }
    }
    return older;
}

double tolerance_of(const Parameters& parameters) {
    return kSamePlace * *std::max_element(parameters.size->begin(), parameters.size->end());
}

bool has_region(const Region& region) { return region != Region{}; }

}  // namespace

std::vector<Fault> find_origin_faults(
    const ExampleReading& reading, const Parameters& parameters, const Origin& origin
) {
    const double tolerance = tolerance_of(parameters);
    std::vector<Fault> faults;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = (*parameters.size)[axis];
        if (origin.size[axis] > length + tolerance) {
            faults.push_back({"/parameters/size", "the model to start from is larger"});
            return faults;
        }
        if (origin.at[axis] + origin.size[axis] > length + tolerance) {
            faults.push_back({"/from/at", "the model to start from would reach beyond the new one"}
            );
            return faults;
        }
    }
    if (reading.example().ground && origin.at[1] != 0) {
        faults.push_back({"/from/at", "must have y = 0: the ground stays where it is"});
        return faults;
    }
    const ModelPlanes planes = make_planes(reading, parameters);
    const ModelPlanes older = make_planes(reading, parameters_of(parameters, origin));
    for (std::size_t family = 0; family < planes.offsets.size(); ++family) {
        const double moved = reading.topes().normals()[family].dot(place_of(origin));
        for (const double offset : older.offsets[family]) {
            if (!has_plane_at(planes.offsets[family], offset + moved, tolerance)) {
                faults.push_back(
                    {"/from/at",
                     "the older model's planes would lie between those of the new one; whole "
                     "spacings help"}
                );
                return faults;
            }
        }
    }
    return faults;
}

bool has_planes_of(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Origin& origin,
    const Parameters& earlier
) {
    const double tolerance = tolerance_of(parameters);
    const Parameters expected = parameters_of(parameters, origin);
    if (expected.boundary != earlier.boundary) {
        return false;
    }
    const ModelPlanes now = make_planes(reading, expected);
    const ModelPlanes then = make_planes(reading, earlier);
    for (std::size_t family = 0; family < now.offsets.size(); ++family) {
        const PlaneOffsets& offsets = now.offsets[family];
        const bool are_same = offsets.size() == then.offsets[family].size() &&
                              std::equal(
                                  offsets.begin(),
                                  offsets.end(),
                                  then.offsets[family].begin(),
                                  [&](double a, double b) { return std::abs(a - b) <= tolerance; }
                              );
        if (!are_same) {
            return false;
        }
    }
    return true;
}

Result<Start> place_origin(
    const ExampleReading& reading,
    const Parameters& parameters,
    const Arrangement& arrangement,
    const Origin& origin,
    const std::stop_token& stop
) {
    const Parameters older = parameters_of(parameters, origin);
    const GridSize cells = cells_of(older);
    auto before = Arrangement::make(
        reading.topes(),
        make_planes(reading, older).offsets,
        {arranged_box(reading, older), cells, *older.spacing},
        kVerticesMax,
        stop
    );
    if (!before) {
        return tl::unexpected(std::move(before.error()));
    }
    const Error damaged = {
        ErrorCode::kInternal, "the labels are not those of the model to start from", {}};
    if (origin.labels.size() != before->vertex_count()) {
        return tl::unexpected(damaged);
    }
    const bool covers_all = older.size == parameters.size;
    const bool keeps_all = !has_region(origin.remade) && !covers_all;
    const Coverage remade(origin.remade, *parameters.size);
    const VertexFinder vertices(arrangement);
    Start start = {
        std::vector<Label>(arrangement.vertex_count(), kNoLabel),
        std::vector<std::uint8_t>(arrangement.vertex_count())};
    for (std::size_t v = 0; v < before->vertex_count(); ++v) {
        Point place = before->position(static_cast<Site>(v)) + place_of(origin);
        const Site vertex = vertices.at(place);
        if (vertex == kNoSite || origin.labels[v] >= reading.figures().count()) {
            return tl::unexpected(damaged);
        }
        start.labels[vertex] = origin.labels[v];
        place.y() = std::max(place.y(), 0.0);  // what is sunk into the ground belongs to its top
        start.is_kept[vertex] = keeps_all || remade.at(place) < 0.5 ? 1 : 0;
    }
    return start;
}

}  // namespace modelsynth::continuous
