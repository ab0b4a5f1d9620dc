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
        "......p..,......*...t.....p..t.y..",
        "..,t..p....y.t........y...o.......",
        "......o........t.ff.....##G##.,.t.",
        ".5###4G4###6.....ff.....#___#.....",
        ".#_________#.....ff.....#_b_#....*",
        ".#_BBBB____#....,ff..####___####..",
        ".#_BdBB__w_#.........#_________#.y",
        ".#_________1####3....#__AAAA___#..",
        ".#______________#....#__AAaA_w_#..",
        ".#__AAAAA___KK__#....#_________#..",
        ".2__AAaAA___KK__#....####___####.,",
        ".#__AA__________5.,.....#_m_#.....",
        ".#__Aa____b_h___#...,...#___#.....",
        ".#__AA__________#..*....##1##...t.",
        ".1=======n======1.................",
        ".#______________#.............,*.y",
        ".#__BBBBB__LL___Gopp..............",
        ".#__BBBBB__LL___#..p..t..5####6...",
        ".4__BBBBB_______#..p..y..#____#...",
        ".#__BBdBB____m__#..p.*...#_MM_Gopp",
        ".#______sss_____#..p...,.#_MM_#...",
        ".3####1####4####6..p..y..#s___#...",
        "*.................*p.....3##2#4...",
        "...t.,y...,.t......p..............",
        ",.CC....o.....C.ty.p.t.y...*..CC..",
        ".....C..p.CCC.C....p..............",
        "..ff.C..p.....C..,.p....5#4#6.fff.",
        "..ff....p...,......p....#___#.fff.",
        "..ffC...oppppppppppopppoG_w_#.....",
        "....C..............p....#___#.....",
        "y.........CC.ffff*.p....2#1#3...t.",
        "...CCC,*.....ffff..p,.........t...",
        ".t.......t......t..p..t...,..*.yy.",
        "...................p....*.........",
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
