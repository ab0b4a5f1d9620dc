// One small solve, always the same, for instructions.sh to count.
//
//   one_solve portable|avx2
//
// The processor is asked for no more than that; exit code 3 when it has less.

#include "solver/core/vector_level.h"
#include "solver/discrete/synthesis.h"
#include "solver/examples/built_in.h"

#include <cstdio>
#include <string_view>

namespace {

namespace discrete = modelsynth::discrete;

class Silent final : public modelsynth::Observer {
  public:
    void on_start(std::uint32_t, std::span<const modelsynth::Label>) override {}

    void on_block(const modelsynth::BlockReport&) override {}
};

}  // namespace

// What is counted, under a name that the compiler leaves as it is. A request that nothing was
// prepared for: 9 blocks of 10 x 10 x 10 cells of the castle.
extern "C" [[gnu::noipa]] bool counted_solve(const discrete::Example* example) {
    discrete::Parameters parameters;
    parameters.size = modelsynth::GridSize{20, 10, 20};
    Silent observer;
    return discrete::synthesise(*example, fill_defaults(parameters, *example), 1, observer, {})
        .has_value();
}

int main(int argc, char** argv) {
    const std::string_view name = argc == 2 ? argv[1] : "";
    if (name != "portable" && name != "avx2") {
        std::fprintf(stderr, "one_solve portable|avx2\n");
        return 2;
    }
    const auto level =
        name == "avx2" ? modelsynth::VectorLevel::kAvx2 : modelsynth::VectorLevel::kPortable;
    modelsynth::limit_vector_level(level);
    if (modelsynth::vector_level() != level) {
        return 3;
    }
    const discrete::Example example = modelsynth::examples::make_castle();
    return counted_solve(&example) ? 0 : 1;
}
