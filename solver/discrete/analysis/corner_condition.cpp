#include "solver/discrete/analysis/corner_condition.h"

#include "solver/core/label_set.h"

#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

namespace modelsynth::discrete {

namespace {

// A relation of the axis: onwards to the next cell, or back to the one before.
RelationId onwards(std::size_t axis) { return static_cast<RelationId>(2 * axis); }

RelationId back(std::size_t axis) { return static_cast<RelationId>(2 * axis + 1); }

class Corners {
  public:
    Corners(const Transitions& transitions, Work& work, OpenCube* open_cube)
        : relations_(transitions.relations),
          labels_(transitions.labels),
          work_(work),
          open_cube_(open_cube) {
        for_each_label(labels_.words(), [this](Label label) { listed_.push_back(label); });
        for (std::size_t axis = 0; axis < transitions.open.size(); ++axis) {
            if (transitions.open[axis]) {
                axes_.push_back(axis);
            }
        }
    }

    ProofOutcome check() {
        ProofOutcome outcome = check_rows();
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            for (std::size_t j = i + 1; j < axes_.size(); ++j) {
                if (outcome == ProofOutcome::kProved) {
                    outcome = check_squares(axes_[i], axes_[j]);
                }
            }
        }
        if (outcome == ProofOutcome::kProved && axes_.size() == 3) {
            outcome = check_cubes();
        }
        return outcome;
    }

  private:
    using Row = std::span<const Word>;

    [[nodiscard]] Row row(RelationId relation, Label label) const {
        return relations_.row(relation, label);
    }

    // Whether some label that may be used is in all of the rows.
    [[nodiscard]] bool meet(std::initializer_list<Row> rows) const {
        for (std::size_t word = 0; word < labels_.words().size(); ++word) {
            Word common = labels_.words()[word];
            for (const Row& each : rows) {
                common &= each[word];
            }
            if (common != 0) {
                return true;
            }
        }
        return false;
    }

    ProofOutcome check_rows() {
        for (const std::size_t axis : axes_) {
            for (const Label label : listed_) {
                if (!work_.take()) {
                    return ProofOutcome::kNoWork;
                }
                if (!meet({row(onwards(axis), label)})) {
                    return ProofOutcome::kNotProved;
                }
            }
        }
        return ProofOutcome::kProved;
    }

    // b and c that have an a, but no d.
    ProofOutcome check_squares(std::size_t x, std::size_t y) {
        for (const Label b : listed_) {
            for (const Label c : listed_) {
                if (!work_.take()) {
                    return ProofOutcome::kNoWork;
                }
                if (!meet({row(onwards(y), b), row(onwards(x), c)}) &&
                    meet({row(back(x), b), row(back(y), c)})) {
                    return ProofOutcome::kNotProved;
                }
            }
        }
        return ProofOutcome::kProved;
    }

    // The labels that may be at the far end of `second` from a label that has `end` at the far end
    // of `first`: those that may stand with it in a cube.
    [[nodiscard]] std::vector<Label> partners(Label end, RelationId first, RelationId second)
        const {
        LabelSet set(relations_.label_count());
        for_each_label(row(relations_.reverse(first), end), [&](Label common) {
            if (labels_.contains(common)) {
                for_each_label(row(second, common), [&](Label partner) { set.insert(partner); });
            }
        });
        set &= labels_;
        std::vector<Label> list;
        for_each_label(set.words(), [&](Label label) { list.push_back(label); });
        return list;
    }

    // The three neighbours of a cube's last corner, that leave it no label though they may stand
    // together; each named by the two axes along which it is the farther.
    ProofOutcome check_cubes() {
        for (const Label xy : listed_) {
            const std::vector<Label> with_y = partners(xy, onwards(0), onwards(2));
            for (const Label xz : partners(xy, onwards(1), onwards(2))) {
                for (const Label yz : with_y) {
                    if (!work_.take()) {
                        return ProofOutcome::kNoWork;
                    }
                    if (meet({row(onwards(2), xy), row(onwards(1), xz), row(onwards(0), yz)})) {
                        continue;
                    }
                    if (const auto outcome = check_cube(xy, xz, yz);
                        outcome != ProofOutcome::kProved) {
                        return outcome;
                    }
                }
            }
        }
        return ProofOutcome::kProved;
    }

    // Proved when the three do not occur in a cube whose other corners are allowed.
    ProofOutcome check_cube(Label xy, Label xz, Label yz) {
        for (const Label x : listed_) {
            if (!relations_.allows(onwards(1), x, xy) || !relations_.allows(onwards(2), x, xz)) {
                continue;
            }
            for (const Label y : listed_) {
                if (!relations_.allows(onwards(0), y, xy) ||
                    !relations_.allows(onwards(2), y, yz)) {
                    continue;
                }
                if (!work_.take()) {
                    return ProofOutcome::kNoWork;
                }
                for (const Label z : listed_) {
                    if (relations_.allows(onwards(0), z, xz) &&
                        relations_.allows(onwards(1), z, yz) &&
                        meet({row(back(0), x), row(back(1), y), row(back(2), z)})) {
                        tell({0, x, y, z, xy, xz, yz});
                        return ProofOutcome::kNotProved;
                    }
                }
            }
        }
        return ProofOutcome::kProved;
    }

    void tell(OpenCube cube) const {
        if (open_cube_ == nullptr) {
            return;
        }
        for (const Label origin : listed_) {
            if (relations_.allows(onwards(0), origin, cube.x) &&
                relations_.allows(onwards(1), origin, cube.y) &&
                relations_.allows(onwards(2), origin, cube.z)) {
                cube.origin = origin;
                break;
            }
        }
        *open_cube_ = cube;
    }

    const Relations& relations_;
    const LabelSet& labels_;
    Work& work_;
    OpenCube* open_cube_;
    std::vector<Label> listed_;
    std::vector<std::size_t> axes_;
};

}  // namespace

ProofOutcome check_corners(const Transitions& transitions, Work& work, OpenCube* open_cube) {
    return Corners(transitions, work, open_cube).check();
}

}  // namespace modelsynth::discrete
