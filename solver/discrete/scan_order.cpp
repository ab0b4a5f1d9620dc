#include "solver/discrete/scan_order.h"

#include "solver/core/result.h"

namespace modelsynth::discrete {

std::vector<Site> scan_order(const GridSize& size, const ScanAxes& axes) {
    check(
        (1U << axes[0] | 1U << axes[1] | 1U << axes[2]) == 7U, "a scan that has not every axis once"
    );
    const std::array<std::int32_t, 3> extents = {size.x, size.y, size.z};
    std::vector<Site> order;
    order.reserve(size.cell_count());
    std::array<std::int32_t, 3> at = {};
    for (at[axes[0]] = 0; at[axes[0]] < extents[axes[0]]; ++at[axes[0]]) {
        for (at[axes[1]] = 0; at[axes[1]] < extents[axes[1]]; ++at[axes[1]]) {
            for (at[axes[2]] = 0; at[axes[2]] < extents[axes[2]]; ++at[axes[2]]) {
                order.push_back(static_cast<Site>(size.index({at[0], at[1], at[2]})));
            }
        }
    }
    return order;
}

}  // namespace modelsynth::discrete
