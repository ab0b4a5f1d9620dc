#include "clients/cli/catalog_commands.h"

#include "clients/cli/input_file.h"
#include "clients/cli/run_report.h"
#include "clients/cli/server_url.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace modelsynth::cli {

namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

constexpr std::uint64_t kPageMax = 100;

tl::unexpected<Failure> unexpected_answer() {
    return tl::unexpected(Failure{
        ExitCode::kFailed, "the server's answer is not what was asked for"});
}

std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// A value of a document as a cell of a table; "-" where there is none.
std::string cell(const Json& document, const char* pointer) {
    const Json::json_pointer place{pointer};
    const Json value = document.contains(place) ? document.at(place) : Json();
    if (value.is_null()) {
        return "-";
    }
    return printable(value.is_string() ? value.get<std::string>() : dump(value));
}

Row job_row(const Json& job) {
    const std::string inline_name = cell(job, "/request/example/name");
    return {
        cell(job, "/id"),
        cell(job, "/state"),
        inline_name == "-" ? cell(job, "/request/example") : inline_name,
        cell(job, "/request/parameters/size"),
        cell(job, "/seed"),
        cell(job, "/progress/blocks_done") + "/" + cell(job, "/progress/blocks_total"),
        cell(job, "/created")};
}

Row example_row(const Json& example) {
    return {
        cell(example, "/id"),
        cell(example, "/kind"),
        cell(example, "/name"),
        cell(example, "/labels"),
        cell(example, "/size"),
        cell(example, "/built_in")};
}

void print_table(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const Row& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            widths[i] = std::max(widths[i], row[i].size());
        }
    }
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += row[i];
            line += i + 1 < row.size() ? std::string(widths[i] - row[i].size() + 2, ' ') : "";
        }
        print_line(line);
    }
}

// The jobs that the server gives page by page, as many as are asked for, as one page.
Outcome<Json> read_pages(const HttpClient& client, const ListOptions& options) {
    const std::string state =
        options.state.empty() ? "" : "&state=" + percent_encode(options.state);
    Json page = {{"items", Json::array()}, {"next", nullptr}};
    std::string cursor;
    do {
        const std::uint64_t wanted = std::min(kPageMax, options.limit - page["items"].size());
        const auto answer =
            client.send({.target = "/v1/jobs?limit=" + std::to_string(wanted) + state + cursor});
        if (!answer) {
            return tl::unexpected(answer.error());
        }
        Json part = Json::parse(answer->body, nullptr, false);
        if (!part.is_object() || !part.contains("items") || !part["items"].is_array()) {
            return unexpected_answer();
        }
        for (Json& item : part["items"]) {
            page["items"].push_back(std::move(item));
        }
        page["next"] = part.contains("next") ? part["next"] : Json();
        cursor = page["next"].is_string()
                     ? "&cursor=" + percent_encode(page["next"].get<std::string>())
                     : "";
    } while (!cursor.empty() && page["items"].size() < options.limit);
    return page;
}

void show_list(const Json& page, Row head, const std::function<Row(const Json&)>& row_of) {
    std::vector<Row> rows = {std::move(head)};
    for (const Json& item : page["items"]) {
        rows.push_back(row_of(item));
    }
    print_table(rows);
}

}  // namespace

Outcome<void> list_jobs(const HttpClient& client, const ListOptions& options, bool as_json) {
    return read_pages(client, options).map([as_json](const Json& page) {
        if (as_json) {
            print_line(dump(page));
            return;
        }
        show_list(page, {"ID", "STATE", "EXAMPLE", "SIZE", "SEED", "BLOCKS", "CREATED"}, job_row);
    });
}

Outcome<void> list_examples(const HttpClient& client, bool as_json) {
    const auto answer = client.send({.target = "/v1/examples"});
    if (!answer) {
        return tl::unexpected(answer.error());
    }
    const Json page = Json::parse(answer->body, nullptr, false);
    if (!page.is_object() || !page.contains("items")) {
        return unexpected_answer();
    }
    if (as_json) {
        print_line(dump(page));
    } else {
        show_list(page, {"ID", "KIND", "NAME", "LABELS", "SIZE", "BUILT IN"}, example_row);
    }
    return {};
}

Outcome<void> cancel_job(const HttpClient& client, const std::string& job_id, bool as_json) {
    const std::string target = "/v1/jobs/" + percent_encode(job_id) + "/cancel";
    return client.send({"POST", target}).and_then([&](const HttpAnswer& answer) -> Outcome<void> {
        const Json job = Json::parse(answer.body, nullptr, false);
        if (!job.is_object()) {
            return unexpected_answer();
        }
        print_line(as_json ? dump(job) : cell(job, "/id") + " " + cell(job, "/state"));
        return {};
    });
}

Outcome<void> delete_job(const HttpClient& client, const std::string& job_id, bool as_json) {
    const std::string target = "/v1/jobs/" + percent_encode(job_id);
    return client.send({"DELETE", target}).map([&](const HttpAnswer&) {
        print_line(as_json ? dump({{"id", job_id}, {"deleted", true}}) : job_id + " deleted");
    });
}

Outcome<void> upload_example(const HttpClient& client, const std::string& path, bool as_json) {
    const bool is_glb = path.ends_with(".glb");
    auto body = is_glb ? read_input(path) : read_example_file(path);
    if (!body) {
        return tl::unexpected(std::move(body.error()));
    }
    const std::string type = is_glb ? "model/gltf-binary" : "application/json";
    return client.send({"POST", "/v1/examples", type, std::move(*body)})
        .and_then([as_json](const HttpAnswer& answer) -> Outcome<void> {
            const Json example = Json::parse(answer.body, nullptr, false);
            if (!example.is_object()) {
                return unexpected_answer();
            }
            print_line(as_json ? dump(example) : cell(example, "/id"));
            return {};
        });
}

}  // namespace modelsynth::cli
