#pragma once

#include "server/store/types.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace modelsynth::server {

// A message that is to be sent about the end of a job.
struct Delivery {
    std::string job_id;
    std::string url;
    std::string receiver;     // scheme, host and port of the URL
    std::uint32_t tries = 0;  // so far
};

struct DueDeliveries {
    std::vector<Delivery> items;            // longest due first
    std::optional<proto::UnixMillis> next;  // when the next of the others is due
};

// What is to be sent when jobs with a webhook end: it appears in the commit that ends the job, and
// goes with the job when that is erased. All calls but the last block; thread-safe.
class DeliveryStore {
  public:
    virtual ~DeliveryStore() = default;

    // At most `limit` that are due, and `per_receiver_max` to each receiver. They stay as they are.
    [[nodiscard]] virtual Stored<DueDeliveries> due_deliveries(
        proto::UnixMillis now, std::size_t per_receiver_max, std::size_t limit
    ) = 0;

    // How many there are, due or not.
    [[nodiscard]] virtual Stored<std::size_t> delivery_count() = 0;

    // It was tried so often and is due again then.
    [[nodiscard]] virtual Stored<void> postpone_delivery(
        const std::string& job_id, std::uint32_t tries, proto::UnixMillis due
    ) = 0;

    // It has arrived, or is given up.
    [[nodiscard]] virtual Stored<void> drop_delivery(const std::string& job_id) = 0;

    // Told, on the store's thread, that there is another one; must not call into the store. Nothing
    // ends it.
    virtual void on_delivery(std::function<void()> told) = 0;
};

}  // namespace modelsynth::server
