#include "proto/key_codec.h"

#include "proto/json.h"

#include <algorithm>
#include <set>
#include <utility>

namespace modelsynth::proto {

namespace {

constexpr double kRateMax = 1e6;
constexpr std::int64_t kJobsMax = 1'000'000;
constexpr std::size_t kNameMax = 64;

std::optional<std::string> read_name(const Value& value) {
    auto name = value.string(kNameMax);
    if (name && name->empty()) {
        value.fault("must not be empty");
    }
    return name;
}

std::optional<std::string> read_digest(const Value& value) {
    auto digits = value.string(64);
    if (!digits) {
        return std::nullopt;
    }
    for (char& digit : *digits) {
        digit = digit >= 'A' && digit <= 'F' ? static_cast<char>(digit | 0x20) : digit;
    }
    if (digits->size() != 64 ||
        digits->find_first_not_of("0123456789abcdef") != std::string::npos) {
        value.fault("must be the SHA-256 of the key, 64 hexadecimal digits");
        return std::nullopt;
    }
    return digits;
}

std::vector<Scope> read_scopes(const Value& value) {
    std::vector<Scope> scopes;
    for (const Value& item : value.array(1, 3).value_or(std::vector<Value>())) {
        if (const auto scope = item.one_of({"read", "submit", "admin"})) {
            scopes.push_back(static_cast<Scope>(*scope));
        }
    }
    return scopes;
}

KeyEntry read_key(const Value& value, std::set<std::string>& digests) {
    KeyEntry key;
    ObjectReader fields(value);
    if (const auto name = fields.required("name")) {
        key.name = read_name(*name).value_or("");
    }
    if (const auto digest = fields.required("sha256")) {
        key.sha256 = read_digest(*digest).value_or("");
        if (!key.sha256.empty() && !digests.insert(key.sha256).second) {
            digest->fault("stands twice");
        }
    }
    if (const auto scopes = fields.required("scopes")) {
        key.scopes = read_scopes(*scopes);
    }
    if (const auto rate = fields.optional("rate")) {
        key.rate = rate->number_above(0, kRateMax);
    }
    if (const auto jobs = fields.optional("jobs")) {
        if (const auto number = jobs->integer(1, kJobsMax)) {
            key.jobs = static_cast<std::size_t>(*number);
        }
    }
    fields.finish();
    return key;
}

template <class T>
Parsed<T> unless(Faults& faults, T value) {
    if (faults.empty()) {
        return value;
    }
    Problem problem = make_problem("invalid-request", "see errors");
    problem.errors = faults.take();
    return tl::unexpected(std::move(problem));
}

}  // namespace

bool may(const KeyEntry& key, Scope scope) {
    return std::find(key.scopes.begin(), key.scopes.end(), scope) != key.scopes.end();
}

Parsed<std::vector<KeyEntry>> parse_keys(std::string_view text) {
    const auto document = parse_json(text, {});
    if (!document) {
        return tl::unexpected(document.error());
    }
    Faults faults;
    std::vector<KeyEntry> keys;
    ObjectReader fields(Value(*document, "", faults));
    if (const auto list = fields.required("keys")) {
        std::set<std::string> digests;
        for (const Value& item : list->array(0, kKeysMax).value_or(std::vector<Value>())) {
            keys.push_back(read_key(item, digests));
        }
    }
    fields.finish();
    return unless(faults, std::move(keys));
}

Parsed<std::string> parse_ticket_request(std::string_view text) {
    if (text.empty()) {
        return std::string();
    }
    const auto document = parse_json(text, {});
    if (!document) {
        return tl::unexpected(document.error());
    }
    Faults faults;
    std::string job;
    ObjectReader fields(Value(*document, "", faults));
    if (const auto id = fields.optional("job")) {
        job = id->string(64).value_or("");
        if (job.empty()) {
            id->fault("must be the id of a job");
        }
    }
    fields.finish();
    return unless(faults, std::move(job));
}

}  // namespace modelsynth::proto
