#pragma once

#include <boost/asio/ssl/context.hpp>
#include <boost/system/error_code.hpp>
#include <tl/expected.hpp>

#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace modelsynth::server {

// PEM files; both or neither.
struct TlsFiles {
    std::string certificate;  // the server's own first, then those that lead to a root
    std::string key;          // without a passphrase
};

// Who the server is towards clients of TLS: a certificate with its key, which may be replaced while
// the server runs. TLS 1.2 with forward secrecy and 1.3; ALPN http/1.1. Thread-safe.
class TlsIdentity {
  public:
    // Nothing is read yet.
    explicit TlsIdentity(TlsFiles files) : files_(std::move(files)) {}

    // Whether there is TLS at all.
    [[nodiscard]] bool is_on() const { return !files_.certificate.empty(); }

    // Reads the files, also again; connections that are there keep what they have. Fails with what
    // is wrong, and what was read before stays.
    [[nodiscard]] tl::expected<void, std::string> load();

    // For a new connection; null without TLS. Requires: load() succeeded once.
    [[nodiscard]] std::shared_ptr<boost::asio::ssl::context> context() const;

  private:
    TlsFiles files_;
    mutable std::mutex mutex_;
    std::shared_ptr<boost::asio::ssl::context> context_;  // guarded by mutex_
};

// Whether a handshake failed because the client spoke HTTP without TLS.
[[nodiscard]] bool is_plain_http(const boost::system::error_code& error);

}  // namespace modelsynth::server
