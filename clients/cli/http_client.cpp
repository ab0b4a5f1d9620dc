// The one place that knows the HTTP library. Operations are started asynchronously and waited for
// one by one: the library's blocking calls know neither time limits nor interrupts.

#include "clients/cli/http_client.h"

#include "clients/cli/interrupt.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace modelsynth::cli {

namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace net = boost::asio;
using boost::system::error_code;
using std::chrono::seconds;

constexpr seconds kConnectMax{10};
// Bodies that no sink takes.
constexpr std::size_t kBodyBytesMax = std::size_t{256} << 20;

class Connection {
  public:
    // `context`: null without TLS.
    Connection(const ServerUrl& server, net::ssl::context* context) : server_(server) {
        if (context != nullptr) {
            tls_.emplace(stream_, *context);
        }
    }

    [[nodiscard]] error_code open() {
        error_code error;
        net::ip::tcp::resolver resolver(io_);
        const auto places = resolver.resolve(server_.host, server_.port, error);
        if (error) {
            return error;
        }
        error = wait(kConnectMax, [&](auto done) { stream_.async_connect(places, done); });
        return error || !tls_ ? error : shake_hands();
    }

    // Calls with the stream that requests and answers go over.
    template <class Use>
    void with_stream(const Use& use) {
        if (tls_) {
            use(*tls_);
        } else {
            use(stream_);
        }
    }

    // Starts an operation and waits for its end.
    template <class Start>
    [[nodiscard]] error_code wait(seconds idle_max, const Start& start) {
        std::optional<error_code> result;
        stream_.expires_after(idle_max);
        start([&result](error_code error, const auto&...) { result = error; });
        while (!result) {
            io_.restart();
            io_.run_one_for(std::chrono::milliseconds(50));
            if (is_interrupted()) {
                stream_.cancel();
            }
        }
        return *result;
    }

    beast::flat_buffer& buffer() { return buffer_; }

    [[nodiscard]] Failure failure(const std::string& what, const error_code& error) const {
        if (is_interrupted()) {
            return {ExitCode::kInterrupted, "interrupted"};
        }
        Failure failure{
            ExitCode::kUnreachable,
            what + " " + server_.scheme() + server_.authority() + server_.prefix + ": " +
                error.message()};
        failure.is_idle = error == beast::error::timeout;
        return failure;
    }

  private:
    [[nodiscard]] error_code shake_hands() {
        error_code is_name;
        static_cast<void>(net::ip::make_address(server_.host, is_name));
        if (is_name) {
            // As SSL_set_tlsext_host_name, whose cast is of C.
            SSL_ctrl(
                tls_->native_handle(),
                SSL_CTRL_SET_TLSEXT_HOSTNAME,
                TLSEXT_NAMETYPE_host_name,
                const_cast<char*>(server_.host.c_str())
            );
        }
        tls_->set_verify_callback(net::ssl::host_name_verification(server_.host));
        return wait(kConnectMax, [&](auto done) {
            tls_->async_handshake(net::ssl::stream_base::client, done);
        });
    }

    const ServerUrl& server_;
    net::io_context io_;
    beast::tcp_stream stream_{io_};
    std::optional<net::ssl::stream<beast::tcp_stream&>> tls_;
    beast::flat_buffer buffer_;
};

// Has servers checked against the roots in the file, or those of the system.
error_code trust(net::ssl::context& context, const std::string& ca_file) {
    error_code error;
    SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
    context.set_verify_mode(net::ssl::verify_peer, error);
    if (ca_file.empty()) {
        context.set_default_verify_paths(error);
    } else {
        context.load_verify_file(ca_file, error);
    }
    return error;
}

