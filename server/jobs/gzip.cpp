#include "server/jobs/gzip.h"

#include "solver/core/result.h"

#define ZLIB_CONST
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <utility>

namespace modelsynth::server {

struct GzipWriter::Stream {
    z_stream state = {};
    std::string file;

    // Compresses what the state has been given.
    void run(int flush) {
        std::array<Bytef, 64 * 1024> piece;
        do {
            state.next_out = piece.data();
            state.avail_out = static_cast<uInt>(piece.size());
            check(deflate(&state, flush) != Z_STREAM_ERROR, "zlib's stream is sound");
            const auto* bytes = reinterpret_cast<const char*>(piece.data());
            file.append(bytes, piece.size() - state.avail_out);
        } while (state.avail_out == 0);
    }
};

GzipWriter::GzipWriter() : stream_(std::make_unique<Stream>()) {
    constexpr int kGzipWindow = 15 + 16;  // 16 asks for a gzip header instead of zlib's own
    constexpr int kMemoryLevel = 8;       // zlib's default
    if (deflateInit2(
            &stream_->state,
            Z_DEFAULT_COMPRESSION,
            Z_DEFLATED,
            kGzipWindow,
            kMemoryLevel,
            Z_DEFAULT_STRATEGY
        ) != Z_OK) {
        throw std::bad_alloc();
    }
}

GzipWriter::~GzipWriter() { deflateEnd(&stream_->state); }

void GzipWriter::append(std::string_view piece) {
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    while (!piece.empty()) {
        const std::string_view part = piece.substr(0, kMost);
        stream_->state.next_in = reinterpret_cast<const Bytef*>(part.data());
        stream_->state.avail_in = static_cast<uInt>(part.size());
        stream_->run(Z_NO_FLUSH);
        piece.remove_prefix(part.size());
    }
}

std::string GzipWriter::finish() {
    stream_->run(Z_FINISH);
    return std::move(stream_->file);
}

std::string gzipped(std::string_view bytes) {
    GzipWriter writer;
    writer.append(bytes);
    return writer.finish();
}

}  // namespace modelsynth::server
