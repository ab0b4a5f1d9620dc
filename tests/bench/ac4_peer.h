#pragma once

#include "solver/core/grid.h"
#include "solver/core/grid_topology.h"
#include "solver/core/label_set.h"
#include "solver/core/random.h"
#include "solver/core/relations.h"
#include "solver/core/search.h"
#include "solver/discrete/problem.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

// What our solver is measured against: model synthesis as it was published, by counting supports,
// without what our solver adds (bitsets, backtracking, other orders). It takes the same problems
// and the same random numbers. See ac4_peer.cpp for the algorithm.
namespace modelsynth::bench {

// Which labels each label allows beside it, as lists. Thread-safe.
class Ac4Rules {
  public:
    // Requires: the relations of a grid, one for each direction (checked).
    explicit Ac4Rules(const Relations& relations);

    [[nodiscard]] std::size_t label_count() const { return label_count_; }

    // The labels that may stand a step along `direction` from `label`, in rising order.
    [[nodiscard]] std::span<const Label> allowed(RelationId direction, Label label) const {
        const std::size_t list = direction * label_count_ + label;
        return {lists_.data() + firsts_.data()[list], lists_.data() + firsts_.data()[list + 1]};
    }

  private:
    std::size_t label_count_;
    std::vector<Label> lists_;
    std::vector<std::uint32_t> firsts_;  // where in lists_ each begins, and the end of the last
};

// What may still stand where. A copy of it is a way back.
struct Ac4State {
    // [site][direction][label]: how many labels still possible at the neighbour in that direction
    // allow the label here. Where there is no neighbour it says nothing.
    std::vector<std::uint16_t> supports;
    std::vector<Word> possible;             // [site]: a label set
    std::vector<std::uint16_t> left_count;  // [site]: how many labels that set has
};

// The catalog C of the thesis (3.3.2) by support counting. What it holds after propagate() is what
// Catalog (solver/core/catalog.h) holds after the same changes.
//
// Functions that return bool: false when some site lost its last label. Then the state is good for
// nothing but restore().
// Cost: 12 bytes a label and site; one count down for every label that a removed one allowed.
class Ac4Catalog {
  public:
    // Requires: topology and rules outlive the catalog.
    Ac4Catalog(const GridTopology& topology, const Ac4Rules& rules);

    // The state without any knowledge but the domains, a label set for each site, and what follows
    // from them.
    [[nodiscard]] bool start(std::span<const Word> domains);

    // Leaves only labels of `allowed` at the site; nothing follows yet.
    [[nodiscard]] bool narrow(Site site, std::span<const Word> allowed);

    // Leaves one label, which is still possible there; nothing follows yet.
    void assign(Site site, Label label);

    // Removes what lost its support, until nothing changes or some site is empty.
    [[nodiscard]] bool propagate();

    [[nodiscard]] std::size_t site_count() const { return state_.left_count.size(); }

    [[nodiscard]] std::span<const Word> labels(Site site) const {
        return {state_.possible.data() + site * words_, words_};
    }

    [[nodiscard]] const Ac4State& state() const { return state_; }

    // Requires: a state of this catalog, or of one like it, after propagate().
    void restore(const Ac4State& state);

    // As of Catalog, for pickers that follow changes; restore() ends it.
    void track_changes() { tracking_ = true; }

    [[nodiscard]] std::span<const Site> changed() const { return changed_; }

    void clear_changed() { changed_.clear(); }

  private:
    struct Removal {
        Site site;
        Label label;
    };

    bool remove(Site site, Label label);
    bool remove_unsupported();
    bool count_down(Site site, RelationId direction, std::span<const Label> labels);

    const GridTopology& topology_;
    const Ac4Rules& rules_;
    std::size_t words_;
    Ac4State state_;
    std::vector<Removal> removals_;  // a stack of those whose neighbours do not know yet
    std::vector<Site> changed_;
    bool tracking_ = false;
};

struct PeerModel {
    std::vector<Label> labels;
    std::uint32_t accepted = 0;  // blocks
    std::uint32_t reverted = 0;  // blocks that kept their labels after every attempt
    std::uint32_t attempts = 0;  // of all blocks
};

struct Ac4Options {
    Order order = Order::kScan;   // or kMinEntropy, as wave function collapse does it
    std::uint32_t attempts = 20;  // at a block, or at the whole at once
};

// Merrell's synthesis on that catalog: columns one after the other, from the bottom up, or another
// order; the labels drawn by the problem's weights; an attempt ends at the first empty cell,
// nothing is taken back. What does not depend on the seed is kept from model to model. Not
// thread-safe. Requires: the problem outlives it; no order but those two (checked).
class Ac4Peer {
  public:
    explicit Ac4Peer(const discrete::Problem& problem, const Ac4Options& options = {});
    ~Ac4Peer();

    // Algorithm 3.1. Nothing when every attempt failed.
    [[nodiscard]] std::optional<PeerModel> at_once(std::uint64_t seed);

    // Algorithm 3.4 from a consistent model.
    // Requires: a label in every cell of `initial`.
    [[nodiscard]] PeerModel in_blocks(
        std::span<const Box> schedule, std::vector<Label> initial, std::uint64_t seed
    );

  private:
    struct Workspace;

    // How many attempts it took; nothing when all failed, and `model` is as it was.
    std::optional<std::uint32_t> modify(const Box& block, std::span<Label> model, RandomKey key);
    Workspace& workspace_for(const GridPart& part);
    const Ac4State* find_or_make_base(const GridPart& part, Workspace& workspace) const;
    bool narrow_border(const GridPart& part, std::span<const Label> model, Ac4Catalog& catalog)
        const;
    bool attempt(Workspace& workspace, const RandomKey& key) const;

    const discrete::Problem& problem_;
    Ac4Options options_;
    Ac4Rules rules_;
    std::vector<std::unique_ptr<Workspace>> workspaces_;  // one for every size of a block
};

}  // namespace modelsynth::bench
