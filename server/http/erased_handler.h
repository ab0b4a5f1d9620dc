#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/associated_cancellation_slot.hpp>
#include <boost/asio/associated_executor.hpp>

#include <memory>
#include <utility>

namespace modelsynth::server {

namespace net = boost::asio;

// A completion handler of any type, with its executor and its cancellation slot; called once.
// Asio's own in Boost 1.81, any_completion_handler, has an executor that Beast cannot post to.
template <class... Args>
class ErasedHandler {
  public:
    using executor_type = net::any_io_executor;
    using cancellation_slot_type = net::cancellation_slot;

    // `executor` is for a handler that has none of its own.
    template <class Handler>
    ErasedHandler(Handler handler, const executor_type& executor)
        : executor_(net::get_associated_executor(handler, executor)),
          slot_(net::get_associated_cancellation_slot(handler)),
          held_(std::make_unique<HeldAs<Handler>>(std::move(handler))) {}

    [[nodiscard]] executor_type get_executor() const noexcept { return executor_; }

    [[nodiscard]] cancellation_slot_type get_cancellation_slot() const noexcept { return slot_; }

    void operator()(Args... args) {
        const auto held = std::move(held_);
        held->call(args...);
    }

  private:
    struct Held {
        virtual ~Held() = default;
        virtual void call(Args... args) = 0;
    };

    template <class Handler>
    struct HeldAs final : Held {
        explicit HeldAs(Handler given) : handler(std::move(given)) {}

        void call(Args... args) override { std::move(handler)(args...); }

        Handler handler;
    };

    executor_type executor_;
    cancellation_slot_type slot_;
    std::unique_ptr<Held> held_;
};

}  // namespace modelsynth::server