http::request<http::string_body> make_message(
    const HttpRequest& request, const ServerUrl& server, const std::string& key
) {
    http::request<http::string_body> message;
    message.version(11);
    message.method_string(request.method);
    message.target(server.prefix + request.target);
    message.set(http::field::host, server.authority());
    message.set(http::field::user_agent, "modelsynth/" MODELSYNTH_VERSION);
    message.set(http::field::connection, "close");
    if (!key.empty()) {
        message.set(http::field::authorization, "Bearer " + key);
    }
    if (!request.content_type.empty()) {
        message.set(http::field::content_type, request.content_type);
    }
    for (const auto& [name, value] : request.headers) {
        message.set(name, value);
    }
    message.body() = request.body;
    message.prepare_payload();
    return message;
}

// Piece by piece, so that the time limit is one for silence and not for the whole.
error_code write_message(
    Connection& connection, const http::request<http::string_body>& message, seconds idle_max
) {
    http::request_serializer<http::string_body> serializer(message);
    while (!serializer.is_done()) {
        const error_code error = connection.wait(idle_max, [&](auto done) {
            connection.with_stream([&](auto& stream) {
                http::async_write_some(stream, serializer, done);
            });
        });
        if (error) {
            return error;
        }
    }
    return {};
}

using Parser = http::response_parser<http::buffer_body>;

// Reads the body to its end, piece by piece.
error_code read_body(
    Connection& connection, Parser& parser, seconds idle_max, const BodySink& sink, bool& is_stopped
) {
    std::array<char, 65536> piece;
    while (!parser.is_done()) {
        auto& body = parser.get().body();
        body.data = piece.data();
        body.size = piece.size();
        const error_code error = connection.wait(idle_max, [&](auto done) {
            connection.with_stream([&](auto& stream) {
                http::async_read_some(stream, connection.buffer(), parser, done);
            });
        });
        const std::size_t count = piece.size() - body.size;
        if (count > 0 && !sink({piece.data(), count})) {
            is_stopped = true;
            return {};
        }
        if (error && error != http::error::need_buffer) {
            return error;
        }
    }
    return {};
}

}  // namespace

Outcome<HttpAnswer> HttpClient::send(const HttpRequest& request, const BodySink& sink) const {
    std::optional<net::ssl::context> context;
    if (server_.is_tls) {
        context.emplace(net::ssl::context::tls_client);
        if (const error_code error = trust(*context, ca_file_)) {
            return wrong_usage("cannot read the roots " + ca_file_ + ": " + error.message());
        }
    }
    Connection connection(server_, context ? &*context : nullptr);
    if (const error_code error = connection.open()) {
        return tl::unexpected(connection.failure("cannot reach", error));
    }
    const auto message = make_message(request, server_, key_);
    const error_code unsent = write_message(connection, message, request.idle_max);
    // A server that refuses a large body may answer and close before it has read all of it, so
    // that the answer is looked for even then.
    Parser parser;
    parser.body_limit(boost::none);
    const error_code unread = connection.wait(request.idle_max, [&](auto done) {
        connection.with_stream([&](auto& stream) {
            http::async_read_header(stream, connection.buffer(), parser, done);
        });
    });
    if (unread) {
        return tl::unexpected(connection.failure("no answer from", unsent ? unsent : unread));
    }
    HttpAnswer answer;
    answer.status = static_cast<int>(parser.get().result_int());
    const bool is_good = answer.status >= 200 && answer.status < 300;
    const BodySink collect = [&answer](std::string_view bytes) {
        answer.body += bytes;
        return answer.body.size() <= kBodyBytesMax;
    };
    bool is_stopped = false;
    const error_code broken = read_body(
        connection, parser, request.idle_max, is_good && sink ? sink : collect, is_stopped
    );
    if (broken) {
        return tl::unexpected(connection.failure("the connection broke to", broken));
    }
    if (is_stopped) {
        return tl::unexpected(Failure{ExitCode::kFailed, "the transfer was stopped"});
    }
    if (!is_good) {
        return tl::unexpected(failure_of_answer(answer.status, answer.body));
    }
    return answer;
}

}  // namespace modelsynth::cli
