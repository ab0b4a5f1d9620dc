#include "solver/continuous/synthesis.h"

#include "solver/continuous/graph_part.h"
#include "solver/core/block_schedule.h"
#include "solver/core/block_search.h"

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

// RandomKey::purpose of where a connected object begins, beside kPurposeSearch.
constexpr std::uint32_t kPurposeBeginning = 2;
constexpr std::uint32_t kBeginningsTried = 8;

Error cancelled() { return {ErrorCode::kCancelled, "the synthesis was stopped", {}}; }

double changed_from(std::span<const Label> initial, std::span<const Label> labels) {
    std::size_t changed = 0;
    for (std::size_t site = 0; site < labels.size(); ++site) {
        changed += std::size_t{labels[site] != initial[site]};
    }
    return labels.empty() ? 0 : static_cast<double>(changed) / static_cast<double>(labels.size());
}

// Nothing of what is to hang together begins by itself: it only goes on.
class GrowthChooser final : public LabelChooser {
  public:
    explicit GrowthChooser(std::span<const LabelSet> growing) : growing_(growing) {}

    void look_around(Site /*site*/, std::vector<Site>& around) const override { around.clear(); }

    [[nodiscard]] Label choose(
        std::span<const Word> possible,
        std::span<const Site> /*around*/,
        std::span<const Label> /*decided*/,
        const LabelWeights& weights,
        RandomStream& random
    ) const override {
        std::vector<Word> left(possible.begin(), possible.end());
        std::vector<Word> without(possible.size());
        for (const LabelSet& set : growing_) {
            for (std::size_t word = 0; word < left.size(); ++word) {
                without[word] = left[word] & ~set.words()[word];
            }
            if (!is_empty(without)) {
                left = without;
            }
        }
        return weights.draw(left, random);
    }

  private:
    std::span<const LabelSet> growing_;
};

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

// One run; the state that its steps share.
class Run {
  public:
    Run(const Problem& problem, std::uint64_t seed, Observer& observer, const std::stop_token& stop)
        : problem_(problem),
          seed_(seed),
          observer_(observer),
          stop_(stop),
          search_(problem.relations(), problem.domains, problem.weights, &bases_),
          made_{problem.initial, {}} {
        for (const Connection& connection : problem.connections) {
            growing_.push_back(connection.figures);
        }
        if (!growing_.empty()) {
            skeleton_ = std::make_unique<const Skeleton>(problem.arrangement);
            connections_ = std::make_unique<Connections>(
                problem.reading->figures(), *skeleton_, problem.connections
            );
            chooser_ = std::make_unique<const GrowthChooser>(growing_);
        }
    }

    Result<Synthesis> make(const std::optional<Blocks>& blocks, const Checkpoint* from) {
        const GridSize& cells = problem_.arrangement.frame().cells;
        std::vector<Box> schedule = {Box::whole(cells)};
        if (blocks) {
            auto cut = schedule_blocks(cells, blocks->layout, kBlockCountMax);
            if (!cut) {
                return tl::unexpected(std::move(cut.error()));
            }
            schedule = std::move(*cut);
        }
        if (problem_.symmetries) {
            const double cell = problem_.arrangement.frame().cell;
            std::erase_if(schedule, [&](const Box& block) {
                return problem_.symmetries->is_filled_by_images(
                    cell * Point(block.min.x, block.min.y, block.min.z)
                );
            });
        }
        if (!problem_.is_kept.empty()) {
            std::erase_if(schedule, [&](const Box& block) { return free_vertices(block).empty(); });
        }
        if (connections_) {
            order_outwards(schedule, cells);
        }
        total_ = static_cast<std::uint32_t>(schedule.size());
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
        if (connections_) {
            connections_->start(made_.labels);
        }
        const std::uint32_t attempts = blocks ? blocks->attempts : kWholeAttempts;
        for (; index_ < total_; ++index_) {
            if (stop_.stop_requested() || !modify(schedule[index_], attempts)) {
                return tl::unexpected(cancelled());
            }
        }
        return finish(blocks.has_value());
    }

