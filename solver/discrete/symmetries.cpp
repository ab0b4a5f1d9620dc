#include "solver/discrete/symmetries.h"

#include "solver/core/result.h"
#include "solver/discrete/region.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace modelsynth::discrete {

namespace {

bool is_box_alone(const Region& region) {
    return region.box && region.cells.empty() && !region.mask && !region.voxels;
}

// What a turn or reflection leaves in place.
Box middle_of(const Region& region, const GridSize& model) {
    return is_box_alone(region) ? *region.box : Box::whole(model);
}

const char* field_of(Symmetry::Kind kind) {
    switch (kind) {
        case Symmetry::Kind::kReflectX:
        case Symmetry::Kind::kReflectZ:
            return "/reflect";
        case Symmetry::Kind::kHalfTurn:
        case Symmetry::Kind::kQuarterTurn:
            return "/rotate";
        case Symmetry::Kind::kTranslate:
            return "/translate";
    }
    return "";
}

std::int32_t wrapped(std::int32_t at, std::int32_t extent, bool is_periodic) {
    return is_periodic ? (at % extent + extent) % extent : at;
}

std::vector<std::vector<Label>> images_of(const std::vector<Symmetries::Generator>& generators) {
    std::vector<std::vector<Label>> images;
    for (const Symmetries::Generator& generator : generators) {
        images.push_back(generator.labels);
    }
    return images;
}

}  // namespace

CellMap::CellMap(
    const Symmetry& symmetry, const Region& region, const GridSize& model, Periodic periodic
)
    : kind_(symmetry.kind),
      translation_(symmetry.translation),
      model_(model),
      periodic_(periodic),
      about_(middle_of(region, model)),
      is_involution_(order_of(symmetry.kind) == 2) {
    const RegionCoverage coverage(region, model);
    if (!coverage.is_everywhere()) {
        for_each_cell(Box::whole(model), [&](const Cell& cell) {
            applies_.push_back(coverage.contains(cell) ? 1 : 0);
        });
    }
}

std::optional<Site> CellMap::moved(Site site, bool backwards) const {
    const Cell cell = model_.cell(site);
    const std::int32_t sign = backwards ? -1 : 1;
    Cell to = cell;
    switch (kind_) {
        case Symmetry::Kind::kReflectX:
            to.x = about_.min.x + about_.max.x - 1 - cell.x;
            break;
        case Symmetry::Kind::kReflectZ:
            to.z = about_.min.z + about_.max.z - 1 - cell.z;
            break;
        case Symmetry::Kind::kHalfTurn:
            to.x = about_.min.x + about_.max.x - 1 - cell.x;
            to.z = about_.min.z + about_.max.z - 1 - cell.z;
            break;
        case Symmetry::Kind::kQuarterTurn: {
            // Seen from above against the clock: what stands in the east comes to stand in the
            // north. Backwards it is three of these.
            const Cell from_corner = {cell.x - about_.min.x, cell.y, cell.z - about_.min.z};
            const std::int32_t last = about_.max.x - about_.min.x - 1;
            to.x = about_.min.x + (backwards ? last - from_corner.z : from_corner.z);
            to.z = about_.min.z + (backwards ? from_corner.x : last - from_corner.x);
            break;
        }
        case Symmetry::Kind::kTranslate:
            to = {
                wrapped(cell.x + sign * translation_.x, model_.x, periodic_.x),
                wrapped(cell.y + sign * translation_.y, model_.y, periodic_.y),
                wrapped(cell.z + sign * translation_.z, model_.z, periodic_.z)};
            break;
    }
    if (!model_.contains(to)) {
        return std::nullopt;
    }
    const auto image = static_cast<Site>(model_.index(to));
    if (!applies_.empty() && (applies_[site] == 0 || applies_[image] == 0)) {
        return std::nullopt;
    }
    return image;
}

std::size_t order_of(Symmetry::Kind kind) {
    switch (kind) {
        case Symmetry::Kind::kReflectX:
        case Symmetry::Kind::kReflectZ:
        case Symmetry::Kind::kHalfTurn:
            return 2;
        case Symmetry::Kind::kQuarterTurn:
            return 4;
        case Symmetry::Kind::kTranslate:
            return 0;
    }
    return 0;
}

