#include "clients/cli/failure.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace modelsynth::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string text_field(const Json& object, const char* name) {
    const auto field = object.find(name);
    return field != object.end() && field->is_string() ? field->get<std::string>() : "";
}

// "title: detail", or whichever of the two is there.
std::string headline(const Json& problem) {
    const std::string title = text_field(problem, "title");
    const std::string detail = text_field(problem, "detail");
    return title.empty() || detail.empty() ? title + detail : title + ": " + detail;
}

}  // namespace

tl::unexpected<Failure> wrong_usage(std::string message) {
    return tl::unexpected(Failure{ExitCode::kWrongUsage, std::move(message)});
}

Failure failure_of_answer(int status, const std::string& body) {
    Failure failure = failure_of_problem(body);
    failure.status = status;
    if (failure.message.empty()) {
        failure.message = "the server answered with status " + std::to_string(status);
        failure.problem.clear();
    }
    return failure;
}

Failure failure_of_problem(std::string problem) {
    const Json document = Json::parse(problem, nullptr, false);
    Failure failure;
    if (document.is_object()) {
        failure.message = headline(document);
        failure.problem = std::move(problem);
    }
    return failure;
}

std::string describe(const Failure& failure, bool as_json) {
    const Json given = Json::parse(failure.problem, nullptr, false);
    if (as_json) {
        const Json made = {
            {"type", "about:blank"}, {"title", "Error"}, {"detail", failure.message}};
        return (given.is_object() ? given : made)
                   .dump(-1, ' ', false, Json::error_handler_t::replace) +
               "\n";
    }
    std::string text = "modelsynth: " + printable(failure.message) + "\n";
    if (!given.is_object() || !given.contains("errors") || !given["errors"].is_array()) {
        return text;
    }
    for (const Json& entry : given["errors"]) {
        const std::string pointer = text_field(entry, "pointer");
        text += "  " + printable(pointer.empty() ? "request" : pointer) + ": " +
                printable(text_field(entry, "detail")) + "\n";
    }
    return text;
}

std::string printable(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            c = ' ';
        }
    }
    return text;
}

}  // namespace modelsynth::cli
