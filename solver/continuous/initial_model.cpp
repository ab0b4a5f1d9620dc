#include "solver/continuous/initial_model.h"

#include "solver/continuous/graph_part.h"
#include "solver/core/block_search.h"
#include "solver/core/label_chooser.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

namespace modelsynth::continuous {

namespace {

constexpr std::uint32_t kAttempts = 16;
constexpr std::uint32_t kInitialKey = 0xFFFFFFFF;  // RandomKey::block: no block of a schedule

// The plain label where it is possible.
class PlainChooser final : public LabelChooser {
  public:
    explicit PlainChooser(std::span<const Label> plain) : plain_(plain) {}

    void look_around(Site site, std::vector<Site>& around) const override { around = {site}; }

    [[nodiscard]] Label choose(
        std::span<const Word> possible,
        std::span<const Site> around,
        std::span<const Label> /*decided*/,
        const LabelWeights& weights,
        RandomStream& random
    ) const override {
        const Label plain = plain_[around.front()];
        const bool is_possible = (possible[plain / kWordBits] >> (plain % kWordBits) & 1) != 0;
        return is_possible ? plain : weights.draw(possible, random);
    }

  private:
    std::span<const Label> plain_;
};

// Cells of the frame that hold vertices whose plain label does not fit, and those within reach.
class RoughCells {
  public:
    explicit RoughCells(const GridSize& size) : size_(size), is_rough_(size.cell_count()) {}

    void add(std::size_t cell) { is_rough_[cell] = 1; }

    // Adds the cells beside them; false when there are none to add.
    bool grow() {
        const std::vector<std::uint8_t> before = is_rough_;
        for_each_cell(Box::whole(size_), [&](const Cell& cell) {
            if (before[size_.index(cell)] == 0) {
                return;
            }
            const Box around = {
                {std::max(0, cell.x - 1), std::max(0, cell.y - 1), std::max(0, cell.z - 1)},
                {std::min(size_.x, cell.x + 2),
                 std::min(size_.y, cell.y + 2),
                 std::min(size_.z, cell.z + 2)}};
            for_each_cell(around, [&](const Cell& other) { is_rough_[size_.index(other)] = 1; });
        });
        return is_rough_ != before;
    }

    [[nodiscard]] std::vector<Site> vertices(const Arrangement& arrangement) const {
        std::vector<Site> vertices;
        for (std::size_t cell = 0; cell < is_rough_.size(); ++cell) {
            if (is_rough_[cell] != 0) {
                for (Site v = arrangement.first_in(cell); v < arrangement.first_in(cell + 1); ++v) {
                    vertices.push_back(v);
                }
            }
        }
        return vertices;
    }

  private:
    GridSize size_;
    std::vector<std::uint8_t> is_rough_;
};

std::string place_of(const Point& point) {
    char text[96];
    std::snprintf(
        text, sizeof text, "[%.4g, %.4g, %.4g] (metres)", point.x(), point.y(), point.z()
    );
    return text;
}

}  // namespace

std::vector<Label> plain_labels(const ExampleReading& reading, const Arrangement& arrangement) {
    const Topes& topes = reading.topes();
    const Figures& figures = reading.figures();
    const Label empty = figures.find(uniform_figure(topes, kEmpty));
    std::vector<Label> labels(arrangement.vertex_count(), empty);
    if (const auto ground = reading.example().ground) {
        const std::size_t family = *reading.horizontal();
        const Label below = figures.find(uniform_figure(topes, *ground));
        const Label bare = figures.find(face_figure(topes, family, *ground, kEmpty));
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const auto site = static_cast<Site>(i);
            const double y = arrangement.position(site).y();
            // Planes of other families may meet very near to the ground's.
            const bool is_on_plane = (arrangement.families(site) >> family & 1) != 0;
            const bool is_on_ground =
                is_on_plane &&
                arrangement.planes(family)[arrangement.plane_through(site, family)] == 0;
            labels[i] = is_on_ground ? bare : y < 0 ? below : empty;
        }
    }
    return labels;
}

Result<std::vector<Label>> find_initial_labels(
    const Relations& relations,
    const Arrangement& arrangement,
    const Symmetries* symmetries,
    const SiteDomains& domains,
    const SiteWeights& weights,
    std::vector<Label> plain,
    const std::stop_token& stop
) {
    RoughCells rough(arrangement.frame().cells);
    bool is_plain = true;
    for (std::size_t cell = 0; cell < arrangement.frame().cells.cell_count(); ++cell) {
        for (Site v = arrangement.first_in(cell); v < arrangement.first_in(cell + 1); ++v) {
            const bool fits = domains.at(v).contains(plain[v]) &&
                              (symmetries == nullptr || symmetries->hold_at(v, plain));
            if (!fits) {
                rough.add(cell);
                is_plain = false;
            }
        }
    }
    if (is_plain) {
        return plain;
    }
    BlockSearch<GraphPart> search(relations, domains, weights);
    const PlainChooser chooser(plain);
    std::vector<Label> labels = plain;
    // What stands around is left alone as far as possible: cells are added twice as far each time.
    bool is_all = false;
    for (int steps = 1; !is_all; steps *= 2) {
        for (int step = 0; step < steps && !is_all; ++step) {
            is_all = !rough.grow();
        }
        BlockOptions options;
        options.attempts = kAttempts;
        options.order = Order::kMinEntropy;
        options.chooser = &chooser;
        const BlockResult result = search.modify(
            part_of(arrangement, rough.vertices(arrangement), symmetries),
            labels,
            options,
            {0, kInitialKey, 0, 0},
            stop
        );
        if (result.outcome == BlockOutcome::kStopped) {
            return tl::unexpected(cancelled());
        }
        if (result.outcome == BlockOutcome::kAccepted) {
            return labels;
        }
        if (is_all && result.outcome == BlockOutcome::kImpossible) {
            return tl::unexpected(Error{
                ErrorCode::kContradiction,
                "the constraints leave nothing that could stand at " +
                    place_of(arrangement.position(result.impossible_site)),
                {}});
        }
    }
    return tl::unexpected(Error{
        ErrorCode::kGaveUp, "nothing was found that keeps to the constraints, however plain", {}});
}

}  // namespace modelsynth::continuous
