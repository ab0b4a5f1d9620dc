#include "solver/discrete/box_search.h"

#include "solver/discrete/scan_order.h"
#include "solver/discrete/symmetries.h"

#include <algorithm>
#include <utility>

namespace modelsynth::discrete {

namespace {

Site number_in(const GraphPart& part, Site whole) {
    const auto found = std::lower_bound(part.sites().begin(), part.sites().end(), whole);
    return static_cast<Site>(found - part.sites().begin());
}

// The box's cells in the order of a scan, then their images, which these decide.
std::vector<Site> scan_images_last(
    const GridSize& model, const Box& box, std::span<const Site> scan, const GraphPart& part
) {
    const GridSize shape = box.size();
    std::vector<Site> order;
    std::vector<std::uint8_t> is_in_box(part.sites().size());
    for (const Site in_box : scan) {
        const Cell cell = shape.cell(in_box);
        const Cell whole = {cell.x + box.min.x, cell.y + box.min.y, cell.z + box.min.z};
        order.push_back(number_in(part, static_cast<Site>(model.index(whole))));
        is_in_box[order.back()] = 1;
    }
    for (std::size_t site = 0; site < is_in_box.size(); ++site) {
        if (is_in_box[site] == 0) {
            order.push_back(static_cast<Site>(site));
        }
    }
    return order;
}

}  // namespace

BoxSearch::BoxSearch(const Problem& problem, Bases* bases, const LayeredRelations* by_kind)
    : problem_(problem),
      on_grid_(problem.relations, problem.domains, problem.weights, bases, by_kind) {
    if (problem.symmetries != nullptr) {
        on_graph_.emplace(problem.symmetries->relations(), problem.domains, problem.weights);
    }
}

BlockResult BoxSearch::modify(
    const Box& box,
    std::span<Label> model,
    const BoxOptions& options,
    const RandomKey& key,
    const std::stop_token& stop
) {
    const std::span<const Site> scan = scan_of(box.size());
    BlockOptions inner = {options.attempts, options.order, scan, options.board};
    inner.chooser = options.chooser;
    inner.dead_ends = options.dead_ends;
    inner.by_sat = options.by_sat;
    inner.usual = options.usual;
    if (!on_graph_) {
        if (options.pin) {
            const Cell cell = options.pin->cell;
            const Cell in_box = {cell.x - box.min.x, cell.y - box.min.y, cell.z - box.min.z};
            inner.pin = Pin{static_cast<Site>(box.size().index(in_box)), options.pin->labels};
        }
        return on_grid_.modify(part_of(box), model, inner, key, stop);
    }
    const GraphPart part = problem_.symmetries->close(box);
    if (stop.stop_requested()) {
        return {BlockOutcome::kStopped};  // that may take long for a large box
    }
    const std::vector<Site> order = scan_images_last(problem_.size, box, scan, part);
    inner.scan = order;
    if (options.pin) {
        const auto whole = static_cast<Site>(problem_.size.index(options.pin->cell));
        inner.pin = Pin{number_in(part, whole), options.pin->labels};
    }
    return on_graph_->modify(part, model, inner, key, stop);
}

bool BoxSearch::is_determined(
    const Box& box, std::span<const Label> model, const std::stop_token& stop
) {
    if (on_graph_) {
        return on_graph_->is_determined(problem_.symmetries->close(box), model, stop);
    }
    return on_grid_.is_determined(part_of(box), model, stop);
}

void BoxSearch::note_change(const Box& box, std::span<const Label> model, ConstraintBoard& board)
    const {
    if (on_graph_) {
        board.enter(problem_.symmetries->close(box));
    } else {
        board.enter(GridPart(problem_.size, problem_.periodic, box));
    }
    board.leave(model);
}

Box BoxSearch::touched(const Box& box) const {
    if (problem_.symmetries == nullptr) {
        return box;
    }
    Box all = box;
    const GraphPart part = problem_.symmetries->close(box);
    for (const Site site : part.sites()) {
        const Cell cell = problem_.size.cell(site);
        all.min = {
            std::min(all.min.x, cell.x), std::min(all.min.y, cell.y), std::min(all.min.z, cell.z)};
        all.max = {
            std::max(all.max.x, cell.x + 1),
            std::max(all.max.y, cell.y + 1),
            std::max(all.max.z, cell.z + 1)};
    }
    return all;
}

std::size_t BoxSearch::largest_part() const {
    return std::max(on_grid_.largest_part(), on_graph_ ? on_graph_->largest_part() : 0);
}

const GridPart& BoxSearch::part_of(const Box& box) {
    if (part_) {
        part_->move_to(box);
    } else {
        part_.emplace(problem_.size, problem_.periodic, box);
    }
    return *part_;
}

std::span<const Site> BoxSearch::scan_of(const GridSize& shape) {
    if (shape != scan_shape_) {
        scan_ = scan_order(shape, problem_.scan_axes);
        scan_shape_ = shape;
    }
    return scan_;
}

}  // namespace modelsynth::discrete
