#include "server/access/key_ring.h"

#include "server/store/artifact_store.h"

#include <openssl/crypto.h>

#include <fstream>
#include <iterator>
#include <utility>

namespace modelsynth::server {

tl::expected<KeyRing, std::string> KeyRing::load(const std::string& path) {
    constexpr std::streamsize kBytesMax = 16 << 20;
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file || file.tellg() < 0) {
        return tl::unexpected("the file of keys " + path + " cannot be read");
    }
    if (file.tellg() > kBytesMax) {
        return tl::unexpected("the file of keys " + path + " has more than 16 MiB");
    }
    file.seekg(0);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    auto keys = proto::parse_keys(text);
    if (!keys) {
        std::string why = "the file of keys " + path + ": " + keys.error().detail;
        for (const Fault& fault : keys.error().errors) {
            why += "; " + fault.pointer + " " + fault.detail;
        }
        return tl::unexpected(std::move(why));
    }
    return KeyRing(std::move(*keys));
}

KeyRing::KeyRing(std::vector<proto::KeyEntry> keys) : keys_(std::move(keys)) {}

const proto::KeyEntry* KeyRing::find(std::string_view secret) const {
    const std::string digest = sha256_hex(secret);
    const proto::KeyEntry* found = nullptr;
    for (const proto::KeyEntry& key : keys_) {
        // A comparison that ends early would tell how much of a digest was guessed.
        if (CRYPTO_memcmp(key.sha256.data(), digest.data(), digest.size()) == 0) {
            found = &key;
        }
    }
    return found;
}

}  // namespace modelsynth::server
