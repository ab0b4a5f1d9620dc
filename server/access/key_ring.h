#pragma once

#include "proto/key_codec.h"

#include <tl/expected.hpp>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace modelsynth::server {

// The keys of a file, found by what a request carries. Does not change.
class KeyRing {
  public:
    // Fails: what is wrong with the file, with the place.
    [[nodiscard]] static tl::expected<KeyRing, std::string> load(const std::string& path);

    explicit KeyRing(std::vector<proto::KeyEntry> keys);

    // The entry of a key, or null. Takes as long whichever it is, and when it is none.
    [[nodiscard]] const proto::KeyEntry* find(std::string_view secret) const;

  private:
    std::vector<proto::KeyEntry> keys_;
};

}  // namespace modelsynth::server
