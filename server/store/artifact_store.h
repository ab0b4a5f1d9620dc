#pragma once

#include "server/store/types.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace modelsynth::server {

// Files by the SHA-256 of their content. Calls block.
class ArtifactStore {
  public:
    // Bytes of one artifact, readable as long as this lives, even when it is erased meanwhile.
    class Reader {
      public:
        virtual ~Reader() = default;
        [[nodiscard]] virtual std::uint64_t size() const = 0;
        // Fills the span from the offset. Fails: kCorrupt when the file is shorter.
        [[nodiscard]] virtual Stored<void> read(std::uint64_t offset, std::span<char> into) = 0;
    };

    // Keeps a stored artifact from being taken as unused until it is linked.
    class Pin {
      public:
        virtual ~Pin() = default;
        [[nodiscard]] virtual const std::string& digest() const = 0;
    };

    struct Space {
        std::uint64_t used_bytes = 0;  // by artifacts
        std::uint64_t free_bytes = 0;  // that may still be written where they are
    };

    virtual ~ArtifactStore() = default;

    // Cheap enough to ask for every request.
    [[nodiscard]] virtual Space space() const = 0;

    // On disk when it returns; the same bytes twice are one file.
    [[nodiscard]] virtual Stored<std::unique_ptr<Pin>> put(std::string_view bytes) = 0;

    // Keeps what is stored already. Fails: kNotFound.
    [[nodiscard]] virtual Stored<std::unique_ptr<Pin>> pin(const std::string& digest) = 0;

    [[nodiscard]] virtual Stored<std::unique_ptr<Reader>> open(const std::string& digest) = 0;

    // The whole content, checked against the digest. Fails: kNotFound, kCorrupt.
    [[nodiscard]] virtual Stored<std::string> load(const std::string& digest) = 0;
};

// Lower-case hex of the SHA-256.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

}  // namespace modelsynth::server
