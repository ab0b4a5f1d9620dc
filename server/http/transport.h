#pragma once

#include "server/http/erased_handler.h"

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/system/error_code.hpp>

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

namespace modelsynth::server {

// What a connection reads from and writes to: TCP as it is or TLS over it, behind one type, so that
// what is made of templates for a stream is compiled once. An AsyncReadStream and AsyncWriteStream
// of Asio; one read and one write at a time. Runs on the socket's strand.
class Transport {
  public:
    using executor_type = net::any_io_executor;
    using Transferred = ErasedHandler<boost::system::error_code, std::size_t>;
    using Ended = ErasedHandler<boost::system::error_code>;

    // The buffers of one operation. What is left out of a longer sequence is left to the next one.
    template <class Buffer>
    struct Pieces {
        std::array<Buffer, 8> buffers;
        std::size_t count = 0;

        template <class Sequence>
        explicit Pieces(const Sequence& sequence) {
            const auto end = net::buffer_sequence_end(sequence);
            for (auto at = net::buffer_sequence_begin(sequence); at != end; ++at) {
                const Buffer buffer(*at);
                if (buffer.size() > 0 && count < buffers.size()) {
                    buffers[count++] = buffer;
                }
            }
        }

        // As a sequence.
        [[nodiscard]] const Buffer* begin() const { return buffers.data(); }

        [[nodiscard]] const Buffer* end() const { return buffers.data() + count; }

        using value_type = Buffer;
        using const_iterator = const Buffer*;
    };

    using ReadPieces = Pieces<net::mutable_buffer>;
    using WritePieces = Pieces<net::const_buffer>;

    // One kind of stream.
    class Layers {
      public:
        virtual ~Layers() = default;
        virtual net::ip::tcp::socket& socket() = 0;
        virtual void expires_after(std::chrono::nanoseconds time) = 0;
        virtual void expires_never() = 0;
        virtual void read_some(const ReadPieces& pieces, Transferred done) = 0;
        // Of TCP, past TLS.
        virtual void read_raw(const ReadPieces& pieces, Transferred done) = 0;
        virtual void write_some(const WritePieces& pieces, Transferred done) = 0;
        virtual void shake_hands(Ended done) = 0;
        virtual void say_end(Ended done) = 0;
    };

    template <class Erased, class Handler>
    static Erased erased(Handler&& handler, Layers& layers) {
        return {std::forward<Handler>(handler), layers.socket().get_executor()};
    }

    // Plain TCP.
    explicit Transport(net::ip::tcp::socket socket);
    // TLS, as the server. The context may go once this is made.
    Transport(net::ip::tcp::socket socket, net::ssl::context& context);

    [[nodiscard]] executor_type get_executor() noexcept { return layers_->socket().get_executor(); }

    // The socket below, to look at and to set options of.
    [[nodiscard]] net::ip::tcp::socket& socket() { return layers_->socket(); }

    // When what is begun from now on and has not ended by then ends with beast::error::timeout, and
    // the socket is closed.
    void expires_after(std::chrono::nanoseconds time) { layers_->expires_after(time); }

    void expires_never() { layers_->expires_never(); }

    // Of TLS, before anything else; does nothing on plain TCP.
    [[nodiscard]] net::awaitable<boost::system::error_code> shake_hands(std::chrono::seconds most);

    // Tells the client that nothing more comes. `drain`: then reads what the client still sends, so
    // that it is not reset before it has read what was sent to it. Closes.
    [[nodiscard]] net::awaitable<void> end(std::chrono::seconds most, bool drain);

    // Writes past TLS, to a client that does not speak it.
    [[nodiscard]] net::awaitable<void> write_raw(std::string_view bytes);

    // At once.
    void close();

    template <class Sequence, class Token>
    auto async_read_some(const Sequence& sequence, Token&& token) {
        return net::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
            StartRead(), token, layers_.get(), ReadPieces(sequence)
        );
    }

    template <class Sequence, class Token>
    auto async_write_some(const Sequence& sequence, Token&& token) {
        return net::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
            StartWrite(), token, layers_.get(), WritePieces(sequence)
        );
    }

    // For beast::websocket::stream, when both sides have said goodbye.
    void tear_down(Ended done);

  private:
    // Objects of their own rather than lambdas, which gcc 12 destroys twice where they capture.
    struct StartRead {
        template <class Handler>
        void operator()(Handler&& handler, Layers* layers, const ReadPieces& pieces) const {
            layers->read_some(pieces, erased<Transferred>(std::forward<Handler>(handler), *layers));
        }
    };

    struct StartWrite {
        template <class Handler>
        void operator()(Handler&& handler, Layers* layers, const WritePieces& pieces) const {
            layers->write_some(
                pieces, erased<Transferred>(std::forward<Handler>(handler), *layers)
            );
        }
    };

    std::shared_ptr<Layers> layers_;
};

// What beast::websocket::stream calls of its transport.
inline void beast_close_socket(Transport& transport) { transport.close(); }

template <class Handler>
void async_teardown(boost::beast::role_type /*role*/, Transport& transport, Handler&& handler) {
    transport.tear_down({std::forward<Handler>(handler), transport.get_executor()});
}

}  // namespace modelsynth::server
