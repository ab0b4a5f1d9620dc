#pragma once

#include "server/store/types.h"

#include <cstddef>
#include <limits>
#include <string>

namespace modelsynth::server {

// On whose behalf something is asked for. Without keys everybody is nobody, and sees all.
struct Caller {
    std::string owner = {};  // what the caller submits is of this name
    bool sees_all = true;    // as administrators do
    std::size_t unfinished_max = std::numeric_limits<std::size_t>::max();  // jobs

    // Whose things the caller may know of.
    [[nodiscard]] OwnerFilter filter() const {
        return sees_all ? OwnerFilter() : OwnerFilter(owner);
    }
};

}  // namespace modelsynth::server
