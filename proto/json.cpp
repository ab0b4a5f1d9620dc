#include "proto/json.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace modelsynth::proto {

namespace {

// Reads a text and tells how far it came, which the library tells of its own errors alone.
class Reading {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Reading(const char* at, const char*& reached) : at_(at), reached_(&reached) {}

    reference operator*() const { return *at_; }

    Reading& operator++() {
        *reached_ = ++at_;
        return *this;
    }

    friend bool operator==(const Reading& a, const Reading& b) { return a.at_ == b.at_; }

  private:
    const char* at_;
    const char** reached_;
};

// Walks a text without building anything and stops at the first thing that must not be built.
class Scanner final : public nlohmann::json_sax<Json> {
  public:
    Scanner(std::string_view text, const JsonLimits& limits)
        : text_(text), reached_(text.data()), limits_(limits) {}

    bool scan() {
        const char* const end = text_.data() + text_.size();
        return Json::sax_parse(Reading(text_.data(), reached_), Reading(end, reached_), this);
    }

    bool null() override { return count(); }

    bool boolean(bool /*value*/) override { return count(); }

    bool number_integer(number_integer_t /*value*/) override { return count(); }

    bool number_unsigned(number_unsigned_t /*value*/) override { return count(); }

    bool number_float(number_float_t value, const string_t& /*text*/) override {
        return count() && (std::isfinite(value) || fail("a number is too large"));
    }

    bool string(string_t& value) override { return count() && fits(value); }

    bool binary(binary_t& /*value*/) override { return fail("binary values are not JSON"); }

    bool start_object(std::size_t /*count*/) override {
        keys_.emplace_back();
        return count() && deepen();
    }

    bool key(string_t& name) override {
        if (!keys_.back().insert(name).second) {
            return fail("the key \"" + name.substr(0, 64) + "\" stands twice in one object");
        }
        return fits(name);
    }

    bool end_object() override {
        keys_.pop_back();
        --depth_;
        return true;
    }

    bool start_array(std::size_t /*count*/) override { return count() && deepen(); }

    bool end_array() override {
        --depth_;
        return true;
    }

    bool parse_error(
        std::size_t position, const std::string& /*token*/, const Json::exception& error
    ) override {
        // The library's text says what was expected after its last "- " or "; ".
        const std::string text = error.what();
        const std::size_t dash = text.find(": ", text.find("parse error"));
        const std::string reason =
            dash == std::string::npos ? "syntax error" : text.substr(dash + 2);
        // Positions count from 1 and name the character after the last one read.
        return fail(reason, position);
    }

    [[nodiscard]] const std::string& error() const { return error_; }

  private:
    bool fail(const std::string& why) {
        return fail(why, static_cast<std::size_t>(reached_ - text_.data()));
    }

    bool fail(const std::string& why, std::size_t position) {
        error_ = why + " (at byte " + std::to_string(position > 0 ? position - 1 : 0) + ")";
        return false;
    }

    bool count() {
        return ++nodes_ <= limits_.nodes_max ||
               fail("there are more than " + std::to_string(limits_.nodes_max) + " values");
    }

    bool deepen() {
        return ++depth_ <= limits_.depth_max ||
               fail("it nests deeper than " + std::to_string(limits_.depth_max));
    }

    bool fits(const string_t& value) {
        return value.size() <= limits_.string_bytes_max ||
               fail(
                   "a string is longer than " + std::to_string(limits_.string_bytes_max) + " bytes"
               );
    }

    std::string_view text_;
    const char* reached_;
    const JsonLimits& limits_;
    std::size_t nodes_ = 0;
    std::size_t depth_ = 0;
    std::vector<std::set<std::string>> keys_;
    std::string error_;
};

const char* type_name(const Json& json) {
    switch (json.type()) {
        case Json::value_t::null:
            return "null";
        case Json::value_t::object:
            return "an object";
        case Json::value_t::array:
            return "an array";
        case Json::value_t::string:
            return "a string";
        case Json::value_t::boolean:
            return "a boolean";
        default:
            return "a number";
    }
}

std::string range_text(double min, double max) {
    const auto text = [](double value) {
        Json number = value;
        if (value == std::floor(value) && std::fabs(value) < 1e15) {
            number = static_cast<std::int64_t>(value);
        }
        return number.dump();
    };
    return text(min) + " to " + text(max);
}

}  // namespace

std::size_t count_characters(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // not within a character
    }));
}

Parsed<Json> parse_json(std::string_view text, const JsonLimits& limits) {
    Scanner scanner(text, limits);
    if (!scanner.scan()) {
        return tl::unexpected(make_problem("malformed-json", scanner.error()));
    }
    // The library takes a NUL for the end of the text, whatever follows.
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
        return tl::unexpected(make_problem(
            "malformed-json", "there is a NUL character (at byte " + std::to_string(nul) + ")"
        ));
    }
    return Json::parse(text, nullptr, false);
}

