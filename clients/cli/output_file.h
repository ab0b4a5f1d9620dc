#pragma once

#include "clients/cli/failure.h"

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace modelsynth::cli {

// A file that appears whole or not at all: bytes go to FILE.part, which takes the name on
// commit() and is removed otherwise. "-" is standard output; what is there and is no regular
// file, such as a pipe, is written as it is.
class OutputFile {
  public:
    explicit OutputFile(std::string path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    // Whether the path can be written, as far as can be told without writing: for before long
    // work. Fails: kWrongUsage.
    [[nodiscard]] static Outcome<void> check(const std::string& path);

    // False: it failed, and commit() tells how.
    [[nodiscard]] bool write(std::string_view bytes);
    // Fails: kFailed.
    [[nodiscard]] Outcome<void> commit();

    [[nodiscard]] std::uint64_t bytes_written() const { return bytes_written_; }

    // False when write() failed.
    [[nodiscard]] bool is_good() const { return error_.empty(); }

  private:
    void open();
    void note_error();

    std::string path_;
    std::string part_;  // empty: written in place
    std::FILE* file_ = nullptr;
    std::uint64_t bytes_written_ = 0;
    std::string error_;
};

// The file for one of several models: castle.glb for the first, castle-1.glb for the next.
[[nodiscard]] std::string numbered_file(const std::string& path, std::uint32_t number);

}  // namespace modelsynth::cli
