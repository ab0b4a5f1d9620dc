#include "solver/continuous/synthesis.h"

#include "solver/continuous/constraints/growth.h"
#include "solver/continuous/graph_part.h"
#include "solver/core/block_schedule.h"
#include "solver/core/block_search.h"
#include "solver/core/parallel_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace modelsynth::continuous {

namespace {

constexpr std::size_t kBlockCountMax = 1'000'000;
constexpr std::uint32_t kWholeAttempts = 8;

// Of a smaller block in place of one that every attempt failed at. RandomKey::block of their
// searches: the block's index and so many times kBlockCountMax as which of them it is.
constexpr std::uint32_t kSmallerAttempts = 4;

double changed_from(std::span<const Label> initial, std::span<const Label> labels) {
    std::size_t changed = 0;
    for (std::size_t site = 0; site < labels.size(); ++site) {
        changed += std::size_t{labels[site] != initial[site]};
    }
    return labels.empty() ? 0 : static_cast<double>(changed) / static_cast<double>(labels.size());
}

// Blocks from the middle of the model outwards, so that what hangs together can grow everywhere.
void order_outwards(std::vector<Box>& schedule, const GridSize& cells) {
    const auto distance = [&](const Box& block) {
        const auto along = [](std::int32_t min, std::int32_t max, std::int32_t size) {
            return std::abs(min + max - size);
        };
        return std::max(
            {along(block.min.x, block.max.x, cells.x),
             along(block.min.y, block.max.y, cells.y),
             along(block.min.z, block.max.z, cells.z)}
        );
    };
    std::stable_sort(schedule.begin(), schedule.end(), [&](const Box& a, const Box& b) {
        return distance(a) < distance(b);
    });
}

// The cells that some vertices lie in.
class CellsTouched {
  public:
    explicit CellsTouched(const Arrangement& arrangement) : arrangement_(arrangement) {
        const GridSize& cells = arrangement.frame().cells;
        touched_ = {{cells.x - 1, cells.y - 1, cells.z - 1}, {1, 1, 1}};
    }

    void add(Site site) {
        const GridSize& cells = arrangement_.frame().cells;
        const Point at = arrangement_.position(site) / arrangement_.frame().cell;
        const auto along = [&](int axis, std::int32_t count) {
            return static_cast<std::int32_t>(std::clamp(std::floor(at[axis]), 0.0, count - 1.0));
        };
        const Cell cell = {along(0, cells.x), along(1, cells.y), along(2, cells.z)};
        touched_.min = {
            std::min(touched_.min.x, cell.x),
            std::min(touched_.min.y, cell.y),
            std::min(touched_.min.z, cell.z)};
        touched_.max = {
            std::max(touched_.max.x, cell.x + 1),
            std::max(touched_.max.y, cell.y + 1),
            std::max(touched_.max.z, cell.z + 1)};
    }

    [[nodiscard]] const Box& box() const { return touched_; }

  private:
    const Arrangement& arrangement_;
    Box touched_;
};

// What a block came to.
struct Solved {
    BlockResult result;
    std::vector<Site> sites;    // of its part; read when it was accepted, ...
    std::vector<Label> labels;  // ... and what stands there then
};

// One run; the state that its steps share.
class Run {
  public:
    Run(const Problem& problem, std::uint64_t seed, Observer& observer, const std::stop_token& stop)
        : problem_(problem),
          seed_(seed),
          observer_(observer),
          stop_(stop),
          search_(
              problem.relations(), problem.domains, problem.weights, &bases_, problem.by_kind.get()
          ),
          made_{problem.initial, {}} {
        if (!problem.connections.empty()) {
            growth_ = std::make_unique<Growth>(problem);
        }
    }

    Result<Synthesis> make(
        const std::optional<Blocks>& blocks, const Checkpoint* from, std::uint32_t threads
    ) {
        const GridSize& cells = problem_.arrangement.frame().cells;
        schedule_ = {Box::whole(cells)};
        if (blocks) {
            auto cut = schedule_blocks(cells, blocks->layout, kBlockCountMax);
            if (!cut) {
                return tl::unexpected(std::move(cut.error()));
            }
            schedule_ = std::move(*cut);
        }
        leave_out_what_is_made();
        total_ = static_cast<std::uint32_t>(schedule_.size());
        if (from != nullptr) {
            check(
                from->labels.size() == made_.labels.size() && from->blocks_done <= total_,
                "a checkpoint of another synthesis"
            );
            made_.labels = from->labels;
            made_.stats.blocks = from->tally;
            index_ = from->blocks_done;
        }
        observer_.on_start(total_, made_.labels);
        if (growth_) {
            growth_->start(made_.labels);
        }
        is_in_blocks_ = blocks.has_value();
        attempts_ = blocks ? blocks->attempts : kWholeAttempts;
        // What grows, or has images, may depend on blocks far away.
        const bool is_local = growth_ == nullptr && problem_.symmetries == nullptr;
        if (!(is_local && threads > 1 ? modify_in_parallel(threads) : modify_in_order())) {
            return tl::unexpected(cancelled());
        }
        return finish();
    }

