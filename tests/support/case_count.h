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

// Whether a test looks at no fewer cases than usual. A sanitizer's run looks at few, and what few
// happen to meet is chance: only a usual run is expected to have met all that its test is about.
inline bool are_cases_usual(std::uint64_t usual) { return case_count(usual) >= usual; }

inline bool are_solid_cases_usual() { return solid_case_count(100) >= 100; }

}  // namespace modelsynth::testing
