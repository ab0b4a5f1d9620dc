#pragma once

#include "solver/continuous/planes/skeleton.h"
#include "solver/continuous/reading/figures.h"
#include "solver/core/block_search.h"
#include "solver/core/constraints/set_constraint.h"
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
//
// Most of a model is empty space, so only members are looked at: vertices at which one of the
// objects stands, and the edges along which one does, whose ends are members, too. Members outside
// are looked for from the part outwards and no further than it takes to see that all of them hang
// together.
// Requires: models whose figures fit each other.
// Cost: of a part, O(its vertices) and O(the members) at most. Thread-safety: one thread at a time.
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
        explicit State(std::size_t site_count) : members(site_count) {}

        Members members;
        std::uint32_t components = 0;
        std::vector<Site> inside;  // members of the part: vertices before the edges at them
        // As of enter():
        std::vector<Site> before;
        std::uint32_t components_before = 0;  // in the part and touching it
        std::vector<Site> around;             // members outside that touch the part, and ...
        std::vector<std::uint32_t> piece_of;  // ... which piece each is of, see gather()
        std::uint32_t piece_count = 0;
    };

    // Whether the part has the site, a vertex, or the edge, by both of its ends or all that lie in
    // the box.
    [[nodiscard]] bool is_inside(Site site) const;
    void take_out(State& state) const;
    void put(State& state, const Connection& connection, std::span<const Label> model) const;
    void gather(State& state);
    [[nodiscard]] std::vector<std::uint32_t> put_all(std::span<const Label> model);
    [[nodiscard]] std::uint32_t count(const State& state);

    const Figures& figures_;
    const Skeleton& skeleton_;
    std::span<const Connection> connections_;
    std::vector<State> states_;
    std::vector<std::uint8_t> leaves_box_;  // by vertex: whether one of its edges does
    std::vector<Site> part_;
    std::vector<std::uint8_t> is_in_part_;  // by vertex, and beyond, which never is
    std::vector<std::uint32_t> node_of_;    // by site; of none but while something is counted
};

}  // namespace modelsynth::continuous