  private:
    void leave_out_what_is_made() {
        if (problem_.symmetries) {
            const double cell = problem_.arrangement.frame().cell;
            std::erase_if(schedule_, [&](const Box& block) {
                return problem_.symmetries->is_filled_by_images(
                    cell * Point(block.min.x, block.min.y, block.min.z)
                );
            });
        }
        if (!problem_.is_kept.empty()) {
            std::erase_if(schedule_, [&](const Box& block) {
                return free_vertices(block).empty();
            });
        }
        if (growth_) {
            order_outwards(schedule_, problem_.arrangement.frame().cells);
        }
    }

    // False when it was stopped.
    bool modify_in_order() {
        for (; index_ < total_; ++index_) {
            if (stop_.stop_requested()) {
                return false;
            }
            const GraphPart part = part_of_box(schedule_[index_]);
            const BlockResult result = modify(part, made_.labels, index_, search_);
            if (result.outcome == BlockOutcome::kStopped) {
                return false;
            }
            report(index_, problem_.symmetries ? cells_of(part) : schedule_[index_], result);
        }
        return true;
    }

    bool modify_in_parallel(std::uint32_t threads) {
        const auto reaches = reaches_of_blocks();
        std::vector<Label> ahead = made_.labels;
        using Search = BlockSearch<GraphPart>;
        const auto solve = [&](Search& search, std::uint32_t block) -> std::optional<Solved> {
            const GraphPart part = part_of_box(schedule_[block]);
            Solved solved = {modify(part, ahead, block, search), {}, {}};
            if (solved.result.outcome == BlockOutcome::kStopped) {
                return std::nullopt;
            }
            if (solved.result.outcome == BlockOutcome::kAccepted) {
                solved.sites.assign(part.sites().begin(), part.sites().end());
                for (const Site site : solved.sites) {
                    solved.labels.push_back(ahead[site]);
                }
            }
            return solved;
        };
        using Parallel = ParallelBlocks<Solved>;
        return Parallel(problem_.arrangement.frame().cells, {}, reaches, index_)
            .run(
                threads,
                [&](std::uint32_t block) { return solve(search_, block); },
                [&]() -> Parallel::Solver {
                    auto search = std::make_shared<Search>(
                        problem_.relations(),
                        problem_.domains,
                        problem_.weights,
                        &bases_,
                        problem_.by_kind.get()
                    );
                    return [&solve, search](std::uint32_t block) { return solve(*search, block); };
                },
                [&](std::uint32_t block, const Solved& solved) {
                    for (std::size_t i = 0; i < solved.sites.size(); ++i) {
                        made_.labels[solved.sites[i]] = solved.labels[i];
                    }
                    report(block, schedule_[block], solved.result);
                }
            );
    }

    // By block, the cells of all vertices that it may change and of those that it looks at.
    [[nodiscard]] std::vector<Box> reaches_of_blocks() const {
        std::vector<Box> reaches;
        for (const Box& block : schedule_) {
            CellsTouched cells(problem_.arrangement);
            problem_.arrangement.for_each_vertex(block, [&](Site site) {
                cells.add(site);
                for (const ArrangementEdge& edge : problem_.arrangement.edges(site)) {
                    if (edge.end != kNoSite) {
                        cells.add(edge.end);
                    }
                }
            });
            reaches.push_back(cells.box());
        }
        return reaches;
    }

    [[nodiscard]] GraphPart part_of_box(const Box& box) const {
        return part_of(problem_.arrangement, free_vertices(box), problem_.symmetries.get());
    }

