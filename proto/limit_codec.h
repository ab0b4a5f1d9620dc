#pragma once

#include <optional>
#include <span>
#include <string>

namespace modelsynth::proto {

// A limit, or a time for which something is kept.
struct Limit {
    std::string name;
    std::optional<double> value;  // nothing: none but what the description tells
    std::string unit;             // in the plural
    std::string description;
};

// The resource /v1/limits.
[[nodiscard]] std::string limits_json(
    std::span<const Limit> limits, std::span<const Limit> retention
);

}  // namespace modelsynth::proto
