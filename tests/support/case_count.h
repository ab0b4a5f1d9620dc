#pragma once

#include <cstdint>
#include <cstdlib>

namespace modelsynth::testing {

// How many random cases a test looks at: what the variable of the environment asks for, if it is
// set, else the usual number.
inline std::uint64_t case_count(std::uint64_t usual, const char* variable = "MODELSYNTH_CASES") {
    const char* asked = std::getenv(variable);
    return asked == nullptr ? usual : std::strtoull(asked, nullptr, 10);
}

// Of models of solids, which take longer: so many of what is usually a hundred.
inline std::uint64_t solid_case_count(std::uint64_t usual) {
    return (usual * case_count(100, "MODELSYNTH_SOLID_PERCENT") + 99) / 100;
}

}  // namespace modelsynth::testing