    BlockResult modify(
        const GraphPart& part,
        std::vector<Label>& labels,
        std::uint32_t block,
        BlockSearch<GraphPart>& search
    ) {
        BlockOptions options;
        options.attempts = attempts_;
        options.order = Order::kRandom;
        const RandomKey key = {seed_, block, 0, 0};
        if (growth_) {
            growth_->enter(part, options);
            BlockResult begun =
                growth_->begin_something(search, part, labels, options, key, total_ - block, stop_);
            const bool is_done =
                begun.outcome == BlockOutcome::kAccepted || begun.outcome == BlockOutcome::kStopped;
            if (is_done) {
                return begun;
            }
        }
        BlockResult result = search.modify(part, labels, options, key, stop_);
        if (result.outcome == BlockOutcome::kReverted && is_in_blocks_) {
            modify_corners(labels, block, search, result);
        }
        return result;
    }

    // In place of a block that every attempt failed at.
    void modify_corners(
        std::vector<Label>& labels,
        std::uint32_t block,
        BlockSearch<GraphPart>& search,
        BlockResult& result
    ) {
        BlockOptions options;
        options.attempts = std::min(attempts_, kSmallerAttempts);
        options.order = Order::kRandom;
        auto number = block;
        for (const Box& corner : corners_of(schedule_[block])) {
            number += static_cast<std::uint32_t>(kBlockCountMax);
            const GraphPart part = part_of_box(corner);
            if (part.sites().empty()) {
                continue;
            }
            if (growth_) {
                growth_->enter(part, options);
            }
            const BlockResult smaller =
                search.modify(part, labels, options, {seed_, number, 0, 0}, stop_);
            result.backtracks += smaller.backtracks;
            if (smaller.outcome == BlockOutcome::kAccepted) {
                result.outcome = BlockOutcome::kAccepted;
                result.solved_by = SolvedBy::kSmallerBlock;
            } else if (smaller.outcome == BlockOutcome::kStopped) {
                result.outcome = BlockOutcome::kStopped;
                return;
            }
        }
    }

    // Those of a block that are not to stay as they are, in rising order.
    [[nodiscard]] std::vector<Site> free_vertices(const Box& block) const {
        std::vector<Site> vertices;
        problem_.arrangement.for_each_vertex(block, [&](Site site) {
            if (problem_.is_kept.empty() || problem_.is_kept[site] == 0) {
                vertices.push_back(site);
            }
        });
        return vertices;
    }

    [[nodiscard]] Box cells_of(const GraphPart& part) const {
        CellsTouched cells(problem_.arrangement);
        for (const Site site : part.sites()) {
            cells.add(site);
        }
        return cells.box();
    }

    void report(std::uint32_t number, const Box& block, const BlockResult& result) {
        check(
            result.outcome != BlockOutcome::kImpossible,
            "a block of a consistent model was found impossible"
        );
        const bool accepted = result.outcome == BlockOutcome::kAccepted;
        SearchTally& tally = made_.stats.blocks;
        ++(accepted ? tally.solved_by[static_cast<std::size_t>(result.solved_by)] : tally.reverted);
        tally.backtracks += result.backtracks;
        observer_.on_block({number, total_, block, accepted, result.attempts, tally, made_.labels});
    }

    Result<Synthesis> finish() {
        if (!is_in_blocks_ && total_ > 0 && made_.stats.blocks.accepted() == 0) {
            return tl::unexpected(Error{
                ErrorCode::kGaveUp,
                "no model was found in " + std::to_string(kWholeAttempts) +
                    " attempts at the whole at once; blocks succeed more often",
                {}});
        }
        if (auto fault = growth_ ? growth_->find_fault() : std::nullopt) {
            return tl::unexpected(std::move(*fault));
        }
        made_.stats.changed = changed_from(problem_.initial, made_.labels);
        return std::move(made_);
    }

    const Problem& problem_;
    std::uint64_t seed_;
    Observer& observer_;
    const std::stop_token& stop_;
    BlockBases<GraphTopology> bases_;
    BlockSearch<GraphPart> search_;
    std::unique_ptr<Growth> growth_;  // null: nothing is asked to hang together
    std::vector<Box> schedule_;
    bool is_in_blocks_ = false;
    std::uint32_t attempts_ = 1;
    Synthesis made_;
    std::uint32_t index_ = 0;
    std::uint32_t total_ = 0;
};

}  // namespace

Result<Synthesis> synthesise(
    const Problem& problem,
    const Parameters& parameters,
    std::uint64_t seed,
    Observer& observer,
    const std::stop_token& stop,
    const Checkpoint* from,
    std::uint32_t threads
) {
    return Run(problem, seed, observer, stop).make(*parameters.blocks, from, threads);
}

}  // namespace modelsynth::continuous
