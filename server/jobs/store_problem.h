#pragma once

#include "proto/problem.h"
#include "server/store/types.h"

#include <type_traits>
#include <utility>

namespace modelsynth::server {

// What a failure of the store means to a client.
[[nodiscard]] proto::Problem problem_of(const StoreError& error);

// What the store gave, its error as the client is told.
template <class T>
proto::Parsed<T> parsed(Stored<T> stored) {
    if (!stored) {
        return tl::unexpected(problem_of(stored.error()));
    }
    if constexpr (std::is_void_v<T>) {
        return {};
    } else {
        return std::move(*stored);
    }
}

}  // namespace modelsynth::server
