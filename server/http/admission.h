#pragma once

#include "server/access/browser_rules.h"
#include "server/access/key_ring.h"
#include "server/access/rate_limiter.h"
#include "server/access/tickets.h"
#include "server/http/message.h"

#include <tl/expected.hpp>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace modelsynth::server {

struct AccessConfig {
    std::string keys_file;  // empty: nobody needs a key
    BrowserRules browsers;
};

// What a route asks of whoever asks for it.
struct Need {
    std::optional<proto::Scope> scope;  // nothing: anybody
    bool takes_tickets = false;
    bool changes_things = false;
};

// Who may ask for what, and how often. Thread-safe; does not block.
class Admission {
  public:
    explicit Admission(AccessConfig config) : config_(std::move(config)) {}

    // Reads the file of keys, at the start and whenever it has changed; when it is wrong those
    // read before stay. Fails: what is wrong with it.
    [[nodiscard]] tl::expected<void, std::string> load_keys();

    // What goes before there is a route: names that are none of this server's, and the question of
    // a browser whether it may ask (CORS preflight). Sets what every answer to the request tells.
    [[nodiscard]] std::optional<Response> check_browser(Request& request) const;

    // The refusal of a request, or nothing: then the request tells on whose behalf it is. A
    // ticket is used up and taken out of the query.
    [[nodiscard]] std::optional<Response> admit(Request& request, const Need& need);

    // POST /v1/tickets
    [[nodiscard]] Response give_ticket(const Request& request, const std::string& job_id);

  private:
    [[nodiscard]] std::shared_ptr<const KeyRing> keys() const;
    [[nodiscard]] std::optional<proto::KeyEntry> key_of(Request& request, const Need& need);

    AccessConfig config_;
    mutable std::mutex mutex_;
    std::shared_ptr<const KeyRing> keys_;  // guarded by mutex_; null: no keys
    RateLimiter rates_;
    Tickets tickets_;
};

}  // namespace modelsynth::server
