#include "server/http/query_reader.h"

#include "server/http/request_fields.h"

namespace modelsynth::server {

std::optional<std::string> QueryReader::text(const char* name) {
    asked_.emplace_back(name);
    return request_.query_field(name);
}

std::optional<std::uint64_t> QueryReader::number(
    const char* name, std::uint64_t min, std::uint64_t max
) {
    const auto given = text(name);
    if (!given) {
        return std::nullopt;
    }
    const auto value = parse_number(*given);
    if (!value && !is_whole_number(*given)) {
        fault_malformed(name, "must be a whole number");
        return std::nullopt;
    }
    if (!value || *value < min || *value > max) {
        fault(name, "must be from " + std::to_string(min) + " to " + std::to_string(max));
        return std::nullopt;
    }
    return value;
}

void QueryReader::add(std::string_view name, std::string detail, bool is_malformed) {
    faults_.push_back({"/" + pointer_part(name), std::move(detail)});
    is_malformed_ |= is_malformed;
}

void QueryReader::fault_choice(const char* name, const std::vector<const char*>& names) {
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        list += i == 0 ? "" : i + 1 < names.size() ? ", " : " or ";
        list += names[i];
    }
    fault(name, "must be " + list);
}

std::optional<proto::Problem> QueryReader::finish() {
    constexpr std::size_t kNameBytesShown = 64;
    for (std::size_t i = 0; i < request_.query.size(); ++i) {
        const std::string& name = request_.query[i].first;
        const auto is_same = [&name](const auto& other) { return other.first == name; };
        const auto here = request_.query.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::find(asked_.begin(), asked_.end(), name) == asked_.end()) {
            add(name.substr(0, kNameBytesShown), "there is no such parameter", true);
        } else if (std::any_of(request_.query.begin(), here, is_same)) {
            add(name, "stands twice", true);
        }
    }
    if (faults_.empty()) {
        return std::nullopt;
    }
    proto::Problem problem = proto::make_problem(
        is_malformed_ ? "malformed-request" : "invalid-request",
        "the parameter \"" + faults_.front().pointer.substr(1) +
            "\" of the query: " + faults_.front().detail +
            (faults_.size() > 1 ? "; and " + std::to_string(faults_.size() - 1) + " more" : "")
    );
    problem.errors = std::move(faults_);
    return problem;
}

std::optional<proto::Problem> check_no_query(const Request& request) {
    return QueryReader(request).finish();
}

}  // namespace modelsynth::server
