#include "server/webhooks/signing.h"

#include "proto/base64.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>
#include <fstream>
#include <optional>
#include <sstream>

namespace modelsynth::server {

namespace {

constexpr std::string_view kPrefix = "whsec_";
// What the specification asks for.
constexpr std::size_t kSecretBytesMin = 24;
constexpr std::size_t kSecretBytesMax = 64;
constexpr std::size_t kFileBytesMax = 4096;

std::optional<std::string> read_secret(std::string_view line) {
    if (!line.starts_with(kPrefix)) {
        return std::nullopt;
    }
    const auto bytes = proto::decode_base64(line.substr(kPrefix.size()));
    if (!bytes || bytes->size() < kSecretBytesMin || bytes->size() > kSecretBytesMax) {
        return std::nullopt;
    }
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

tl::expected<std::vector<std::string>, std::string> read_secrets(const std::string& path) {
    const std::string name = "the file of the webhook secret " + path;
    std::ifstream file(path, std::ios::binary);
    std::string text(kFileBytesMax + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (file.bad() || text.empty()) {
        return tl::unexpected(name + " is empty or cannot be read");
    }
    if (text.size() > kFileBytesMax) {
        return tl::unexpected(name + " has more than " + std::to_string(kFileBytesMax) + " bytes");
    }
    std::vector<std::string> secrets;
    std::istringstream lines(text);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (line.ends_with('\r')) {
            line.pop_back();
        }
        if (line.empty()) {
            continue;
        }
        auto secret = read_secret(line);
        if (!secret) {
            return tl::unexpected(
                name + ", line " + std::to_string(number) +
                ": must be whsec_ and 24 to 64 bytes in base64"
            );
        }
        secrets.push_back(std::move(*secret));
    }
    if (secrets.empty() || secrets.size() > Signer::kSecretsMax) {
        return tl::unexpected(
            name + " must hold 1 to " + std::to_string(Signer::kSecretsMax) + " secrets"
        );
    }
    return secrets;
}

std::string hmac_sha256(const std::string& secret, const std::string& text) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest = {};
    unsigned int size = 0;
    HMAC(
        EVP_sha256(),
        secret.data(),
        static_cast<int>(secret.size()),
        reinterpret_cast<const unsigned char*>(text.data()),
        text.size(),
        digest.data(),
        &size
    );
    return {reinterpret_cast<const char*>(digest.data()), size};
}

}  // namespace

tl::expected<void, std::string> Signer::load() {
    auto secrets = read_secrets(file_);
    if (!secrets) {
        return tl::unexpected(std::move(secrets.error()));
    }
    const std::lock_guard lock(mutex_);
    secrets_ = std::move(*secrets);
    return {};
}

std::string Signer::sign(std::string_view id, std::string_view seconds, std::string_view body)
    const {
    std::string text;
    text.reserve(id.size() + seconds.size() + body.size() + 2);
    text.append(id).append(".").append(seconds).append(".").append(body);
    std::string header;
    const std::lock_guard lock(mutex_);
    for (const std::string& secret : secrets_) {
        header +=
            (header.empty() ? "v1," : " v1,") + proto::encode_base64(hmac_sha256(secret, text));
    }
    return header;
}

}  // namespace modelsynth::server
