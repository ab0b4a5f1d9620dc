#pragma once

namespace modelsynth::cli {

// From now on SIGINT and SIGTERM are noted instead of ending the program, so that it can tidy up;
// the second one ends it at once.
void catch_interrupts();

// Whether one was noted. Thread-safe.
[[nodiscard]] bool is_interrupted();

}  // namespace modelsynth::cli
