#pragma once

#include "solver/continuous/decoration/placed_decorations.h"

#include <array>
#include <cstddef>
#include <vector>

namespace modelsynth::continuous {

// An edge of an object, or a part of one, that a profile is swept along.
struct DecoratedEdge {
    std::array<std::size_t, 2> polygons = {};  // those of the two chosen faces
    std::array<Point, 2> normals;              // theirs, outwards
    // Where it begins and ends: the first normal is turned into the second one counter-clockwise,
    // seen from beyond the end.
    std::array<Point, 2> ends;
    std::array<std::size_t, 2> corners = {};  // the object's that it reaches there; or kNoSide
};

// The sweeps of one decoration of one object: which of them end in one cross-section.
class MitredSweeps {
  public:
    MitredSweeps(ObjectId object, const EdgeDecoration& decoration)
        : object_(object), decoration_(decoration) {}

    void add(const DecoratedEdge& edge);

    [[nodiscard]] std::size_t size() const { return swept_.size(); }

    // Joins what can be, once all edges are there.
    void append_to(std::vector<Sweep>& sweeps);

  private:
    // An end of an edge: twice its number, and 1 more for the last end.
    using End = std::size_t;
    static constexpr End kNoEnd = ~End{0};

    struct Swept {
        DecoratedEdge edge;
        std::array<SweepEnd, 2> ends;
        std::array<End, 2> partners = {kNoEnd, kNoEnd};
    };

    [[nodiscard]] SweepEnd capped_end(const DecoratedEdge& edge, std::size_t end) const;
    [[nodiscard]] bool is_within_reach(const SweepEnd& end) const;
    [[nodiscard]] bool crosses_itself(const Swept& swept) const;
    void join_at_corners();
    void join(End a, End b);
    void part_those_that_cross();

    ObjectId object_;
    const EdgeDecoration& decoration_;
    std::vector<Swept> swept_;
};

}  // namespace modelsynth::continuous
