#pragma once

#include "solver/core/grid.h"
#include "solver/core/label_set.h"
#include "solver/discrete/example.h"
#include "solver/discrete/parameters.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace modelsynth::testing {

// Re-verifies a constraint on a complete model from the request alone, the slow and plain way, with
// none of the solver's code.
class ConstraintOracle {
  public:
    ConstraintOracle(
        const discrete::Example& example,
        const GridSize& size,
        const std::array<bool, 3>& periodic,
        std::span<const Label> labels
    )
        : example_(example), size_(size), periodic_(periodic), labels_(labels) {}

    // What is wrong, or nothing.
    [[nodiscard]] std::optional<std::string> find_violation(const discrete::Constraint& constraint
    ) const {
        std::vector<Cell> members;
        for_each([&](const Cell& cell) {
            if (value_at(constraint.region, cell) >= 0.5 && is_named(constraint, cell)) {
                members.push_back(cell);
            }
        });
        return std::visit(
            [&](const auto& rule) { return check(rule, constraint, members); }, constraint.rule
        );
    }

  private:
    using Fault = std::optional<std::string>;
    using Members = std::vector<Cell>;

    template <class Visit>
    void for_each(Visit visit) const {
        for (int y = 0; y < size_.y; ++y) {
            for (int z = 0; z < size_.z; ++z) {
                for (int x = 0; x < size_.x; ++x) {
                    visit(Cell{x, y, z});
                }
            }
        }
    }

    [[nodiscard]] bool is_named(const discrete::Constraint& constraint, const Cell& cell) const {
        const auto at = static_cast<std::size_t>(cell.x + size_.x * (cell.z + size_.z * cell.y));
        const std::string& name = example_.pieces[labels_[at]].name;
        return std::find(constraint.pieces.begin(), constraint.pieces.end(), name) !=
               constraint.pieces.end();
    }

    [[nodiscard]] double value_at(const discrete::Region& region, const Cell& cell) const {
        if (!region.box && region.cells.empty() && !region.mask && !region.voxels) {
            return 1;
        }
        double most = 0;
        if (region.box && cell.x >= region.box->min.x && cell.x < region.box->max.x &&
            cell.y >= region.box->min.y && cell.y < region.box->max.y &&
            cell.z >= region.box->min.z && cell.z < region.box->max.z) {
            most = 1;
        }
        if (std::find(region.cells.begin(), region.cells.end(), cell) != region.cells.end()) {
            most = 1;
        }
        const auto to = [](int at, int extent, int other) {
            return static_cast<int>((at + 0.5) / extent * other);
        };
        if (region.mask) {
            const int x = to(cell.x, size_.x, region.mask->width);
            const int z = to(cell.z, size_.z, region.mask->depth);
            const auto at = static_cast<std::size_t>(x + region.mask->width * z);
            most = std::max(most, region.mask->values[at] / 255.0);
        }
        if (region.voxels) {
            const GridSize& grid = region.voxels->size;
            const int x = to(cell.x, size_.x, grid.x);
            const int y = to(cell.y, size_.y, grid.y);
            const int z = to(cell.z, size_.z, grid.z);
            const auto at = static_cast<std::size_t>(x + grid.x * (z + grid.z * y));
            most = std::max(most, region.voxels->values[at]);
        }
        return most;
    }

    // How far apart along one axis.
    static int apart(int a, int b, int extent, bool periodic) {
        const int direct = std::abs(a - b);
        return periodic ? std::min(direct, extent - direct) : direct;
    }

