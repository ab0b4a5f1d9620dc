#pragma once

#include "proto/timestamp.h"
#include "server/webhooks/webhook_config.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace modelsynth::server {

// How long a message rests between a try that failed and the next. The nominal pause is the
// configuration's first, and six times as long after each further try. What is waited is drawn
// from kSpread around it, so that messages that failed together do not come back together.
class RetryPauses {
  public:
    static constexpr double kSpread = 0.2;

    // `random` gives numbers from 0 to below 1, evenly.
    RetryPauses(const WebhookConfig& config, std::function<double()> random);

    // After so many tries, the first of which is 1. `asked` is what the receiver asked for, in
    // milliseconds; it is waited for, and up to kSpread more, but never for longer than longest(),
    // and never makes a pause shorter.
    [[nodiscard]] proto::UnixMillis after(
        std::uint32_t tries, const std::optional<proto::UnixMillis>& asked = {}
    );

    // The nominal pause before the last try.
    [[nodiscard]] proto::UnixMillis longest() const;

  private:
    double first_seconds_;
    std::uint32_t tries_max_;
    std::function<double()> random_;
};

// Evenly distributed numbers from 0 to below 1, other ones at every start.
[[nodiscard]] std::function<double()> random_fractions();

}  // namespace modelsynth::server
