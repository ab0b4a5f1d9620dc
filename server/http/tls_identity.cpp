#include "server/http/tls_identity.h"

#include <boost/asio/ssl/error.hpp>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509err.h>

#include <string_view>
#include <system_error>

namespace modelsynth::server {

namespace {

namespace ssl = boost::asio::ssl;

// Of TLS 1.2, those with forward secrecy and authenticated encryption; 1.3 has no others.
constexpr const char* kCiphers =
    "ECDHE-ECDSA-AES128-GCM-SHA256:ECDHE-RSA-AES128-GCM-SHA256:ECDHE-ECDSA-AES256-GCM-SHA384:"
    "ECDHE-RSA-AES256-GCM-SHA384:ECDHE-ECDSA-CHACHA20-POLY1305:ECDHE-RSA-CHACHA20-POLY1305";

// What went wrong first within OpenSSL.
std::string reason() {
    const unsigned long code = ERR_peek_error();
    if (ERR_SYSTEM_ERROR(code)) {
        return std::generic_category().message(ERR_GET_REASON(code));
    }
    const char* text = ERR_reason_error_string(code);
    return text == nullptr ? "it cannot be read" : text;
}

// A passphrase is not asked for: nobody sits there.
int no_passphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return -1; }

// A client that offers protocols and not this one is told so, rather than served something else.
int choose_protocol(
    SSL* /*connection*/,
    const unsigned char** chosen,
    unsigned char* chosen_size,
    const unsigned char* offered,
    unsigned int offered_size,
    void* /*data*/
) {
    constexpr std::string_view kProtocol = "http/1.1";
    for (unsigned int at = 0; at < offered_size; at += 1U + offered[at]) {
        const std::string_view name(reinterpret_cast<const char*>(offered) + at + 1, offered[at]);
        if (name == kProtocol) {
            *chosen = offered + at + 1;
            *chosen_size = offered[at];
            return SSL_TLSEXT_ERR_OK;
        }
    }
    return SSL_TLSEXT_ERR_ALERT_FATAL;
}

tl::expected<std::shared_ptr<ssl::context>, std::string> read_context(const TlsFiles& files) {
    auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
    SSL_CTX* native = context->native_handle();
    SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
    SSL_CTX_set_cipher_list(native, kCiphers);
    SSL_CTX_set_options(native, SSL_OP_NO_RENEGOTIATION);
    // Clients keep what resumes a session themselves, and idle connections no buffers.
    SSL_CTX_set_session_cache_mode(native, SSL_SESS_CACHE_OFF);
    SSL_CTX_set_mode(native, SSL_MODE_RELEASE_BUFFERS);
    SSL_CTX_set_alpn_select_cb(native, choose_protocol, nullptr);
    SSL_CTX_set_default_passwd_cb(native, no_passphrase);
    ERR_clear_error();
    if (SSL_CTX_use_certificate_chain_file(native, files.certificate.c_str()) != 1) {
        return tl::unexpected("the TLS certificate " + files.certificate + ": " + reason());
    }
    ERR_clear_error();
    if (SSL_CTX_use_PrivateKey_file(native, files.key.c_str(), SSL_FILETYPE_PEM) != 1) {
        const int why = ERR_GET_REASON(ERR_peek_last_error());
        if (why == X509_R_KEY_VALUES_MISMATCH || why == X509_R_KEY_TYPE_MISMATCH) {
            return tl::unexpected(
                "the TLS key " + files.key + " does not fit the certificate " + files.certificate
            );
        }
        return tl::unexpected("the TLS key " + files.key + ": " + reason());
    }
    return context;
}

}  // namespace

tl::expected<void, std::string> TlsIdentity::load() {
    if (!is_on()) {
        return {};
    }
    auto context = read_context(files_);
    // What OpenSSL notes of errors is the thread's, and would be taken for one of the next call.
    ERR_clear_error();
    if (!context) {
        return tl::unexpected(std::move(context.error()));
    }
    const std::lock_guard lock(mutex_);
    context_ = std::move(*context);
    return {};
}

std::shared_ptr<ssl::context> TlsIdentity::context() const {
    const std::lock_guard lock(mutex_);
    return context_;
}

bool is_plain_http(const boost::system::error_code& error) {
    return error.category() == boost::asio::error::get_ssl_category() &&
           ERR_GET_REASON(static_cast<unsigned long>(error.value())) == SSL_R_HTTP_REQUEST;
}

}  // namespace modelsynth::server
