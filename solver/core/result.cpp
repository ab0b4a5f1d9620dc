#include "solver/core/result.h"

#include <cstdio>
#include <cstdlib>

namespace modelsynth {

void check(bool condition, const char* why) {
    if (condition) {
        return;
    }
    std::fprintf(stderr, "modelsynth: internal check failed: %s\n", why);
    std::abort();
}

}  // namespace modelsynth
