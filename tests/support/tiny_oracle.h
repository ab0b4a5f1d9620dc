#pragma once

#include "solver/core/grid.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"
#include "tests/support/constraint_oracle.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace modelsynth::testing {

// Whether a tiny request has any model at all, by trying everything, with none of the solver's
// code. Requires: defaults filled in; regions are boxes, lists of cells or everywhere.
class TinyOracle {
  public:
    TinyOracle(const discrete::Example& example, const discrete::Parameters& parameters)
        : example_(example),
          parameters_(parameters),
          size_(*parameters.size),
          periodic_({closes(Direction::kEast), closes(Direction::kUp), closes(Direction::kSouth)}) {
        read_pairs();
        for (std::size_t i = 0; i < size_.cell_count(); ++i) {
            domains_.push_back(usable_);
            const Cell cell = size_.cell(i);
            std::erase_if(domains_.back(), [&](Label label) { return !allows(cell, label); });
        }
    }

    // The labels that may stand at the cell as far as sides and constraints on single cells go.
    [[nodiscard]] const std::set<Label>& domain(const Cell& cell) const {
        return domains_[size_.index(cell)];
    }

    // At this cell only these, whatever the request says of it, from now on.
    void set_domain(const Cell& cell, std::set<Label> labels) {
        domains_[size_.index(cell)] = std::move(labels);
    }

    // As if no side and no constraint said anything of any single cell.
    void open_all() { std::fill(domains_.begin(), domains_.end(), usable_); }

    [[nodiscard]] bool has_model() {
        std::vector<Label> model;
        return can_go_on(model);
    }

  private:
    [[nodiscard]] bool closes(Direction side) const {
        return parameters_.boundary[static_cast<std::size_t>(side)]->kind ==
               discrete::BoundaryKind::kPeriodic;
    }

    void read_pairs() {
        for_each_cell(Box::whole(example_.size), [&](const Cell& cell) {
            const auto at = [&](const Cell& place) {
                return example_.cells[example_.size.index(place)];
            };
            usable_.insert(at(cell));
            for (const auto& [axis, next] :
                 {std::pair(0, Cell{cell.x + 1, cell.y, cell.z}),
                  std::pair(1, Cell{cell.x, cell.y + 1, cell.z}),
                  std::pair(2, Cell{cell.x, cell.y, cell.z + 1})}) {
                if (example_.size.contains(next)) {
                    pairs_.insert({axis, at(cell), at(next)});
                }
            }
        });
        for (const auto& pair : example_.adjacency) {
            pairs_.insert({pair.axis, pair.lower, pair.upper});
            usable_.insert(pair.lower);
            usable_.insert(pair.upper);
        }
        if (const auto* list = std::get_if<discrete::WeightList>(&*parameters_.weights)) {
            std::erase_if(usable_, [&](Label label) {
                return std::any_of(list->begin(), list->end(), [&](const auto& entry) {
                    return entry.second == 0 && entry.first == example_.pieces[label].name;
                });
            });
        }
    }

    static bool names(const std::vector<std::string>& pieces, const std::string& name) {
        return std::find(pieces.begin(), pieces.end(), name) != pieces.end();
    }

    [[nodiscard]] static bool is_on_side(const Cell& cell, const GridSize& size, std::size_t side) {
        switch (static_cast<Direction>(side)) {
            case Direction::kEast:
                return cell.x == size.x - 1;
            case Direction::kWest:
                return cell.x == 0;
            case Direction::kUp:
                return cell.y == size.y - 1;
            case Direction::kDown:
                return cell.y == 0;
            case Direction::kSouth:
                return cell.z == size.z - 1;
            case Direction::kNorth:
                return cell.z == 0;
        }
        return false;
    }

    [[nodiscard]] bool stands_on_side_of_example(Label label, std::size_t side) const {
        bool stands = false;
        for_each_cell(Box::whole(example_.size), [&](const Cell& cell) {
            stands = stands || (is_on_side(cell, example_.size, side) &&
                                example_.cells[example_.size.index(cell)] == label);
        });
        return stands;
    }