  private:
    // False when it was stopped.
    bool modify(const Box& block, std::uint32_t attempts) {
        const GraphPart part =
            part_of(problem_.arrangement, free_vertices(block), problem_.symmetries.get());
        BlockOptions options;
        options.attempts = attempts;
        options.order = Order::kRandom;
        const RandomKey key = {seed_, index_, 0, 0};
        BlockResult result;
        if (connections_) {
            connections_->enter(part.sites());
            options.judge = connections_.get();
            options.growing = growing_;
            options.chooser = chooser_.get();
            result = begin_something(part, options, key);
        }
        if (result.outcome != BlockOutcome::kAccepted && result.outcome != BlockOutcome::kStopped) {
            options.pin.reset();
            result = search_.modify(part, made_.labels, options, key, stop_);
        }
        if (result.outcome == BlockOutcome::kStopped) {
            return false;
        }
        report(problem_.symmetries ? cells_touched(part) : block, result);
        return true;
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

    // The block with something in it of the first connection of which there is nothing elsewhere,
    // or less than there may be: the largest of some tries, since what happens to close early stays
    // small. kReverted where there is no such connection, or nothing of it fits.
    BlockResult begin_something(const GraphPart& part, BlockOptions options, const RandomKey& key) {
        RandomStream random({key.seed, key.block, 0, kPurposeBeginning});
        options.attempts = 1;
        for (std::size_t i = 0; i < growing_.size() && !part.sites().empty(); ++i) {
            if (!is_beginning_due(i, random)) {
                continue;
            }
            const std::vector<Label> before = labels_of(part);
            std::vector<Label> largest;
            std::size_t largest_size = 0;
            BlockResult best;
            for (std::uint32_t tried = 0; tried < kBeginningsTried; ++tried) {
                const auto count = static_cast<std::uint32_t>(part.sites().size());
                options.pin = Pin{random.below(count), &growing_[i]};
                BlockResult result = search_.modify(part, made_.labels, options, key, stop_);
                if (result.outcome == BlockOutcome::kStopped) {
                    return result;
                }
                if (result.outcome != BlockOutcome::kAccepted) {
                    continue;
                }
                const std::size_t size = members_in(part, growing_[i]);
                if (size > largest_size) {
                    largest_size = size;
                    largest = labels_of(part);
                    best = result;
                }
                put(part, before);
            }
            if (largest_size > 0) {
                put(part, largest);
                return best;
            }
        }
        return {};
    }

    [[nodiscard]] bool is_beginning_due(std::size_t connection, RandomStream& random) const {
        const std::uint32_t components = problem_.connections[connection].components;
        const std::uint32_t there = connections_->components(connection);
        if (components == 1) {
            return there == 0 || (there == 1 && connections_->is_all_inside(connection));
        }
        // Spread over the blocks to come.
        return there < components && random.below(total_ - index_) < components - there;
    }

    [[nodiscard]] Box cells_touched(const GraphPart& part) const {
        const Arrangement::Frame& frame = problem_.arrangement.frame();
        const GridSize& cells = frame.cells;
        Box touched = {{cells.x - 1, cells.y - 1, cells.z - 1}, {1, 1, 1}};
        for (const Site site : part.sites()) {
            const Point at = problem_.arrangement.position(site) / frame.cell;
            const auto along = [&](int axis, std::int32_t count) {
                return static_cast<std::int32_t>(std::clamp(std::floor(at[axis]), 0.0, count - 1.0)
                );
            };
            const Cell cell = {along(0, cells.x), along(1, cells.y), along(2, cells.z)};
            touched.min = {
                std::min(touched.min.x, cell.x),
                std::min(touched.min.y, cell.y),
                std::min(touched.min.z, cell.z)};
            touched.max = {
                std::max(touched.max.x, cell.x + 1),
                std::max(touched.max.y, cell.y + 1),
                std::max(touched.max.z, cell.z + 1)};
        }
        return touched;
    }

    [[nodiscard]] std::vector<Label> labels_of(const GraphPart& part) const {
        std::vector<Label> labels;
        for (const Site site : part.sites()) {
            labels.push_back(made_.labels[site]);
        }
        return labels;
    }

    [[nodiscard]] std::size_t members_in(const GraphPart& part, const LabelSet& figures) const {
        const auto is_member = [&](Site site) { return figures.contains(made_.labels[site]); };
        return static_cast<std::size_t>(
            std::count_if(part.sites().begin(), part.sites().end(), is_member)
        );
    }

    // Labels that stood in the part before.
    void put(const GraphPart& part, std::span<const Label> labels) {
        connections_->enter(part.sites());
        for (std::size_t i = 0; i < labels.size(); ++i) {
            made_.labels[part.sites()[i]] = labels[i];
        }
        connections_->take_back(made_.labels);
        connections_->enter(part.sites());
    }

    void report(const Box& block, const BlockResult& result) {
        check(
            result.outcome != BlockOutcome::kImpossible,
            "a block of a consistent model was found impossible"
        );
        const bool accepted = result.outcome == BlockOutcome::kAccepted;
        SearchTally& tally = made_.stats.blocks;
        ++(accepted ? tally.solved_by[static_cast<std::size_t>(result.solved_by)] : tally.reverted);
        tally.backtracks += result.backtracks;
        observer_.on_block({index_, total_, block, accepted, result.attempts, tally, made_.labels});
    }

    Result<Synthesis> finish(bool is_in_blocks) {
        if (!is_in_blocks && total_ > 0 && made_.stats.blocks.accepted() == 0) {
            return tl::unexpected(Error{
                ErrorCode::kGaveUp,
                "no model was found in " + std::to_string(kWholeAttempts) +
                    " attempts at the whole at once; blocks succeed more often",
                {}});
        }
        for (std::size_t i = 0; i < growing_.size(); ++i) {
            const std::uint32_t components = connections_->components(i);
            if (components > problem_.connections[i].components) {
                return tl::unexpected(Error{
                    ErrorCode::kGaveUp,
                    "what is to be connected was fixed apart and stayed in " +
                        std::to_string(components) + " components",
                    {}});
            }
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
    std::vector<LabelSet> growing_;  // by connection
    std::unique_ptr<const Skeleton> skeleton_;
    std::unique_ptr<Connections> connections_;  // null: nothing is asked to hang together
    std::unique_ptr<const GrowthChooser> chooser_;
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
    const Checkpoint* from
) {
    return Run(problem, seed, observer, stop).make(*parameters.blocks, from);
}

}  // namespace modelsynth::continuous
