#pragma once

// Private to proto's sources: the library's types stay out of its public headers.

#include "proto/limits.h"
#include "proto/problem.h"
#include "solver/core/grid.h"
#include "solver/core/result.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::proto {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

// Text of a document; bytes that are not UTF-8 are replaced instead of thrown about.
template <class Document>
std::string dump(const Document& document) {
    return document.dump(-1, ' ', false, Document::error_handler_t::replace);
}

// Of a text in UTF-8.
[[nodiscard]] std::size_t count_characters(std::string_view text);

// Reads a text whole or not at all. Depth, size and duplicate keys are checked before anything is
// built, since a deep document overflows the stack when it is copied or written.
// Fails: malformed-json with the byte offset.
[[nodiscard]] Parsed<Json> parse_json(std::string_view text, const JsonLimits& limits);

// Collects what is wrong with a document, all of it and not only the first.
class Faults {
  public:
    void add(std::string pointer, std::string detail, bool over_limit = false) {
        if (faults_.size() < kFaultsMax) {
            faults_.push_back({std::move(pointer), std::move(detail), over_limit});
        }
    }

    void add_all(const std::string& prefix, const std::vector<Fault>& faults) {
        for (const Fault& fault : faults) {
            add(prefix + fault.pointer, fault.detail, fault.over_limit);
        }
    }

    [[nodiscard]] bool empty() const { return faults_.empty(); }

    [[nodiscard]] std::vector<Fault> take() { return std::move(faults_); }

  private:
    std::vector<Fault> faults_;
};

// One value and its place. The readers answer with nothing and note a fault when the value is not
// what was asked for; types are exact, numbers are checked against their range before they are
// converted.
class Value {
  public:
    Value(const Json& json, std::string pointer, Faults& faults)
        : json_(json), pointer_(std::move(pointer)), faults_(faults) {}

    [[nodiscard]] const Json& json() const { return json_; }

    [[nodiscard]] const std::string& pointer() const { return pointer_; }

    [[nodiscard]] Faults& faults() const { return faults_; }

    void fault(std::string detail, bool over_limit = false) const {
        faults_.add(pointer_, std::move(detail), over_limit);
    }

    [[nodiscard]] std::optional<std::int64_t> integer(std::int64_t min, std::int64_t max) const;
    [[nodiscard]] std::optional<double> number(double min, double max) const;
    // Above `min`, which itself is not taken.
    [[nodiscard]] std::optional<double> number_above(double min, double max) const;
    [[nodiscard]] std::optional<bool> boolean() const;
    [[nodiscard]] std::optional<std::string> string(std::size_t characters_max) const;
    // The position in `names` of the string.
    [[nodiscard]] std::optional<std::size_t> one_of(std::span<const char* const> names) const;

    [[nodiscard]] std::optional<std::size_t> one_of(std::initializer_list<const char*> names
    ) const {
        return one_of(std::span(names.begin(), names.size()));
    }

    // The elements, when it is an array of at least min and at most max.
    [[nodiscard]] std::optional<std::vector<Value>> array(std::size_t min, std::size_t max) const;
    [[nodiscard]] std::optional<std::vector<std::string>> strings(
        std::size_t min, std::size_t max, std::size_t characters_max
    ) const;
    // Three integers [x, y, z].
    [[nodiscard]] std::optional<Cell> cell(std::int64_t min, std::int64_t max) const;

  private:
    const Json& json_;
    std::string pointer_;
    Faults& faults_;
};

// The fields of an object. Fields nobody asked for are faults, found by finish().
class ObjectReader {
  public:
    // Notes a fault when the value is no object; every field is then missing.
    explicit ObjectReader(const Value& value);

    [[nodiscard]] std::optional<Value> optional(const char* name);
    // Notes a fault when the field is missing.
    [[nodiscard]] std::optional<Value> required(const char* name);
    // Every field not asked for becomes a fault.
    void finish();

  private:
    const Value value_;
    bool is_object_;
    std::set<std::string> asked_;
};

}  // namespace modelsynth::proto
