#pragma once

#include <string_view>

namespace modelsynth::server {

// What is told of webhooks to whoever counts, on the sender's thread. Calls must not block.
class WebhookObserver {
  public:
    virtual ~WebhookObserver() = default;

    // A try has ended: "delivered", "retried" when there will be another one, or "given-up".
    // `seconds`: from its beginning, names looked up and all, to the answer or what came instead.
    virtual void on_try(std::string_view /*outcome*/, double /*seconds*/) {}
};

}  // namespace modelsynth::server
