#include "server/webhooks/transfer.h"

#include "server/webhooks/address_rules.h"

#include <sys/socket.h>

#include <initializer_list>
#include <new>
#include <utility>

namespace modelsynth::server {

namespace {

using Headers = std::unique_ptr<curl_slist, decltype(&curl_slist_free_all)>;

Headers list_of(std::initializer_list<std::string> lines) {
    Headers headers(nullptr, &curl_slist_free_all);
    for (const std::string& line : lines) {
        curl_slist* longer = curl_slist_append(headers.get(), line.c_str());
        if (longer == nullptr) {
            throw std::bad_alloc();
        }
        static_cast<void>(headers.release());
        headers.reset(longer);
    }
    return headers;
}

}  // namespace

Transfer::Transfer(const WebhookConfig& config, Delivery delivery, Message message)
    : delivery_(std::move(delivery)),
      message_(std::move(message)),
      may_be_private_(config.rules.allow_private),
      headers_(list_of(
          {"Content-Type: application/json",
           "webhook-id: " + message_.id,
           "webhook-timestamp: " + message_.timestamp,
           "webhook-signature: " + message_.signature,
           "Expect:"}
      )),
      handle_(curl_easy_init(), &curl_easy_cleanup) {
    if (!handle_) {
        throw std::bad_alloc();
    }
    set_up(config);
}

void Transfer::set_up(const WebhookConfig& config) {
    CURL* handle = handle_.get();
    const auto set = [handle](CURLoption option, auto value) {
        curl_easy_setopt(handle, option, value);
    };
    set(CURLOPT_PRIVATE, this);
    set(CURLOPT_URL, delivery_.url.c_str());
    set(CURLOPT_PROTOCOLS_STR, config.rules.allow_http ? "https,http" : "https");
    set(CURLOPT_HTTP_VERSION, long{CURL_HTTP_VERSION_1_1});
    set(CURLOPT_FOLLOWLOCATION, 0L);
    // What the environment says of proxies would go around the check of addresses.
    set(CURLOPT_PROXY, "");
    set(CURLOPT_OPENSOCKETFUNCTION, &Transfer::open_socket);
    set(CURLOPT_OPENSOCKETDATA, this);
    set(CURLOPT_FORBID_REUSE, 1L);
    set(CURLOPT_SSLVERSION, long{CURL_SSLVERSION_TLSv1_2});
    if (!config.ca_file.empty()) {
        set(CURLOPT_CAINFO, config.ca_file.c_str());
        set(CURLOPT_CAPATH, static_cast<const char*>(nullptr));
    }
    set(CURLOPT_TIMEOUT, long{config.try_seconds});
    set(CURLOPT_NOSIGNAL, 1L);
    // A name server that does not answer holds nobody up.
    set(CURLOPT_QUICK_EXIT, 1L);
    set(CURLOPT_USERAGENT, "modelsynthd");
    set(CURLOPT_HTTPHEADER, headers_.get());
    set(CURLOPT_POST, 1L);
    set(CURLOPT_POSTFIELDS, message_.body.data());
    set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(message_.body.size()));
    set(CURLOPT_WRITEFUNCTION, &Transfer::take_answer);
    set(CURLOPT_WRITEDATA, this);
    set(CURLOPT_HEADERFUNCTION, &Transfer::take_answer);
    set(CURLOPT_HEADERDATA, this);
}

curl_socket_t Transfer::open_socket(void* self, curlsocktype /*purpose*/, curl_sockaddr* address) {
    auto& transfer = *static_cast<Transfer*>(self);
    if (!transfer.may_be_private_ && !is_public(&address->addr)) {
        transfer.was_refused_ = true;
        return CURL_SOCKET_BAD;
    }
    return ::socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

std::size_t Transfer::take_answer(
    char* /*bytes*/, std::size_t size, std::size_t count, void* self
) {
    auto& transfer = *static_cast<Transfer*>(self);
    transfer.answer_bytes_ += size * count;
    return transfer.answer_bytes_ > kAnswerBytesMax ? 0 : size * count;
}

long Transfer::status() const {
    long status = 0;
    curl_easy_getinfo(handle_.get(), CURLINFO_RESPONSE_CODE, &status);
    return status;
}

std::optional<std::string> Transfer::retry_after() const {
    constexpr long kTooManyRequests = 429;
    constexpr long kUnavailable = 503;
    const long answered = status();
    if (answered != kTooManyRequests && answered != kUnavailable) {
        return std::nullopt;
    }
    constexpr int kLastAnswer = -1;
    curl_header* field = nullptr;
    const CURLHcode found =
        curl_easy_header(handle_.get(), "Retry-After", 0, CURLH_HEADER, kLastAnswer, &field);
    return found == CURLHE_OK ? std::optional<std::string>(field->value) : std::nullopt;
}

double Transfer::seconds() const {
    curl_off_t microseconds = 0;
    curl_easy_getinfo(handle_.get(), CURLINFO_TOTAL_TIME_T, &microseconds);
    return static_cast<double>(microseconds) / 1e6;
}

std::string Transfer::failure(CURLcode code) const {
    const long answered = status();
    // An answer that was cut off is one all the same.
    const bool is_answered = code == CURLE_OK || code == CURLE_WRITE_ERROR;
    if (is_answered && answered >= 200 && answered < 300) {
        return "";
    }
    if (is_answered && answered >= 200) {
        return "the receiver answered " + std::to_string(answered);
    }
    if (was_refused_ && code == CURLE_COULDNT_CONNECT) {
        return "the receiver's address is not public";
    }
    return curl_easy_strerror(code);
}

}  // namespace modelsynth::server
