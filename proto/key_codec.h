#pragma once

#include "proto/limits.h"
#include "proto/problem.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

// What a key may be used for: to look, to have work done and to undo it, to see what is other
// keys' and how the server fares.
enum class Scope : std::uint8_t { kRead, kSubmit, kAdmin };

// A key as the file of keys has it: not the key itself, so that whoever reads the file cannot use
// it.
struct KeyEntry {
    std::string name;    // whose it is; several keys may be one owner's, while one takes over
    std::string sha256;  // of the key, 64 digits in lower case
    std::vector<Scope> scopes;
    std::optional<double> rate;       // requests a second
    std::optional<std::size_t> jobs;  // unfinished at once
};

[[nodiscard]] bool may(const KeyEntry& key, Scope scope);

inline constexpr std::size_t kKeysMax = 10'000;

// Reads a file of keys, {"keys": [...]}. Fails: malformed-json, invalid-request with every fault.
[[nodiscard]] Parsed<std::vector<KeyEntry>> parse_keys(std::string_view text);

// The body of POST /v1/tickets: the job that the ticket is for; empty for all that its key may
// see. An empty body asks for nothing in particular. Fails: as parse_keys().
[[nodiscard]] Parsed<std::string> parse_ticket_request(std::string_view text);

}  // namespace modelsynth::proto