    // How often two cells share a face; twice across a periodic axis of two.
    [[nodiscard]] int faces_between(const Cell& a, const Cell& b) const {
        const std::array<std::array<int, 3>, 2> at = {{{a.x, a.y, a.z}, {b.x, b.y, b.z}}};
        const std::array<int, 3> extents = {size_.x, size_.y, size_.z};
        int faces = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bool aligned = true;
            for (std::size_t other = 0; other < 3; ++other) {
                aligned = aligned && (other == axis || at[0][other] == at[1][other]);
            }
            if (!aligned) {
                continue;
            }
            for (const int step : {1, -1}) {
                int to = at[0][axis] + step;
                to = periodic_[axis] ? (to + extents[axis]) % extents[axis] : to;
                faces += to == at[1][axis] && !(a == b) ? 1 : 0;
            }
        }
        return faces;
    }

    // The pieces that members fall into, by member; and the faces among members, each once.
    struct Pieces {
        std::vector<std::size_t> of;
        std::size_t count = 0;
        std::size_t faces = 0;
    };

    [[nodiscard]] Pieces find_pieces(const Members& members) const {
        Pieces pieces;
        pieces.of.assign(members.size(), members.size());
        for (std::size_t i = 0; i < members.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                pieces.faces += static_cast<std::size_t>(faces_between(members[i], members[j]));
            }
            if (pieces.of[i] < members.size()) {
                continue;
            }
            std::vector<std::size_t> open = {i};
            pieces.of[i] = pieces.count;
            while (!open.empty()) {
                const std::size_t at = open.back();
                open.pop_back();
                for (std::size_t j = 0; j < members.size(); ++j) {
                    if (pieces.of[j] == members.size() &&
                        faces_between(members[at], members[j]) > 0) {
                        pieces.of[j] = pieces.count;
                        open.push_back(j);
                    }
                }
            }
            ++pieces.count;
        }
        return pieces;
    }

    static std::string text(const Cell& cell) {
        return "[" + std::to_string(cell.x) + ", " + std::to_string(cell.y) + ", " +
               std::to_string(cell.z) + "]";
    }

    Fault check(
        const discrete::Fixed& /*rule*/,
        const discrete::Constraint& constraint,
        const Members& /*members*/
    ) const {
        Fault fault;
        for_each([&](const Cell& cell) {
            if (value_at(constraint.region, cell) >= 0.5 && !is_named(constraint, cell)) {
                fault = "another piece at " + text(cell);
            }
        });
        return fault;
    }

    Fault check(
        const discrete::Forbidden& /*rule*/,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        return members.empty() ? Fault() : "a forbidden piece at " + text(members.front());
    }

    Fault check(
        const discrete::Probability& rule,
        const discrete::Constraint& constraint,
        const Members& /*members*/
    ) const {
        Fault fault;
        for_each([&](const Cell& cell) {
            if (rule.weight == 0 && value_at(constraint.region, cell) >= 1 &&
                is_named(constraint, cell)) {
                fault = "a removed piece at " + text(cell);
            }
        });
        return fault;
    }

    Fault check(
        const discrete::Count& rule,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        if (members.size() < rule.min || (rule.max && members.size() > *rule.max)) {
            return std::to_string(members.size()) + " of the counted pieces";
        }
        return {};
    }

    Fault check(
        const discrete::Separation& rule,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        for (std::size_t i = 0; i < members.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const Cell& a = members[i];
                const Cell& b = members[j];
                const int steps = apart(a.x, b.x, size_.x, periodic_[0]) +
                                  apart(a.y, b.y, size_.y, periodic_[1]) +
                                  apart(a.z, b.z, size_.z, periodic_[2]);
                if (steps < rule.distance) {
                    return text(a) + " and " + text(b) + " are too near";
                }
            }
        }
        return {};
    }

    Fault check(
        const discrete::MaxRun& rule,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        const auto is_member = [&](const Cell& cell) {
            return std::find(members.begin(), members.end(), cell) != members.end();
        };
        for (std::uint8_t axis = 0; axis < 3; ++axis) {
            if (rule.axis && *rule.axis != axis) {
                continue;
            }
            for (const Cell& start : members) {
                Cell cell = start;
                int length = 0;
                // A walk of max + 1 cells, or once round a ring.
                const int extent = axis == 0 ? size_.x : axis == 1 ? size_.y : size_.z;
                while (length <= rule.max && length < extent && size_.contains(cell) &&
                       is_member(cell)) {
                    ++length;
                    int& at = axis == 0 ? cell.x : axis == 1 ? cell.y : cell.z;
                    ++at;
                    at = periodic_[axis] ? at % extent : at;
                }
                if (length > rule.max) {
                    return "a run too long from " + text(start);
                }
            }
        }
        return {};
    }

    Fault check(
        const discrete::Connected& /*rule*/,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        const std::size_t count = find_pieces(members).count;
        return count <= 1 ? Fault() : std::to_string(count) + " pieces that do not touch";
    }

    Fault check(
        const discrete::Acyclic& /*rule*/,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        const Pieces pieces = find_pieces(members);
        return pieces.faces + pieces.count == members.size() ? Fault() : "there is a ring";
    }

    Fault check(
        const discrete::Path& rule,
        const discrete::Constraint& /*constraint*/,
        const Members& members
    ) const {
        const Pieces pieces = find_pieces(members);
        const auto piece_at = [&](const Cell& cell) -> std::optional<std::size_t> {
            const auto found = std::find(members.begin(), members.end(), cell);
            return found == members.end()
                       ? std::nullopt
                       : std::optional(pieces.of[static_cast<std::size_t>(found - members.begin())]
                         );
        };
        const auto from = piece_at(rule.from);
        return from && from == piece_at(rule.to) ? Fault() : "there is no path";
    }

    // Where the cell comes to lie; nothing beyond the model.
    [[nodiscard]] std::optional<Cell> moved(
        const discrete::Symmetry& rule, const discrete::Region& region, const Cell& cell
    ) const {
        using Kind = discrete::Symmetry::Kind;
        const bool in_box = region.box && region.cells.empty() && !region.mask && !region.voxels;
        const Box about = in_box ? *region.box : Box{{0, 0, 0}, {size_.x, size_.y, size_.z}};
        // Twice the way from the middle.
        const int dx = 2 * cell.x + 1 - about.min.x - about.max.x;
        const int dz = 2 * cell.z + 1 - about.min.z - about.max.z;
        const auto at = [&](int to_x, int to_z) {
            return Cell{
                (to_x - 1 + about.min.x + about.max.x) / 2,
                cell.y,
                (to_z - 1 + about.min.z + about.max.z) / 2};
        };
        Cell to = cell;
        switch (rule.kind) {
            case Kind::kReflectX:
                to = at(-dx, dz);
                break;
            case Kind::kReflectZ:
                to = at(dx, -dz);
                break;
            case Kind::kHalfTurn:
                to = at(-dx, -dz);
                break;
            case Kind::kQuarterTurn:
                to = at(dz, -dx);
                break;
            case Kind::kTranslate: {
                const auto along = [](int from, int step, int extent, bool periodic) {
                    const int there = from + step;
                    return periodic ? (there % extent + extent) % extent : there;
                };
                to = {
                    along(cell.x, rule.translation.x, size_.x, periodic_[0]),
                    along(cell.y, rule.translation.y, size_.y, periodic_[1]),
                    along(cell.z, rule.translation.z, size_.z, periodic_[2])};
                break;
            }
        }
        return size_.contains(to) ? std::optional(to) : std::nullopt;
    }

    // Requires: a mirror of pairs, each named once, or one that names all that
    // are not their own; none left to be found.
    Fault check(
        const discrete::Symmetry& rule,
        const discrete::Constraint& constraint,
        const Members& /*members*/
    ) const {
        const auto& region = constraint.region;
        const GridSize about = region.box ? region.box->size() : size_;
        if (rule.kind == discrete::Symmetry::Kind::kQuarterTurn && about.x != about.z) {
            return "nothing square to turn";
        }
        const auto name_at = [&](const Cell& cell) {
            return example_
                .pieces[labels_[static_cast<
                    std::size_t>(cell.x + size_.x * (cell.z + size_.z * cell.y))]]
                .name;
        };
        const auto mirror = rule.mirror.value_or(discrete::NamePairs());
        const auto image_of = [&](const std::string& name) {
            for (const auto& [a, b] : mirror) {
                if (name == a) {
                    return b;
                }
            }
            for (const auto& [a, b] : mirror) {
                if (name == b) {
                    return a;
                }
            }
            return name;
        };
        Fault fault;
        for_each([&](const Cell& cell) {
            const auto to = moved(rule, region, cell);
            if (to && value_at(region, cell) >= 0.5 && value_at(region, *to) >= 0.5 &&
                name_at(*to) != image_of(name_at(cell))) {
                fault = "a cell is not its image's image";
            }
        });
        return fault;
    }

    // What these ask for is no yes or no.
    template <class Wish>
    Fault check(
        const Wish& /*rule*/, const discrete::Constraint& /*constraint*/, const Members& /*members*/
    ) const {
        static_assert(std::is_same_v<Wish, discrete::Resemblance> || std::is_same_v<Wish, discrete::Objective> || std::is_same_v<Wish, discrete::BestOf>);
        return {};
    }

    const discrete::Example& example_;
    const GridSize& size_;
    std::array<bool, 3> periodic_;
    std::span<const Label> labels_;
};

}  // namespace modelsynth::testing
