#include "server/access/tickets.h"

#include "server/store/artifact_store.h"

#include <openssl/rand.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace modelsynth::server {

namespace {

std::string random_text() {
    std::array<unsigned char, 32> bytes = {};
    if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
        throw std::runtime_error("the machine gives no random numbers");
    }
    return sha256_hex({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::optional<std::string> Tickets::give(Ticket ticket, Clock::time_point now) {
    std::string text = random_text();
    const std::lock_guard lock(mutex_);
    std::erase_if(given_, [now](const auto& entry) { return entry.second.until <= now; });
    if (given_.size() >= kCountMax) {
        return std::nullopt;
    }
    given_.emplace(text, Given{std::move(ticket), now + kLifetime});
    return text;
}

std::optional<Tickets::Ticket> Tickets::take(const std::string& text, Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    const auto found = given_.find(text);
    if (found == given_.end()) {
        return std::nullopt;
    }
    Given given = std::move(found->second);
    given_.erase(found);
    return given.until > now ? std::optional(std::move(given.ticket)) : std::nullopt;
}

}  // namespace modelsynth::server