std::optional<SymmetryFault> find_symmetry_fault(
    const Symmetry& symmetry,
    const Region& region,
    const GridSize& model,
    std::size_t label_count,
    std::span<const std::pair<Label, Label>> given
) {
    const GridSize about = middle_of(region, model).size();
    if (symmetry.kind == Symmetry::Kind::kQuarterTurn && about.x != about.z) {
        return SymmetryFault{
            field_of(symmetry.kind),
            "a quarter turn needs what it turns to be as wide as deep, not " +
                std::to_string(about.x) + " by " + std::to_string(about.z) + " cells"};
    }
    if (symmetry.translation == Cell{} && symmetry.kind == Symmetry::Kind::kTranslate) {
        return SymmetryFault{field_of(symmetry.kind), "is no step away"};
    }
    if (auto fault = find_image_fault(label_count, given, order_of(symmetry.kind))) {
        return SymmetryFault{"/mirror", std::move(*fault)};
    }
    return std::nullopt;
}

Symmetries::Symmetries(
    const GridSize& size,
    Periodic periodic,
    const Relations& of_grid,
    std::vector<Generator> generators
)
    : whole_(size, periodic),
      relations_(relations_with_images(of_grid, images_of(generators))),
      generators_(std::move(generators)) {
    check(!generators_.empty(), "symmetries without any");
}

GraphPart Symmetries::close(const Box& box) const {
    std::vector<Site> sites;
    std::unordered_map<Site, Site> inside_of;
    const auto add = [&](Site site) {
        if (inside_of.try_emplace(site, Site{0}).second) {
            sites.push_back(site);
        }
    };
    for_each_cell(box, [&](const Cell& cell) {
        add(static_cast<Site>(whole_.size().index(cell)));
    });
    for (std::size_t i = 0; i < sites.size(); ++i) {
        for (const Generator& generator : generators_) {
            const Site site = sites[i];
            for (const auto& image :
                 {generator.cells.image(site), generator.cells.preimage(site)}) {
                if (image) {
                    add(*image);
                }
            }
        }
    }
    std::sort(sites.begin(), sites.end());
    for (std::size_t inside = 0; inside < sites.size(); ++inside) {
        inside_of[sites[inside]] = static_cast<Site>(inside);
    }
    std::vector<GraphArc> arcs;
    std::vector<GraphPart::OutwardArc> outward;
    for (const Site site : sites) {
        const Site inside = inside_of[site];
        whole_.for_each_arc(site, [&](Site to, RelationId relation) {
            const auto found = inside_of.find(to);
            if (found == inside_of.end()) {
                outward.push_back({inside, to, relation});
            } else if (relation % 2 == 0) {  // else it is seen from its other end
                arcs.push_back(
                    {inside, found->second, relation, static_cast<RelationId>(relation + 1)}
                );
            }
        });
        for (std::size_t g = 0; g < generators_.size(); ++g) {
            const auto image = generators_[g].cells.image(site);
            const bool is_seen = generators_[g].cells.is_involution() && image < site;
            if (image && *image != site && !is_seen) {
                const auto relation = static_cast<RelationId>(kDirectionCount + 2 * g);
                arcs.push_back(
                    {inside, inside_of[*image], relation, static_cast<RelationId>(relation + 1)}
                );
            }
        }
    }
    GraphTopology inner(sites.size(), arcs);
    return {std::move(inner), std::move(sites), std::move(outward)};
}

LabelSet Symmetries::allowed_at(Site site) const {
    LabelSet allowed = LabelSet::all(relations_.label_count());
    for (const Generator& generator : generators_) {
        if (generator.cells.image(site) == site) {
            for (std::size_t label = 0; label < generator.labels.size(); ++label) {
                if (generator.labels[label] != label) {
                    allowed.erase(static_cast<Label>(label));
                }
            }
        }
    }
    return allowed;
}

bool Symmetries::is_own_image(Label label) const {
    return std::all_of(generators_.begin(), generators_.end(), [label](const Generator& generator) {
        return generator.labels[label] == label;
    });
}

bool Symmetries::is_violated_at(std::span<const Label> model, Site site) const {
    return std::any_of(generators_.begin(), generators_.end(), [&](const Generator& generator) {
        const auto image = generator.cells.image(site);
        return image && model[site] != kNoLabel && model[*image] != kNoLabel &&
               model[*image] != generator.labels[model[site]];
    });
}

}  // namespace modelsynth::discrete
