#pragma once

#include <cstdlib>

// What the targets hold of whatever they accept. libFuzzer keeps the input that ends the process.
inline void law(bool holds) {
    if (!holds) {
        std::abort();
    }
}
