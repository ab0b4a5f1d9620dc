#pragma once

#include <tl/expected.hpp>

#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace modelsynth::server {

// Signs messages as the Standard Webhooks specification says: HMAC-SHA256 over id, time and body.
// The secrets come from a file that may be read again; several of them, one a line, are all signed
// with, so that receivers can change over. Thread-safe.
class Signer {
  public:
    static constexpr std::size_t kSecretsMax = 4;

    // Nothing is read yet.
    explicit Signer(std::string file) : file_(std::move(file)) {}

    // Fails with what is wrong, never with what is secret; what was read before stays.
    [[nodiscard]] tl::expected<void, std::string> load();

    // The header webhook-signature. `seconds`: of the Unix epoch, as webhook-timestamp tells them.
    // Requires: load() succeeded once.
    [[nodiscard]] std::string sign(
        std::string_view id, std::string_view seconds, std::string_view body
    ) const;

  private:
    std::string file_;
    mutable std::mutex mutex_;
    std::vector<std::string> secrets_;  // as bytes; guarded by mutex_
};

}  // namespace modelsynth::server
