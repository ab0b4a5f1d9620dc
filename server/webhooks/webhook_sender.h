#pragma once

#include "server/store/delivery_store.h"
#include "server/store/job_store.h"
#include "server/webhooks/signing.h"
#include "server/webhooks/webhook_config.h"
#include "server/webhooks/webhook_observer.h"

#include <spdlog/logger.h>
#include <tl/expected.hpp>

#include <memory>
#include <string>

namespace modelsynth::server {

// Sends what the store has to send when jobs end, on a thread of its own: a POST, signed, to the
// job's webhook; again with growing pauses (retry_pauses.h) until it is answered with 2xx, as often
// as the configuration says. Each is sent at least once, whatever becomes of the process; the
// header webhook-id tells repetitions. Redirects are not followed, and addresses are checked when
// they are connected to. Thread-safe.
class WebhookSender {
  public:
    // The stores and the observer outlive the sender.
    WebhookSender(
        const WebhookConfig& config,
        JobStore& jobs,
        DeliveryStore& deliveries,
        WebhookObserver& observer,
        std::shared_ptr<spdlog::logger> log
    );
    // Gives what is on its way a moment to arrive; the rest is sent after the next start.
    ~WebhookSender();

    WebhookSender(const WebhookSender&) = delete;
    WebhookSender& operator=(const WebhookSender&) = delete;

    // Reads the secrets, also again. Fails with what is wrong; those read before stay.
    [[nodiscard]] tl::expected<void, std::string> load_secrets();

    // Requires: load_secrets() succeeded.
    void start();

  private:
    class Loop;
    std::unique_ptr<Loop> loop_;
};

}  // namespace modelsynth::server
