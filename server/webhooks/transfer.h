#pragma once

#include "server/store/delivery_store.h"
#include "server/webhooks/webhook_config.h"

#include <curl/curl.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace modelsynth::server {

// One message on its way: its bytes, and what has been seen of the answer.
class Transfer {
  public:
    // Of an answer, which nobody reads; what is longer is cut off.
    static constexpr std::size_t kAnswerBytesMax = 64 * 1024;

    struct Message {
        std::string id;         // the same for every try
        std::string timestamp;  // seconds of the Unix epoch
        std::string signature;
        std::string body;
    };

    // Throws std::bad_alloc.
    Transfer(const WebhookConfig& config, Delivery delivery, Message message);

    Transfer(const Transfer&) = delete;
    Transfer& operator=(const Transfer&) = delete;

    [[nodiscard]] CURL* handle() const { return handle_.get(); }

    [[nodiscard]] const Delivery& delivery() const { return delivery_; }

    // The status of the answer; 0: there was none.
    [[nodiscard]] long status() const;

    // The field Retry-After of an answer of 429 or 503, whose meaning for a retry is what it says.
    [[nodiscard]] std::optional<std::string> retry_after() const;

    // How long it took so far, from the look-up of the name on.
    [[nodiscard]] double seconds() const;

    // Why it did not arrive, given how the library says that it ended; empty: it did.
    [[nodiscard]] std::string failure(CURLcode code) const;

  private:
    static curl_socket_t open_socket(void* self, curlsocktype purpose, curl_sockaddr* address);
    static std::size_t take_answer(char* bytes, std::size_t size, std::size_t count, void* self);

    void set_up(const WebhookConfig& config);

    Delivery delivery_;
    Message message_;
    bool may_be_private_;
    bool was_refused_ = false;  // an address was not public
    std::size_t answer_bytes_ = 0;
    std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)> headers_;
    std::unique_ptr<CURL, decltype(&curl_easy_cleanup)> handle_;  // first to go: it uses the rest
};

}  // namespace modelsynth::server
