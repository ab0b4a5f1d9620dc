#include "server/jobs/ids.h"

#include "proto/limits.h"

#include <chrono>
#include <mutex>
#include <random>

namespace modelsynth::server {

namespace {

// The machine's own randomness; only what no result depends on comes from here.
std::uint64_t random_bits() {
    static std::mutex mutex;
    static std::random_device device;
    const std::lock_guard lock(mutex);
    const std::uint64_t high = device();
    return high << 32 | device();
}

// Crockford's base 32, whose digits sort as their values do.
void append_base32(std::string& text, std::uint64_t value, int digits) {
    static constexpr const char* kDigits = "0123456789abcdefghjkmnpqrstvwxyz";
    for (int shift = 5 * (digits - 1); shift >= 0; shift -= 5) {
        text += kDigits[value >> shift & 31];
    }
}

}  // namespace

std::string make_job_id(proto::UnixMillis now) {
    static std::mutex mutex;
    static proto::UnixMillis last = 0;
    static std::uint64_t counter = 0;
    std::uint64_t count = 0;
    {
        const std::lock_guard lock(mutex);
        // Ids of one millisecond are told apart by a counter, so that they sort as they came;
        // a clock that goes back does not make ids go back.
        counter = now > last ? 0 : counter + 1;
        last = std::max(last, now);
        now = last;
        count = counter;
    }
    std::string id;
    append_base32(id, static_cast<std::uint64_t>(now), 10);
    append_base32(id, count, 4);
    append_base32(id, random_bits(), 12);
    return id;
}

std::uint64_t make_seed() { return random_bits() & proto::kSeedMax; }

}  // namespace modelsynth::server
