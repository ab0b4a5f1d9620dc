#pragma once

#include "solver/continuous/planes/skeleton.h"
#include "solver/continuous/reading/figures.h"
#include "solver/core/block_search.h"
#include "solver/core/constraints/set_constraint.h"
#include "solver/core/constraints/surroundings_graph.h"
#include "solver/core/graph_topology.h"
#include "solver/core/label_set.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth::continuous {

// Objects that hang together: the figures in which one of them takes part, in how many components
// they may come, and whether the ground is one of them, which goes on beyond the model's box.
struct Connection {
    LabelSet figures;
    std::uint32_t components = 1;
    bool has_ground = false;
};

// Counts the components that connected objects come in (thesis 4.6.2) while one part of the model
// after the other is made anew, and refuses what makes them more than allowed.
// Cost: that of SurroundingsGraph a part. Thread-safety: one thread at a time.
class Connections final : public PartJudge {
  public:
    // Requires: what it refers to outlives it.
    Connections(
        const Figures& figures, const Skeleton& skeleton, std::span<const Connection> connections
    );

    // The model stands.
    void start(std::span<const Label> model);

    // The vertices of the part are about to be made anew.
    void enter(std::span<const Site> part);

    // They have new labels: whether no connection has more components than it had or may have. They
    // stand if it is so; if not, what stood before enter() does.
    [[nodiscard]] bool accepts(std::span<const Label> model) override;

    // They have labels again that they had before: these stand, in however many components. What
    // came since then may have fewer, where there were more than there may be.
    void take_back(std::span<const Label> model);

    // Of the model that stands.
    [[nodiscard]] std::uint32_t components(std::size_t connection) const {
        return states_[connection].components;
    }

    // After enter(): whether nothing of the connection stands outside of the part.
    [[nodiscard]] bool is_all_inside(std::size_t connection) const;

  private:
    struct State {
        Members members;
        std::uint32_t components = 0;
        SurroundingsGraph<Skeleton> surroundings;
        std::uint32_t components_before = 0;  // in the part and touching it
        std::vector<Membership> before;       // of inside_
    };

    void put(State& state, const Connection& connection, std::span<const Label> model);
    [[nodiscard]] std::vector<std::uint32_t> put_all(std::span<const Label> model);
    [[nodiscard]] std::uint32_t count(const State& state);
    [[nodiscard]] Membership membership(
        const Connection& connection, std::span<const Label> model, Site site
    ) const;

    const Figures& figures_;
    const Skeleton& skeleton_;
    std::span<const Connection> connections_;
    std::vector<State> states_;
    std::vector<Site> inside_;  // vertices of the part and the edges between them
    std::vector<std::uint8_t> is_inside_;
    std::vector<std::uint8_t> is_met_;
    std::vector<std::uint32_t> path_;
};

}  // namespace modelsynth::continuous