std::optional<std::int64_t> Value::integer(std::int64_t min, std::int64_t max) const {
    const auto refuse = [&]() -> std::optional<std::int64_t> {
        fault("must be a whole number from " + std::to_string(min) + " to " + std::to_string(max));
        return std::nullopt;
    };
    if (json_.is_number_unsigned()) {
        const auto value = json_.get<std::uint64_t>();
        if (max < 0 || value > static_cast<std::uint64_t>(max) ||
            (min > 0 && value < static_cast<std::uint64_t>(min))) {
            return refuse();
        }
        return static_cast<std::int64_t>(value);
    }
    if (json_.is_number_integer()) {
        const auto value = json_.get<std::int64_t>();
        return value < min || value > max ? refuse() : value;
    }
    if (json_.is_number_float()) {  // 40.0 is a whole number too, as in JSON Schema
        const auto value = json_.get<double>();
        const bool whole = value == std::floor(value) && std::fabs(value) <= 9007199254740992.0;
        if (!whole || value < static_cast<double>(min) || value > static_cast<double>(max)) {
            return refuse();
        }
        return static_cast<std::int64_t>(value);
    }
    fault(std::string("must be a whole number, not ") + type_name(json_));
    return std::nullopt;
}

std::optional<double> Value::number(double min, double max) const {
    if (!json_.is_number()) {
        fault(std::string("must be a number, not ") + type_name(json_));
        return std::nullopt;
    }
    const auto value = json_.get<double>();
    if (!(value >= min && value <= max)) {
        fault("must be from " + range_text(min, max));
        return std::nullopt;
    }
    return value;
}

std::optional<double> Value::number_above(double min, double max) const {
    const auto value = number(min, max);
    if (value && *value <= min) {
        fault("must be above " + range_text(min, max));
        return std::nullopt;
    }
    return value;
}

std::optional<bool> Value::boolean() const {
    if (!json_.is_boolean()) {
        fault(std::string("must be true or false, not ") + type_name(json_));
        return std::nullopt;
    }
    return json_.get<bool>();
}

std::optional<std::string> Value::string(std::size_t characters_max) const {
    if (!json_.is_string()) {
        fault(std::string("must be a string, not ") + type_name(json_));
        return std::nullopt;
    }
    const auto& text = json_.get_ref<const std::string&>();
    if (count_characters(text) > characters_max) {
        fault("must have at most " + std::to_string(characters_max) + " characters");
        return std::nullopt;
    }
    return text;
}

std::optional<std::size_t> Value::one_of(std::span<const char* const> names) const {
    std::string listed;
    std::size_t position = 0;
    for (const char* name : names) {
        if (json_.is_string() && json_.get_ref<const std::string&>() == name) {
            return position;
        }
        listed += (position++ == 0 ? "\"" : ", \"") + std::string(name) + "\"";
    }
    fault("must be one of " + listed);
    return std::nullopt;
}

std::optional<std::vector<Value>> Value::array(std::size_t min, std::size_t max) const {
    if (!json_.is_array()) {
        fault(std::string("must be an array, not ") + type_name(json_));
        return std::nullopt;
    }
    if (json_.size() < min || json_.size() > max) {
        fault(
            min == max
                ? "must have " + std::to_string(min) + " elements"
                : "must have " + std::to_string(min) + " to " + std::to_string(max) + " elements"
        );
        return std::nullopt;
    }
    std::vector<Value> values;
    values.reserve(json_.size());
    for (std::size_t i = 0; i < json_.size(); ++i) {
        values.emplace_back(json_[i], pointer_ + "/" + std::to_string(i), faults_);
    }
    return values;
}

std::optional<std::vector<std::string>> Value::strings(
    std::size_t min, std::size_t max, std::size_t characters_max
) const {
    const auto values = array(min, max);
    if (!values) {
        return std::nullopt;
    }
    std::vector<std::string> texts;
    bool fine = true;
    for (const Value& value : *values) {
        auto text = value.string(characters_max);
        fine = fine && text.has_value();
        texts.push_back(std::move(text).value_or(""));
    }
    return fine ? std::optional(std::move(texts)) : std::nullopt;
}

std::optional<Cell> Value::cell(std::int64_t min, std::int64_t max) const {
    const auto values = array(3, 3);
    if (!values) {
        return std::nullopt;
    }
    const auto x = (*values)[0].integer(min, max);
    const auto y = (*values)[1].integer(min, max);
    const auto z = (*values)[2].integer(min, max);
    if (!x || !y || !z) {
        return std::nullopt;
    }
    return Cell{
        static_cast<std::int32_t>(*x),
        static_cast<std::int32_t>(*y),
        static_cast<std::int32_t>(*z)};
}

ObjectReader::ObjectReader(const Value& value)
    : value_(value), is_object_(value.json().is_object()) {
    if (!is_object_) {
        value.fault(std::string("must be an object, not ") + type_name(value.json()));
    }
}

std::optional<Value> ObjectReader::optional(const char* name) {
    asked_.insert(name);
    if (!is_object_) {
        return std::nullopt;
    }
    const auto found = value_.json().find(name);
    if (found == value_.json().end()) {
        return std::nullopt;
    }
    return Value(*found, value_.pointer() + "/" + name, value_.faults());
}

std::optional<Value> ObjectReader::required(const char* name) {
    auto value = optional(name);
    if (is_object_ && !value) {
        value_.faults().add(
            value_.pointer() + "/" + name, std::string("the field \"") + name + "\" is required"
        );
    }
    return value;
}

void ObjectReader::finish() {
    if (!is_object_) {
        return;
    }
    for (const auto& [name, json] : value_.json().items()) {
        if (!asked_.contains(name)) {
            value_.faults().add(
                value_.pointer() + "/" + pointer_part(name), "there is no such field"
            );
        }
    }
}

}  // namespace modelsynth::proto
