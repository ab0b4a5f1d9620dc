#include "proto/origin_codec.h"

#include "proto/continuous_codec.h"
#include "proto/region_codec.h"
#include "proto/solid_constraint_codec.h"
#include "solver/discrete/faults.h"

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace modelsynth::proto {

namespace {

GridSize size_of(const Cell& extent) { return {extent.x, extent.y, extent.z}; }

OrderedJson write_size(const GridSize& size) { return write_cell({size.x, size.y, size.z}); }

Cell moved(const Cell& cell, const Cell& by) {
    return {cell.x + by.x, cell.y + by.y, cell.z + by.z};
}

bool is_about_the_middle(const discrete::Constraint& constraint) {
    const auto* symmetry = std::get_if<discrete::Symmetry>(&constraint.rule);
    return symmetry != nullptr && symmetry->kind != discrete::Symmetry::Kind::kTranslate &&
           constraint.region == discrete::Region{};
}

void move(discrete::Constraint& constraint, const Cell& by) {
    discrete::Region& region = constraint.region;
    if (region.box) {
        region.box = Box{moved(region.box->min, by), moved(region.box->max, by)};
    }
    for (Cell& cell : region.cells) {
        cell = moved(cell, by);
    }
    if (auto* path = std::get_if<discrete::Path>(&constraint.rule)) {
        *path = {moved(path->from, by), moved(path->to, by)};
    }
}

std::optional<std::array<double, 3>> read_corner(const Value& value) {
    const auto point = read_point(value, kMetresMax);
    if (!point) {
        return std::nullopt;
    }
    if ((point->array() < 0).any()) {
        value.fault("must be 0 or more along every axis");
    }
    return std::array{point->x(), point->y(), point->z()};
}

std::vector<Fault> find_faults_in_grid(const discrete::Origin& origin, const GridSize& model) {
    std::vector<Fault> faults;
    if (origin.size == GridSize{}) {
        return faults;
    }
    const discrete::Origin in_the_corner = {origin.size, {}};
    if (!lies_within(in_the_corner, model)) {
        faults.push_back(
            {"/parameters/size",
             "the model to start from is larger: " + dump(write_size(origin.size)) + " cells"}
        );
    } else if (!lies_within(origin, model)) {
        faults.push_back({"/from/at", "the model to start from would reach beyond the new one"});
    }
    discrete::find_region_faults(origin.remade, model, "/from", faults);
    return faults;
}

std::vector<Fault> find_faults_in_solids(
    const Task& task, const continuous::Origin& origin, const continuous::Parameters* earlier
) {
    if (origin.size == continuous::Origin{}.size) {
        return {};
    }
    const auto& reading =
        *std::get<std::shared_ptr<const continuous::ExampleReading>>(task.example);
    const auto& parameters = std::get<continuous::Parameters>(task.parameters);
    std::vector<Fault> faults = continuous::find_origin_faults(reading, parameters, origin);
    if (faults.empty() && earlier != nullptr &&
        !continuous::has_planes_of(reading, parameters, origin, *earlier)) {
        faults.push_back(
            {"/from/job",
             "the planes of that job's model are others; spacing and offsets have to be its own"}
        );
    }
    return faults;
}

}  // namespace

bool lies_within(const discrete::Origin& origin, const GridSize& model) {
    const Cell at = origin.at;
    const GridSize size = origin.size;
    return at.x + size.x <= model.x && at.y + size.y <= model.y && at.z + size.z <= model.z;
}

JobOrigin OriginReader::read_job() {
    JobOrigin from;
    if (const auto job = fields_.required("job")) {
        from.job_id = job->string(limits_.name_characters_max).value_or("");
        if (job->json().is_string() && job->json() == "") {
            job->fault("must not be empty");
        }
    }
    if (const auto alternative = fields_.optional("alternative")) {
        from.alternative = static_cast<std::uint32_t>(
            alternative->integer(0, limits_.alternatives_max - 1).value_or(0)
        );
    }
    return from;
}

void OriginReader::read_places(std::string_view solver, bool names_size, JobOrigin& from) {
    const auto size = names_size ? fields_.required("size") : fields_.optional("size");
    const auto at = fields_.optional("at");
    if (solver_has_cells(solver)) {
        discrete::Origin origin;
        if (size) {
            origin.size = size_of(size->cell(1, limits_.extent_max).value_or(Cell{}));
        }
        if (at) {
            origin.at = at->cell(0, limits_.extent_max).value_or(Cell{});
        }
        origin.remade = read_region(fields_, limits_);
        from.origin = std::move(origin);
    } else {
        continuous::Origin origin;
        if (size) {
            origin.size = read_metre_size(*size).value_or(origin.size);
        }
        if (at) {
            origin.at = read_corner(*at).value_or(origin.at);
        }
        origin.remade = read_metre_region(fields_, limits_);
        from.origin = std::move(origin);
    }
    fields_.finish();
}

OrderedJson write_origin(const JobOrigin& from) {
    OrderedJson written = {{"job", from.job_id}};
    if (from.alternative > 0) {
        written["alternative"] = from.alternative;
    }
    if (const auto* grid = std::get_if<discrete::Origin>(&from.origin)) {
        written["size"] = write_size(grid->size);
        written["at"] = write_cell(grid->at);
        write_region(grid->remade, written);
    } else {
        const auto& solids = std::get<continuous::Origin>(from.origin);
        written["size"] = solids.size;
        written["at"] = solids.at;
        write_region(solids.remade, written);
    }
    return written;
}

bool take_size(const Parameters& earlier, Origin& origin) {
    const auto take = [](const auto& size, auto& told) {
        const bool is_same = told == std::decay_t<decltype(told)>{} || told == size;
        told = size;
        return is_same;
    };
    if (auto* grid = std::get_if<discrete::Origin>(&origin)) {
        return take(*std::get<discrete::Parameters>(earlier).size, grid->size);
    }
    return take(
        *std::get<continuous::Parameters>(earlier).size, std::get<continuous::Origin>(origin).size
    );
}

tl::expected<std::vector<discrete::Constraint>, std::size_t> moved_constraints(
    std::vector<discrete::Constraint> constraints, const discrete::Origin& origin
) {
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        if (constraints[i].region.mask || constraints[i].region.voxels) {
            return tl::unexpected(i);
        }
        if (is_about_the_middle(constraints[i])) {
            constraints[i].region.box = Box::whole(origin.size);
        }
        move(constraints[i], origin.at);
    }
    return constraints;
}

tl::expected<std::vector<continuous::Constraint>, std::size_t> moved_constraints(
    std::vector<continuous::Constraint> constraints, const continuous::Origin& origin
) {
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        continuous::Region& region = constraints[i].region;
        if (region.mask || region.voxels ||
            std::holds_alternative<continuous::SymmetryRule>(constraints[i].rule)) {
            return tl::unexpected(i);
        }
        for (std::size_t axis = 0; region.box && axis < 3; ++axis) {
            region.box->min[axis] += origin.at[axis];
            region.box->max[axis] += origin.at[axis];
        }
    }
    return constraints;
}

std::vector<Fault> find_origin_faults(
    const Task& task, const Origin& origin, const Parameters* earlier
) {
    if (const auto* grid = std::get_if<discrete::Origin>(&origin)) {
        return find_faults_in_grid(*grid, model_size(task.parameters));
    }
    const auto* before =
        earlier == nullptr ? nullptr : std::get_if<continuous::Parameters>(earlier);
    return find_faults_in_solids(task, std::get<continuous::Origin>(origin), before);
}

}  // namespace modelsynth::proto
