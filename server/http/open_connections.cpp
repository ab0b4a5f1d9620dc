#include "server/http/open_connections.h"

#include <utility>

namespace modelsynth::server {

OpenConnections::Place::Place(OpenConnections& connections, boost::asio::ip::address address)
    : connections_(connections), address_(std::move(address)) {
    const std::lock_guard lock(connections_.mutex_);
    count_ = ++connections_.count_;
    count_of_address_ = ++connections_.of_address_[address_];
}

OpenConnections::Place::~Place() {
    const std::lock_guard lock(connections_.mutex_);
    --connections_.count_;
    const auto found = connections_.of_address_.find(address_);
    if (--found->second == 0) {
        connections_.of_address_.erase(found);
    }
}

std::size_t OpenConnections::count() const {
    const std::lock_guard lock(mutex_);
    return count_;
}

}  // namespace modelsynth::server
