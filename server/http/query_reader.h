#pragma once

#include "proto/problem.h"
#include "server/http/message.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::server {

// Values that a parameter may have, by name.
template <class Value, std::size_t kCount>
using NamedValues = std::array<std::pair<const char*, Value>, kCount>;

// Reads the parameters of a query and keeps all that is wrong with them until the end. What is
// wrong reads as if it were not there.
class QueryReader {
  public:
    explicit QueryReader(const Request& request) : request_(request) {}

    [[nodiscard]] std::optional<std::string> text(const char* name);

    // A whole number within bounds.
    [[nodiscard]] std::optional<std::uint64_t> number(
        const char* name, std::uint64_t min, std::uint64_t max
    );

    template <class Value, std::size_t kCount>
    [[nodiscard]] std::optional<Value> one_of(
        const char* name, const NamedValues<Value, kCount>& known
    ) {
        const auto given = text(name);
        if (!given) {
            return std::nullopt;
        }
        const auto found = std::find_if(known.begin(), known.end(), [&](const auto& entry) {
            return entry.first == *given;
        });
        if (found != known.end()) {
            return found->second;
        }
        std::vector<const char*> names;
        for (const auto& entry : known) {
            names.push_back(entry.first);
        }
        fault_choice(name, names);
        return std::nullopt;
    }

    // A value that does not suit, and one that is not what it is to be.
    void fault(const char* name, std::string detail) { add(name, std::move(detail), false); }

    void fault_malformed(const char* name, std::string detail) {
        add(name, std::move(detail), true);
    }

    // Malformed where something is not what it is to be, a parameter that nobody asked for is there
    // - it is mistyped, and leaving it out would answer another question -, or one is there twice;
    // invalid where only values do not suit; nothing where all is well. Pointers of the faults are
    // into an object of the parameters.
    [[nodiscard]] std::optional<proto::Problem> finish();

  private:
    void add(std::string_view name, std::string detail, bool is_malformed);
    void fault_choice(const char* name, const std::vector<const char*>& names);

    const Request& request_;
    std::vector<std::string_view> asked_;
    std::vector<Fault> faults_;
    bool is_malformed_ = false;
};

// Of a resource that takes no parameters.
[[nodiscard]] std::optional<proto::Problem> check_no_query(const Request& request);

}  // namespace modelsynth::server
