#pragma once

#include "server/webhooks/webhook_config.h"

#include <optional>
#include <string>

namespace modelsynth::server {

// What is wrong with a URL as the place of a webhook, or nothing. Read by the library that will go
// there, so that the two cannot mean different places. Names are not looked up. Thread-safe.
[[nodiscard]] std::optional<std::string> find_url_fault(
    const std::string& url, const WebhookRules& rules
);

}  // namespace modelsynth::server
