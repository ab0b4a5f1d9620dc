#include "solver/core/block_schedule.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace modelsynth {

namespace {

// Where blocks start along one axis.
std::vector<std::int32_t> starts(std::int32_t extent, std::int32_t block, double overlap) {
    std::vector<std::int32_t> result = {0};
    const auto step =
        std::max(std::int32_t{1}, static_cast<std::int32_t>(std::lround(block * (1.0 - overlap))));
    while (result.back() + block < extent) {
        result.push_back(std::min(result.back() + step, extent - block));
    }
    return result;
}

// Whether the intervals [a_min, a_max) and [b_min, b_max) overlap or touch.
bool meet(
    std::int32_t a_min,
    std::int32_t a_max,
    std::int32_t b_min,
    std::int32_t b_max,
    bool is_periodic,
    std::int32_t extent
) {
    const auto at = [&](std::int32_t shift) {
        return a_min + shift <= b_max && b_min <= a_max + shift;
    };
    return at(0) || (is_periodic && (at(extent) || at(-extent)));
}

bool meet(const Box& a, const Box& b, const GridSize& model, Periodic periodic) {
    return meet(a.min.x, a.max.x, b.min.x, b.max.x, periodic.x, model.x) &&
           meet(a.min.y, a.max.y, b.min.y, b.max.y, periodic.y, model.y) &&
           meet(a.min.z, a.max.z, b.min.z, b.max.z, periodic.z, model.z);
}

// Blocks by where they begin, so that those near a block are found without looking at all.
class BlockIndex {
  public:
    // Requires: all blocks have the size of `block`.
    BlockIndex(const GridSize& model, const GridSize& block, Periodic periodic)
        : block_(block), periodic_(periodic) {
        const auto count = [](std::int32_t extent, std::int32_t side) {
            return (extent + side - 1) / side;
        };
        counts_ = {count(model.x, block.x), count(model.y, block.y), count(model.z, block.z)};
        buckets_.resize(counts_.cell_count());
    }

    // A block of an earlier pass in the same place is forgotten: the new one waits for it, and who
    // waits for the new one need not wait for it as well.
    void add(const Box& block, std::uint32_t number) {
        auto& bucket = buckets_[counts_.index(bucket_of(block))];
        const auto same = std::find_if(bucket.begin(), bucket.end(), [&](const Entry& entry) {
            return entry.box == block;
        });
        if (same == bucket.end()) {
            bucket.push_back({block, number});
        } else {
            same->number = number;
        }
    }

    // Calls visit(box, number) once for every block that may meet this one, and for some others.
    template <class Visit>
    void for_each_near(const Box& block, Visit visit) const {
        const Cell centre = bucket_of(block);
        const auto xs = near(centre.x, counts_.x, periodic_.x);
        const auto ys = near(centre.y, counts_.y, periodic_.y);
        const auto zs = near(centre.z, counts_.z, periodic_.z);
        for (const std::int32_t y : ys) {
            for (const std::int32_t z : zs) {
                for (const std::int32_t x : xs) {
                    for (const Entry& entry : buckets_[counts_.index({x, y, z})]) {
                        visit(entry.box, entry.number);
                    }
                }
            }
        }
    }

  private:
    struct Entry {
        Box box;
        std::uint32_t number;
    };

    [[nodiscard]] Cell bucket_of(const Box& block) const {
        return {block.min.x / block_.x, block.min.y / block_.y, block.min.z / block_.z};
    }

    // Blocks that meet begin at most one block apart. The last bucket of an axis may be cut off, so
    // that across a seam the one before it is near as well.
    static std::vector<std::int32_t> near(std::int32_t at, std::int32_t count, bool is_periodic) {
        std::vector<std::int32_t> result;
        for (std::int32_t i = at - 2; i <= at + 2; ++i) {
            if (is_periodic) {
                result.push_back((i % count + count) % count);
            } else if (i >= 0 && i < count) {
                result.push_back(i);
            }
        }
        std::sort(result.begin(), result.end());
        result.erase(std::unique(result.begin(), result.end()), result.end());
        return result;
    }

    GridSize block_;
    Periodic periodic_;
    GridSize counts_;
    std::vector<std::vector<Entry>> buckets_;
};

}  // namespace

Result<std::vector<Box>> schedule_blocks(
    const GridSize& model, const BlockLayout& layout, std::size_t block_count_max
) {
    const GridSize block = {
        std::min(model.x, layout.size.x),
        std::min(model.y, layout.size.y),
        std::min(model.z, layout.size.z)};
    const auto xs = starts(model.x, block.x, layout.overlap);
    const auto ys = starts(model.y, block.y, layout.overlap);
    const auto zs = starts(model.z, block.z, layout.overlap);
    const double count = static_cast<double>(xs.size()) * static_cast<double>(ys.size()) *
                         static_cast<double>(zs.size()) * layout.passes;
    if (count > static_cast<double>(block_count_max)) {
        return tl::unexpected(Error{
            ErrorCode::kTooLarge,
            "the schedule would have more than " + std::to_string(block_count_max) + " blocks",
            {}});
    }
    std::vector<Box> blocks;
    blocks.reserve(static_cast<std::size_t>(count));
    for (std::uint32_t pass = 0; pass < layout.passes; ++pass) {
        for (const std::int32_t x : xs) {
            for (const std::int32_t z : zs) {
                for (const std::int32_t y : ys) {
                    blocks.push_back({{x, y, z}, {x + block.x, y + block.y, z + block.z}});
                }
            }
        }
    }
    return blocks;
}

BlockDependencies find_dependencies(
    const GridSize& model, Periodic periodic, std::span<const Box> blocks, std::uint32_t first
) {
    BlockDependencies result;
    result.waits_for.resize(blocks.size());
    result.first_dependent.resize(blocks.size() + 1);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // (earlier, later), by later
    if (!blocks.empty()) {
        BlockIndex index(model, blocks.front().size(), periodic);
        for (std::uint32_t later = first; later < blocks.size(); ++later) {
            const Box& block = blocks[later];
            index.for_each_near(block, [&](const Box& box, std::uint32_t earlier) {
                if (meet(box, block, model, periodic)) {
                    pairs.emplace_back(earlier, later);
                    ++result.waits_for[later];
                    ++result.first_dependent[earlier + 1];
                }
            });
            index.add(block, later);
        }
    }
    for (std::size_t block = 0; block < blocks.size(); ++block) {
        result.first_dependent[block + 1] += result.first_dependent[block];
    }
    result.dependents.resize(pairs.size());
    std::vector<std::uint32_t> next(
        result.first_dependent.begin(), result.first_dependent.end() - 1
    );
    for (const auto& [earlier, later] : pairs) {
        result.dependents[next[earlier]++] = later;
    }
    return result;
}

}  // namespace modelsynth
