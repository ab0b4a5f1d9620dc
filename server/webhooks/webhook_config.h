#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace modelsynth::server {

// Where webhooks may go.
struct WebhookRules {
    bool allow_http = false;     // besides https
    bool allow_private = false;  // addresses that are not of the public internet
};

struct WebhookConfig {
    std::string secret_file;  // empty: there are no webhooks
    WebhookRules rules;
    std::string ca_file;               // empty: the roots that the system trusts
    double first_delay_seconds = 5;    // from the first try to the second
    std::uint32_t try_seconds = 10;    // for a receiver to answer
    std::uint32_t tries_max = 6;       // then the message is dropped
    std::size_t in_flight_max = 16;    // messages on their way at once,
    std::size_t per_receiver_max = 2;  // and to one receiver
};

}  // namespace modelsynth::server
