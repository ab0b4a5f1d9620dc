#include "solver/discrete/scan_order.h"

namespace modelsynth::discrete {

std::vector<Site> column_order(const GridSize& size) {
    std::vector<Site> order;
    order.reserve(size.cell_count());
    for (std::int32_t x = 0; x < size.x; ++x) {
        for (std::int32_t z = 0; z < size.z; ++z) {
            for (std::int32_t y = 0; y < size.y; ++y) {
                order.push_back(static_cast<Site>(size.index({x, y, z})));
            }
        }
    }
    return order;
}

}  // namespace modelsynth::discrete
