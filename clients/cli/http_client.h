#pragma once

#include "clients/cli/failure.h"
#include "clients/cli/server_url.h"

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::cli {

struct HttpRequest {
    std::string method = "GET";
    std::string target;  // path and query, escaped; the server's prefix comes before it
    std::string content_type = {};
    std::string body = {};
    std::vector<std::pair<std::string, std::string>> headers = {};
    // The longest silence of the server that is put up with.
    std::chrono::seconds idle_max = std::chrono::seconds(300);
};

struct HttpAnswer {
    int status = 0;
    std::string body;  // empty where a sink took it
};

// Takes the body of a good answer as it comes; false stops the transfer.
using BodySink = std::function<bool(std::string_view bytes)>;

// Speaks HTTP/1.1 to one server, with TLS where its URL says so, a connection for each request.
// The server's certificate must lead to a root that is trusted and be for its name. Blocks, but no
// longer than `idle_max` without a byte, and ends early when the program is interrupted.
class HttpClient {
  public:
    // `key` is sent as a bearer token; empty: none. `ca_file`: PEM of the roots that are trusted;
    // empty: those of the system.
    HttpClient(ServerUrl server, std::string key, std::string ca_file)
        : server_(std::move(server)), key_(std::move(key)), ca_file_(std::move(ca_file)) {}

    // Ensures: the status is 2xx, and the body whole, or given whole to the sink.
    // Fails:   kUnreachable (no connection, a broken one, or silence: `is_idle`), kInterrupted,
    //          kWrongUsage when the file of roots cannot be read,
    //          kFailed with the status for any other status, kFailed when the sink stopped it.
    [[nodiscard]] Outcome<HttpAnswer> send(
        const HttpRequest& request, const BodySink& sink = nullptr
    ) const;

  private:
    ServerUrl server_;
    std::string key_;
    std::string ca_file_;
};

}  // namespace modelsynth::cli
