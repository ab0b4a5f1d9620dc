#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace modelsynth::server {

// Bytes as a gzip file (RFC 1952), a piece at a time. The same bytes give the same file, however
// they are cut into pieces: its header tells no time and no name. One thread at a time.
class GzipWriter {
  public:
    GzipWriter();
    ~GzipWriter();

    GzipWriter(const GzipWriter&) = delete;
    GzipWriter& operator=(const GzipWriter&) = delete;

    void append(std::string_view piece);

    // The whole file. Nothing may be appended after it.
    [[nodiscard]] std::string finish();

  private:
    struct Stream;
    std::unique_ptr<Stream> stream_;
};

[[nodiscard]] std::string gzipped(std::string_view bytes);

}  // namespace modelsynth::server
