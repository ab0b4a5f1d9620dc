#include "server/webhooks/webhook_sender.h"

#include "proto/job.h"
#include "server/log/event_line.h"
#include "server/webhooks/retry_after.h"
#include "server/webhooks/retry_pauses.h"
#include "server/webhooks/transfer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <map>
#include <new>
#include <optional>
#include <thread>
#include <utility>

namespace modelsynth::server {

namespace {

using proto::UnixMillis;
namespace level = spdlog::level;

// The store is looked at so often even when nothing tells of news.
constexpr UnixMillis kLookIntervalMs = 5'000;
// So long nothing is begun when the store does not take what became of the last.
constexpr UnixMillis kStoreTroubleMs = 30'000;
constexpr UnixMillis kPartingMs = 1'000;

// A receiver's answer ends its tries for good.
constexpr long kGone = 410;

std::string message_body(const proto::Job& job) {
    return "{\"type\":\"job." + std::string(proto::state_name(job.state)) +
           "\",\"job\":" + proto::to_json(job) + "}";
}

}  // namespace

class WebhookSender::Loop {
  public:
    Loop(
        const WebhookConfig& config,
        JobStore& jobs,
        DeliveryStore& deliveries,
        WebhookObserver& observer,
        std::shared_ptr<spdlog::logger> log
    )
        : config_(config),
          jobs_(jobs),
          deliveries_(deliveries),
          observer_(observer),
          log_(std::move(log)),
          pauses_(config, random_fractions()),
          signer_(config.secret_file) {
        if (curl_global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK || !multi_) {
            throw std::bad_alloc();
        }
    }

    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    ~Loop() {
        deliveries_.on_delivery(nullptr);
        stopping_ = true;
        curl_multi_wakeup(multi_.get());
        if (thread_.joinable()) {
            thread_.join();
        }
        for (const auto& [id, transfer] : in_flight_) {
            curl_multi_remove_handle(multi_.get(), transfer->handle());
        }
    }

    Signer& signer() { return signer_; }

    void start() {
        deliveries_.on_delivery([this] {
            has_news_ = true;
            curl_multi_wakeup(multi_.get());
        });
        thread_ = std::thread([this] { run(); });
    }

  private:
    void run() {
        // A receiver that is gone is told of by the write that fails.
        sigset_t pipe;
        sigemptyset(&pipe);
        sigaddset(&pipe, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
        while (!stopping_) {
            turn([this] { begin_what_is_due(); });
        }
        const UnixMillis until = proto::now_millis() + kPartingMs;
        while (!in_flight_.empty() && proto::now_millis() < until) {
            turn([] {});
        }
    }

    template <class Begin>
    void turn(const Begin& begin) {
        try {
            begin();
            int running = 0;
            curl_multi_perform(multi_.get(), &running);
            take_what_ended();
        } catch (const std::exception& error) {
            const std::string what = error.what();
            log_event(*log_, level::err, "webhooks pause", {{"what", what}});
            trouble_until_ = proto::now_millis() + kStoreTroubleMs;
        }
        const UnixMillis pause = std::clamp<UnixMillis>(look_at_ - proto::now_millis(), 0, 1000);
        const bool has_work = has_news_ && can_begin();
        curl_multi_poll(
            multi_.get(), nullptr, 0, has_work || stopping_ ? 10 : static_cast<int>(pause), nullptr
        );
    }

    [[nodiscard]] bool can_begin() const {
        return in_flight_.size() < config_.in_flight_max && proto::now_millis() >= trouble_until_;
    }

    void begin_what_is_due() {
        const UnixMillis now = proto::now_millis();
        if (!can_begin() || (now < look_at_ && !has_news_)) {
            return;
        }
        has_news_ = false;
        look_at_ = now + kLookIntervalMs;
        // Those on their way are among what is due.
        const auto due =
            deliveries_.due_deliveries(now, config_.per_receiver_max, 2 * config_.in_flight_max);
        if (!due) {
            return;
        }
        if (due->next) {
            look_at_ = std::min(look_at_, *due->next);
        }
        for (const Delivery& delivery : due->items) {
            const auto to_receiver = static_cast<std::size_t>(std::count_if(
                in_flight_.begin(),
                in_flight_.end(),
                [&delivery](const auto& entry) {
                    return entry.second->delivery().receiver == delivery.receiver;
                }
            ));
            if (can_begin() && to_receiver < config_.per_receiver_max &&
                !in_flight_.contains(delivery.job_id)) {
                begin(delivery, now);
            }
        }
    }

    void begin(const Delivery& delivery, UnixMillis now) {
        const auto job = jobs_.find(delivery.job_id);
        if (!job) {
            return;  // erased meanwhile, and the delivery with it; or the next look finds it
        }
        Transfer::Message message;
        message.id = "msg_" + job->id;
        message.timestamp = std::to_string(now / 1000);
        message.body = message_body(*job);
        message.signature = signer_.sign(message.id, message.timestamp, message.body);
        auto transfer = std::make_unique<Transfer>(config_, delivery, std::move(message));
        if (curl_multi_add_handle(multi_.get(), transfer->handle()) == CURLM_OK) {
            in_flight_.emplace(delivery.job_id, std::move(transfer));
        }
    }

    void take_what_ended() {
        int left = 0;
        while (const CURLMsg* message = curl_multi_info_read(multi_.get(), &left)) {
            if (message->msg != CURLMSG_DONE) {
                continue;
            }
            const CURLcode code = message->data.result;
            char* ended = nullptr;
            curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &ended);
            curl_multi_remove_handle(multi_.get(), message->easy_handle);
            const auto at =
                in_flight_.find(reinterpret_cast<const Transfer*>(ended)->delivery().job_id);
            const auto transfer = std::move(at->second);
            in_flight_.erase(at);
            has_news_ = true;  // there is room for another one
            settle(*transfer, code);
        }
    }

