#include "solver/examples/castle_floors.h"

#include "solver/examples/castle_plan.h"

namespace modelsynth::examples::castle {

namespace {

constexpr std::size_t kFloorCount = 9;

// Paths that leave in the east leave in the south as well, as many cells from the corner: that is
// where the turns of the plan meet.
std::vector<std::string_view> plan() {
    // clang-format off
    return {
        "......p..,......,...t....p...t.y..",
        "..,t..p....y.t........y..o........",
        "......o........t.ff....##G###.,.t.",
        ".5###4G4###6.....ff....#____#.....",
        ".#_________#.....ff....#____#....,",
        ".#_BBBB____#....,ff.###2____####..",
        ".#_BdBB____#........#__________#.y",
        ".#_________1####3...#__AAAA____#..",
        ".#______________#...#__AAaA_w__#..",
        ".#__AAAAA___KK__#...#_____b____#..",
        ".2__AAaAA___KK__#...#__________#.,",
        ".#__AA____b_____5.,.####____####..",
        ".#__Aa__________#......#____#.....",
        ".#__AA__________#..,...#____#...t.",
        ".1=======n======1.,....##1###.....",
        ".#______________#.............,,.y",
        ".#__BBBBBB_LL___Gopp..............",
        ".#__BBBdBB_LL___#..p..t...........",
        ".4__BB_______w__#..p..y..5####6...",
        ".#__BB__________#..p.,...#____Gopp",
        ".#______sss_____#..p...,.#_MM_#...",
        ".3####1####4####6..p..y..#_MM_#...",
        ",.................,p.....#s___#...",
        "...t.,y...,.t......p.....3##2#4...",
        ",.CC....o.....C.ty.p.t.y.......CC.",
        ".....C..p.CCC.C....p..............",
        "..ff.C..p.....C..,.p...........ff.",
        "..ff....p...,......p....5##4#6.ff.",
        "..ffC...pppppppppppopppoG____#....",
        "....C..............p....#_LL_#....",
        "y.........CC.ffff,.p....#_LL_#..t.",
        "...CCC,,.....ffff..p,...#____#....",
        ".t.......t......t..p..t.2#1##3.yy.",
        "...................p..............",
    };
    // clang-format on
}

}  // namespace

void add_floors(ExampleBuilder& builder) {
    const std::vector<std::string> whole = in_four_turns(plan());
    for (std::vector<std::string>& floor : build_plan({whole.begin(), whole.end()}, kFloorCount)) {
        builder.add_floor(std::move(floor));
    }
}

}  // namespace modelsynth::examples::castle
