#pragma once

#include <boost/asio/ip/address.hpp>

#include <cstddef>
#include <map>
#include <mutex>

namespace modelsynth::server {

// How many connections are open, in all and of each address. Thread-safe.
class OpenConnections {
  public:
    // One of them, as long as this lives.
    class Place {
      public:
        Place(OpenConnections& connections, boost::asio::ip::address address);
        ~Place();

        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;

        // When this came, itself included.
        [[nodiscard]] std::size_t count() const { return count_; }

        [[nodiscard]] std::size_t count_of_address() const { return count_of_address_; }

      private:
        OpenConnections& connections_;
        boost::asio::ip::address address_;
        std::size_t count_ = 0;
        std::size_t count_of_address_ = 0;
    };

    [[nodiscard]] std::size_t count() const;

  private:
    mutable std::mutex mutex_;
    std::size_t count_ = 0;
    std::map<boost::asio::ip::address, std::size_t> of_address_;
};

}  // namespace modelsynth::server
