#include "solver/core/box_index.h"

#include "solver/core/result.h"

#include <algorithm>

namespace modelsynth {

namespace {

constexpr std::int32_t kPlacesMax = 64;

std::int32_t place_along(std::int32_t at, std::int32_t count, std::int32_t extent) {
    return static_cast<std::int32_t>(std::int64_t{at} * count / extent);
}

}  // namespace

BoxIndex::BoxIndex(const GridSize& model, std::span<const Box> boxes) : model_(model) {
    GridSize longest = {1, 1, 1};
    for (const Box& box : boxes) {
        const GridSize size = box.size();
        longest = {
            std::max(longest.x, size.x), std::max(longest.y, size.y), std::max(longest.z, size.z)};
    }
    // Boxes that touch start no further from each other than the first of them is long.
    const auto count = [](std::int32_t extent, std::int32_t length) {
        return std::clamp(extent / (length + 1), 1, kPlacesMax);
    };
    counts_ = {count(model.x, longest.x), count(model.y, longest.y), count(model.z, longest.z)};
    places_.resize(counts_.cell_count());
}

void BoxIndex::add(std::uint32_t number, const Box& box) {
    places_[counts_.index(place_of(box))].push_back(number);
}

void BoxIndex::remove(std::uint32_t number, const Box& box) {
    auto& place = places_[counts_.index(place_of(box))];
    const auto found = std::find(place.begin(), place.end(), number);
    check(found != place.end(), "a box that is not in the index was removed");
    place.erase(found);
}

Cell BoxIndex::place_of(const Box& box) const {
    return {
        place_along(box.min.x, counts_.x, model_.x),
        place_along(box.min.y, counts_.y, model_.y),
        place_along(box.min.z, counts_.z, model_.z)};
}

}  // namespace modelsynth
