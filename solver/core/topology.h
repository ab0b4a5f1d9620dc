#pragma once

#include "solver/core/relations.h"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace modelsynth {

// A site takes one label. Sites of one topology are numbered 0 ... site_count()-1.
using Site = std::uint32_t;
inline constexpr Site kNoSite = ~Site{0};

// What the search runs on: sites joined by arcs, each arc of a kind (its relation).
//
// for_each_arc(site, visit) calls visit(Site far_end, RelationId) for every arc at the site. Both
// ends see the arc, with relations that are each other's reverse. The number of visits and their
// order are the same every time. A topology whose relations are few and known at compile time says
// how many as `static constexpr std::size_t kRelationCount`; others have 0 there.
template <class T>
concept Topology = requires(const T& topology, Site site, void (*visit)(Site, RelationId)) {
    { topology.site_count() } -> std::convertible_to<std::size_t>;
    { T::kRelationCount } -> std::convertible_to<std::size_t>;
    topology.for_each_arc(site, visit);
};

// A topology of an implicit grid: most arcs of a relation are the same step from site to site, and
// propagation goes faster where all are.
//
// has_steps_only(): whether they are. Then site + steps()[r] is the far end of the arc along r, and
// bit r of arc_masks()[site] says whether there is that arc. reach() is the longest step.
template <class T>
concept SteppedTopology = Topology<T> &&(T::kRelationCount > 0) && requires(const T& topology) {
    { topology.has_steps_only() } -> std::convertible_to<bool>;
    { topology.steps() } -> std::convertible_to<std::array<std::int64_t, T::kRelationCount>>;
    { topology.arc_masks() } -> std::convertible_to<const std::uint8_t*>;
    { topology.reach() } -> std::convertible_to<std::size_t>;
};

// A part of a topology that is changed while the rest stands still: its sites numbered anew from
// 0, the arcs among them, and the arcs that lead out of it.
//
// global(site) is the site's number in the whole. for_each_run(visit) calls visit(Site inside, Site
// in_the_whole, std::size_t count) for all sites in rising order, each time for some that follow
// each other both inside and in the whole. for_each_outward_arc(visit) calls visit(Site inside,
// Site outside_in_the_whole, RelationId seen_from_inside); for_each_outward_arc(group, visit) does
// so for one of kOutwardGroups groups of them, of which each arc is in one. Two inner topologies
// are equal when they have the same sites and arcs.
template <class T>
concept TopologyPart = Topology<typename T::Inner> && std::equality_comparable<typename T::Inner> &&
    requires(
        const T& part,
        Site site,
        void (*visit_run)(Site, Site, std::size_t),
        void (*visit)(Site, Site, RelationId)
    ) {
    { part.inner() } -> std::convertible_to<const typename T::Inner&>;
    { part.global(site) } -> std::convertible_to<Site>;
    part.for_each_run(visit_run);
    part.for_each_outward_arc(visit);
    { T::kOutwardGroups } -> std::convertible_to<std::size_t>;
    part.for_each_outward_arc(std::size_t{}, visit);
};

// Calls visit(Site inside, Site in_the_whole) for every site of the part, in rising order.
template <TopologyPart Part, class Visit>
void for_each_site(const Part& part, Visit visit) {
    part.for_each_run([&visit](Site inside, Site whole, std::size_t count) {
        for (const Site end = whole + static_cast<Site>(count); whole != end; ++whole) {
            visit(inside++, whole);
        }
    });
}

}  // namespace modelsynth
