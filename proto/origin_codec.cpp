#include "proto/origin_codec.h"

#include "proto/region_codec.h"
#include "solver/discrete/faults.h"

#include <string>

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

}  // namespace

JobOrigin read_origin(const Value& value, const RequestLimits& limits, bool names_all) {
    JobOrigin from;
    ObjectReader reader(value);
    if (const auto job = reader.required("job")) {
        from.job_id = job->string(limits.name_characters_max).value_or("");
        if (job->json().is_string() && job->json() == "") {
            job->fault("must not be empty");
        }
    }
    if (const auto alternative = reader.optional("alternative")) {
        from.alternative = static_cast<std::uint32_t>(
            alternative->integer(0, limits.alternatives_max - 1).value_or(0)
        );
    }
    if (const auto size = names_all ? reader.required("size") : reader.optional("size")) {
        from.origin.size = size_of(size->cell(1, limits.extent_max).value_or(Cell{}));
    }
    if (const auto at = reader.optional("at")) {
        from.origin.at = at->cell(0, limits.extent_max).value_or(Cell{});
    }
    from.origin.remade = read_region(reader, limits);
    reader.finish();
    return from;
}

OrderedJson write_origin(const JobOrigin& from) {
    OrderedJson written = {{"job", from.job_id}};
    if (from.alternative > 0) {
        written["alternative"] = from.alternative;
    }
    written["size"] = write_size(from.origin.size);
    written["at"] = write_cell(from.origin.at);
    write_region(from.origin.remade, written);
    return written;
}

bool lies_within(const discrete::Origin& origin, const GridSize& model) {
    const Cell at = origin.at;
    const GridSize size = origin.size;
    return at.x + size.x <= model.x && at.y + size.y <= model.y && at.z + size.z <= model.z;
}

std::vector<Fault> find_origin_faults(const JobOrigin& from, const GridSize& model) {
    std::vector<Fault> faults;
    const discrete::Origin& origin = from.origin;
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

}  // namespace modelsynth::proto
