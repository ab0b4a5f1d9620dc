#include "solver/discrete/region.h"

#include <algorithm>

namespace modelsynth::discrete {

namespace {

// The cell of a coarser or finer row that the middle of a cell falls into.
std::int32_t stretch(std::int32_t at, std::int32_t extent, std::int32_t other_extent) {
    const std::int64_t twice = 2 * static_cast<std::int64_t>(at) + 1;
    return static_cast<std::int32_t>(
        twice * other_extent / (2 * static_cast<std::int64_t>(extent))
    );
}

}  // namespace

RegionCoverage::RegionCoverage(const Region& region, const GridSize& model)
    : region_(region),
      model_(model),
      is_everywhere_(!region.box && region.cells.empty() && !region.mask && !region.voxels) {
    if (!region.cells.empty()) {
        listed_.resize(model.cell_count());
        for (const Cell& cell : region.cells) {
            listed_[model.index(cell)] = 1;
        }
    }
}

double RegionCoverage::at(const Cell& cell) const {
    if (is_everywhere_ || (region_.box && region_.box->contains(cell)) ||
        (!listed_.empty() && listed_[model_.index(cell)] != 0)) {
        return 1;
    }
    double most = 0;
    if (const auto& mask = region_.mask) {
        const auto x = static_cast<std::size_t>(stretch(cell.x, model_.x, mask->width));
        const auto z = static_cast<std::size_t>(stretch(cell.z, model_.z, mask->depth));
        most = mask->values[x + static_cast<std::size_t>(mask->width) * z] / 255.0;
    }
    if (const auto& voxels = region_.voxels) {
        const Cell at = {
            stretch(cell.x, model_.x, voxels->size.x),
            stretch(cell.y, model_.y, voxels->size.y),
            stretch(cell.z, model_.z, voxels->size.z)};
        most = std::max(most, voxels->values[voxels->size.index(at)]);
    }
    return most;
}

}  // namespace modelsynth::discrete
