#include "server/http/transport.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/associated_executor.hpp>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/tcp_stream.hpp>

#include <exception>
#include <type_traits>

namespace modelsynth::server {

namespace {

namespace beast = boost::beast;
using boost::system::error_code;
using net::ip::tcp;

constexpr auto kTransportToken = net::as_tuple(net::use_awaitable);
// For a WebSocket's client to end its side, once both have said so.
constexpr auto kTearDownMax = std::chrono::seconds(5);

class PlainLayers final : public Transport::Layers {
  public:
    explicit PlainLayers(tcp::socket socket) : stream_(std::move(socket)) {}

    tcp::socket& socket() override { return stream_.socket(); }

    void expires_after(std::chrono::nanoseconds time) override { stream_.expires_after(time); }

    void expires_never() override { stream_.expires_never(); }

    void read_some(const Transport::ReadPieces& pieces, Transport::Transferred done) override {
        stream_.async_read_some(pieces, std::move(done));
    }

    void read_raw(const Transport::ReadPieces& pieces, Transport::Transferred done) override {
        read_some(pieces, std::move(done));
    }

    void write_some(const Transport::WritePieces& pieces, Transport::Transferred done) override {
        stream_.async_write_some(pieces, std::move(done));
    }

    void shake_hands(Transport::Ended done) override { end(std::move(done)); }

    void say_end(Transport::Ended done) override { end(std::move(done)); }

  private:
    void end(Transport::Ended done) {
        net::post(stream_.get_executor(), [done = std::move(done)]() mutable {
            std::move(done)(error_code());
        });
    }

    beast::tcp_stream stream_;
};

class TlsLayers final : public Transport::Layers {
  public:
    TlsLayers(tcp::socket socket, net::ssl::context& context)
        : stream_(std::move(socket), context) {}

    tcp::socket& socket() override { return stream_.next_layer().socket(); }

    void expires_after(std::chrono::nanoseconds time) override {
        stream_.next_layer().expires_after(time);
    }

    void expires_never() override { stream_.next_layer().expires_never(); }

    void read_some(const Transport::ReadPieces& pieces, Transport::Transferred done) override {
        stream_.async_read_some(pieces, std::move(done));
    }

    void read_raw(const Transport::ReadPieces& pieces, Transport::Transferred done) override {
        stream_.next_layer().async_read_some(pieces, std::move(done));
    }

    void write_some(const Transport::WritePieces& pieces, Transport::Transferred done) override {
        stream_.async_write_some(pieces, std::move(done));
    }

    void shake_hands(Transport::Ended done) override {
        stream_.async_handshake(net::ssl::stream_base::server, std::move(done));
    }

    void say_end(Transport::Ended done) override { stream_.async_shutdown(std::move(done)); }

  private:
    net::ssl::stream<beast::tcp_stream> stream_;
};

// Operations of layers, to be awaited.
using TransportToken = std::decay_t<decltype(kTransportToken)>;

struct StartHandshake {
    template <class Handler>
    void operator()(Handler&& handler, Transport::Layers* layers) const {
        layers->shake_hands(
            Transport::erased<Transport::Ended>(std::forward<Handler>(handler), *layers)
        );
    }
};

struct StartEnd {
    template <class Handler>
    void operator()(Handler&& handler, Transport::Layers* layers) const {
        layers->say_end(Transport::erased<Transport::Ended>(std::forward<Handler>(handler), *layers)
        );
    }
};

struct StartRawRead {
    template <class Handler>
    void operator()(
        Handler&& handler, Transport::Layers* layers, const Transport::ReadPieces& pieces
    ) const {
        layers->read_raw(
            pieces,
            Transport::erased<Transport::Transferred>(std::forward<Handler>(handler), *layers)
        );
    }
};

template <class Start>
auto ended(Start start, Transport::Layers& layers) {
    return net::async_initiate<const TransportToken, void(error_code)>(
        start, kTransportToken, &layers
    );
}

auto read_raw(Transport::Layers& layers, net::mutable_buffer buffer) {
    return net::async_initiate<const TransportToken, void(error_code, std::size_t)>(
        StartRawRead(), kTransportToken, &layers, Transport::ReadPieces(buffer)
    );
}

void close_socket(Transport::Layers& layers) {
    error_code ignored;
    layers.socket().close(ignored);
}

// Keeps the layers until it is done, whoever had them.
net::awaitable<void> end_layers(
    std::shared_ptr<Transport::Layers> layers, std::chrono::seconds most, bool drain
) {
    constexpr int kReadsMax = 1024;
    layers->expires_after(most);
    // The answer to it is waited for as well; that it does not come is no fault.
    co_await ended(StartEnd(), *layers);
    error_code ignored;
    layers->socket().shutdown(tcp::socket::shutdown_send, ignored);
    std::array<char, 4096> rest = {};
    for (int i = 0; drain && i < kReadsMax; ++i) {
        const auto buffer = net::buffer(rest);
        auto [error, count] = co_await read_raw(*layers, buffer);
        if (error) {
            break;
        }
    }
    close_socket(*layers);
}

}  // namespace

Transport::Transport(tcp::socket socket)
    : layers_(std::make_shared<PlainLayers>(std::move(socket))) {}

Transport::Transport(tcp::socket socket, net::ssl::context& context)
    : layers_(std::make_shared<TlsLayers>(std::move(socket), context)) {}

net::awaitable<error_code> Transport::shake_hands(std::chrono::seconds most) {
    layers_->expires_after(most);
    auto [error] = co_await ended(StartHandshake(), *layers_);
    layers_->expires_never();
    co_return error;
}

net::awaitable<void> Transport::end(std::chrono::seconds most, bool drain) {
    return end_layers(layers_, most, drain);
}

net::awaitable<void> Transport::write_raw(std::string_view bytes) {
    const auto buffer = net::buffer(bytes.data(), bytes.size());
    co_await net::async_write(socket(), buffer, kTransportToken);
}

void Transport::close() { close_socket(*layers_); }

void Transport::tear_down(Ended done) {
    const auto executor = done.get_executor();
    auto tell = [done = std::move(done)](const std::exception_ptr&) mutable {
        std::move(done)(error_code());
    };
    net::co_spawn(
        get_executor(),
        end_layers(layers_, kTearDownMax, true),
        net::bind_executor(executor, std::move(tell))
    );
}

}  // namespace modelsynth::server
