#pragma once

#include "solver/core/topology.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace modelsynth {

// Whether a site's label is one of a set, as far as it is decided.
enum class Membership : std::uint8_t { kNo, kMaybe, kYes };

// Which sites of the whole belong to the set that a constraint speaks of.
// Cost: one byte a site; everything O(1).
class Members {
  public:
    explicit Members(std::size_t site_count) : of_site_(site_count, Membership::kNo) {
        counts_[0] = site_count;
    }

    [[nodiscard]] Membership at(Site site) const { return of_site_[site]; }

    [[nodiscard]] std::size_t count(Membership membership) const {
        return counts_[static_cast<std::size_t>(membership)];
    }

    [[nodiscard]] std::size_t site_count() const { return of_site_.size(); }

    // Whether that is news.
    bool set(Site site, Membership membership) {
        const Membership before = of_site_[site];
        of_site_[site] = membership;
        --counts_[static_cast<std::size_t>(before)];
        ++counts_[static_cast<std::size_t>(membership)];
        return before != membership;
    }

  private:
    std::vector<Membership> of_site_;
    std::array<std::size_t, 3> counts_ = {};
};

// What follows from a constraint: undecided sites that must or cannot belong to the set.
struct Conclusions {
    std::vector<Site> always;
    std::vector<Site> never;

    [[nodiscard]] bool empty() const { return always.empty() && never.empty(); }

    void clear() {
        always.clear();
        never.clear();
    }
};

// A constraint on the sites whose label is one of a set of labels: how many there are, how far
// apart, how they hang together. It complements the relations, which speak of pairs of sites.
//
// A part of the whole is searched at a time. Sites inside are kMaybe until they are decided, those
// outside are kNo or kYes. Sites are numbered as in the whole everywhere.
// Thread-safety: one thread at a time.
class SetConstraint {
  public:
    SetConstraint() = default;
    SetConstraint(const SetConstraint&) = delete;
    SetConstraint& operator=(const SetConstraint&) = delete;
    virtual ~SetConstraint() = default;

    // The sites `inside` are about to be made anew, until the next call.
    // Requires: outside them nothing is undecided.
    virtual void enter(const Members& members, std::span<const Site> inside);

    // Adds what follows. `changed` lists the sites whose membership changed since the last call,
    // some perhaps more than once or back to what it was; after enter() all that are inside.
    // Must find every violation once all is decided. What follows from a state may not depend on
    // the states before it: choices are taken back without notice.
    // False: the constraint cannot hold any more.
    [[nodiscard]] virtual bool conclude(
        const Members& members, std::span<const Site> changed, Conclusions& conclusions
    ) = 0;
};

inline void SetConstraint::enter(const Members& /*members*/, std::span<const Site> /*inside*/) {}

}  // namespace modelsynth
