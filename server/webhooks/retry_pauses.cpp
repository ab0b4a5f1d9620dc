#include "server/webhooks/retry_pauses.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace modelsynth::server {

using proto::UnixMillis;

namespace {

constexpr double kGrowth = 6;

double nominal_ms(double first_seconds, std::uint32_t tries) {
    double pause = first_seconds * 1000;
    for (std::uint32_t i = 1; i < tries; ++i) {
        pause *= kGrowth;
    }
    return pause;
}

}  // namespace

RetryPauses::RetryPauses(const WebhookConfig& config, std::function<double()> random)
    : first_seconds_(config.first_delay_seconds),
      tries_max_(config.tries_max),
      random_(std::move(random)) {}

UnixMillis RetryPauses::after(std::uint32_t tries, const std::optional<UnixMillis>& asked) {
    const double fraction = random_();
    const double own = nominal_ms(first_seconds_, tries) * (1 + kSpread * (2 * fraction - 1));
    const double wanted = asked ? static_cast<double>(*asked) * (1 + kSpread * fraction) : 0;
    const double granted = std::min(wanted, static_cast<double>(longest()));
    return static_cast<UnixMillis>(std::llround(std::max(own, granted)));
}

UnixMillis RetryPauses::longest() const {
    const std::uint32_t last = tries_max_ > 1 ? tries_max_ - 1 : 1;
    return static_cast<UnixMillis>(std::llround(nominal_ms(first_seconds_, last)));
}

std::function<double()> random_fractions() {
    std::random_device device;
    std::seed_seq seed = {device(), device(), device(), device()};
    return [generator = std::mt19937_64(seed)]() mutable {
        return static_cast<double>(generator() >> 11U) * 0x1p-53;
    };
}

}  // namespace modelsynth::server
