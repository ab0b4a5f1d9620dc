#include "solver/examples/solids/built_in_solids.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::examples {

namespace {

using continuous::Constraint;

// A plan of squares, north up; a letter for where what may stand.
constexpr std::array<std::string_view, 7> kPlan = {
    "...................",
    ".GGGGG.PPPPP.M...M.",
    ".G.....P...P.MM.MM.",
    ".G..GG.PPPPP.M.M.M.",
    ".G...G.P.....M...M.",
    ".GGGGG.P.....M...M.",
    "..................."};

// None of these objects but where the letters are.
Constraint only_in(std::string_view letters, std::vector<std::string> objects) {
    Voxels voxels = {
        {static_cast<std::int32_t>(kPlan[0].size()), 1, static_cast<std::int32_t>(kPlan.size())},
        {}};
    for (const std::string_view row : kPlan) {
        for (const char square : row) {
            voxels.values.push_back(letters.find(square) == std::string_view::npos ? 1 : 0);
        }
    }
    Constraint constraint = {continuous::ProbabilityRule{0}, std::move(objects), {}};
    constraint.region.voxels = std::move(voxels);
    return constraint;
}

}  // namespace

// The ways of building of the skyscrapers, each in a letter of its own (thesis, Figure 4.26).
continuous::Example make_letters() {
    continuous::Example example = make_skyscrapers();
    example.name = "letters";
    example.title = "Letters";
    example.description = "Skyscrapers in the shape of G, of P and of M: stone, ribbons, glass.";
    example.constraints = {
        only_in("G", {"stone", "cap", "pier a", "pier b"}),
        only_in("P", {"slab", "ribbon", "plant"}),
        only_in("M", {"glass", "crown"}),
        only_in("PM", {"plinth", "foot a", "foot b"})};
    example.size = {152, 12, 56};
    example.density = 1;
    return example;
}

}  // namespace modelsynth::examples