    void settle(const Transfer& transfer, CURLcode code) {
        const std::string& id = transfer.delivery().job_id;
        const std::uint32_t tries = transfer.delivery().tries + 1;
        const std::string failure = transfer.failure(code);
        const bool is_last = tries >= config_.tries_max || transfer.status() == kGone;
        const char* outcome = "delivered";
        Stored<void> kept;
        if (failure.empty()) {
            kept = deliveries_.drop_delivery(id);
            log_event(*log_, level::info, "webhook delivered", {{"job", id}, {"try", tries}});
        } else if (is_last) {
            outcome = "given-up";
            kept = deliveries_.drop_delivery(id);
            log_event(
                *log_,
                level::warn,
                "webhook given up",
                {{"job", id}, {"try", tries}, {"why", failure}}
            );
        } else {
            outcome = "retried";
            const UnixMillis pause = pause_after(transfer, tries);
            kept = deliveries_.postpone_delivery(id, tries, proto::now_millis() + pause);
            log_event(
                *log_,
                level::info,
                "webhook failed",
                {{"job", id}, {"try", tries}, {"why", failure}, {"pause_ms", pause}}
            );
        }
        observer_.on_try(kept ? outcome : "retried", transfer.seconds());
        if (!kept) {
            trouble_until_ = proto::now_millis() + kStoreTroubleMs;
            const std::string& why = kept.error().message;
            log_event(*log_, level::err, "webhook is sent again", {{"job", id}, {"why", why}});
        }
    }

    UnixMillis pause_after(const Transfer& transfer, std::uint32_t tries) {
        const auto field = transfer.retry_after();
        return pauses_.after(
            tries, field ? parse_retry_after(*field, proto::now_millis()) : std::nullopt
        );
    }

    WebhookConfig config_;
    JobStore& jobs_;
    DeliveryStore& deliveries_;
    WebhookObserver& observer_;
    std::shared_ptr<spdlog::logger> log_;
    RetryPauses pauses_;  // the loop's thread alone uses it
    Signer signer_;
    std::unique_ptr<CURLM, decltype(&curl_multi_cleanup)> multi_{
        curl_multi_init(), &curl_multi_cleanup};
    std::atomic<bool> stopping_ = false;
    std::atomic<bool> has_news_ = true;
    // The loop's thread alone uses these.
    std::map<std::string, std::unique_ptr<Transfer>> in_flight_;  // by job
    UnixMillis look_at_ = 0;
    UnixMillis trouble_until_ = 0;
    std::thread thread_;
};

WebhookSender::WebhookSender(
    const WebhookConfig& config,
    JobStore& jobs,
    DeliveryStore& deliveries,
    WebhookObserver& observer,
    std::shared_ptr<spdlog::logger> log
)
    : loop_(std::make_unique<Loop>(config, jobs, deliveries, observer, std::move(log))) {}

WebhookSender::~WebhookSender() = default;

tl::expected<void, std::string> WebhookSender::load_secrets() { return loop_->signer().load(); }

void WebhookSender::start() { loop_->start(); }

}  // namespace modelsynth::server
