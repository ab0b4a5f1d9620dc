#include "proto/limit_codec.h"

#include "proto/json.h"

#include <cmath>
#include <cstdint>

namespace modelsynth::proto {

namespace {

OrderedJson limit_value(const std::optional<double>& value) {
    if (!value) {
        return nullptr;
    }
    const bool is_whole = *value == std::floor(*value) && *value <= static_cast<double>(kSeedMax);
    return is_whole ? OrderedJson(static_cast<std::uint64_t>(*value)) : OrderedJson(*value);
}

OrderedJson limits_by_name(std::span<const Limit> limits) {
    OrderedJson document = OrderedJson::object();
    for (const Limit& limit : limits) {
        document[limit.name] = {
            {"value", limit_value(limit.value)},
            {"unit", limit.unit},
            {"description", limit.description}};
    }
    return document;
}

}  // namespace

std::string limits_json(std::span<const Limit> limits, std::span<const Limit> retention) {
    return dump(OrderedJson{
        {"limits", limits_by_name(limits)}, {"retention", limits_by_name(retention)}});
}

}  // namespace modelsynth::proto