    [[nodiscard]] bool allows(const Cell& cell, Label label) const {
        const std::string& name = example_.pieces[label].name;
        for (std::size_t side = 0; side < kDirectionCount; ++side) {
            const discrete::SideBoundary& boundary = *parameters_.boundary[side];
            if (!is_on_side(cell, size_, side)) {
                continue;
            }
            if ((boundary.kind == discrete::BoundaryKind::kPieces && !names(boundary.pieces, name)
                ) ||
                (boundary.kind == discrete::BoundaryKind::kExample &&
                 !stands_on_side_of_example(label, side))) {
                return false;
            }
        }
        return std::all_of(
            parameters_.constraints.begin(),
            parameters_.constraints.end(),
            [&](const discrete::Constraint& constraint) {
                const bool is_named = names(constraint.pieces, name);
                if (const auto* path = std::get_if<discrete::Path>(&constraint.rule)) {
                    return is_named || (!(cell == path->from) && !(cell == path->to));
                }
                const auto* probability = std::get_if<discrete::Probability>(&constraint.rule);
                const bool forbids = std::holds_alternative<discrete::Forbidden>(constraint.rule) ||
                                     (probability != nullptr && probability->weight == 0);
                const bool fixes = std::holds_alternative<discrete::Fixed>(constraint.rule);
                const auto& region = constraint.region;
                const bool applies =
                    (!region.box && region.cells.empty()) ||
                    (region.box && region.box->contains(cell)) ||
                    std::find(region.cells.begin(), region.cells.end(), cell) != region.cells.end();
                return !applies || (is_named ? !forbids : !fixes);
            }
        );
    }

    [[nodiscard]] bool fits(const std::vector<Label>& model) const {
        const Cell cell = size_.cell(model.size() - 1);
        const std::array<int, 3> at = {cell.x, cell.y, cell.z};
        const std::array<int, 3> extents = {size_.x, size_.y, size_.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Neighbours that have a label already: the one before, and across the seam.
            for (const int to : {at[axis] - 1, at[axis] + 1}) {
                const int wrapped = (to + extents[axis]) % extents[axis];
                if (to != wrapped && !periodic_[axis]) {
                    continue;
                }
                std::array<int, 3> other = at;
                other[axis] = wrapped;
                const std::size_t index = size_.index({other[0], other[1], other[2]});
                if (index >= model.size()) {
                    continue;
                }
                const Label here = model.back();
                const Label there = model[index];
                const auto pair = to < at[axis] ? std::tuple(static_cast<int>(axis), there, here)
                                                : std::tuple(static_cast<int>(axis), here, there);
                if (!pairs_.contains(pair)) {
                    return false;
                }
            }
        }
        return true;
    }

    static bool is_of_single_cells(const discrete::Rule& rule) {
        return std::holds_alternative<discrete::Fixed>(rule) ||
               std::holds_alternative<discrete::Forbidden>(rule) ||
               std::holds_alternative<discrete::Probability>(rule);
    }

    bool can_go_on(std::vector<Label>& model) {
        if (model.size() == size_.cell_count()) {
            const ConstraintOracle oracle(example_, size_, periodic_, model);
            return std::all_of(
                parameters_.constraints.begin(),
                parameters_.constraints.end(),
                [&](const discrete::Constraint& constraint) {
                    return is_of_single_cells(constraint.rule) ||
                           !oracle.find_violation(constraint);
                }
            );
        }
        for (const Label label : domains_[model.size()]) {
            model.push_back(label);
            const bool found = fits(model) && can_go_on(model);
            model.pop_back();
            if (found) {
                return true;
            }
        }
        return false;
    }

    const discrete::Example& example_;
    const discrete::Parameters& parameters_;
    GridSize size_;
    std::array<bool, 3> periodic_;
    std::set<Label> usable_;
    std::set<std::tuple<int, Label, Label>> pairs_;  // axis, lower, upper
    std::vector<std::set<Label>> domains_;           // by cell
};

}  // namespace modelsynth::testing
