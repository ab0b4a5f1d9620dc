#include "clients/cli/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace modelsynth::cli {

namespace {

namespace fs = std::filesystem;

bool is_in_place(const std::string& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    return path == "-" || (fs::exists(status) && !fs::is_regular_file(status));
}

// Where a link leads: it is the file that is replaced, not the link.
std::string resolve(const std::string& path) {
    std::error_code error;
    const fs::path target = fs::weakly_canonical(path, error);
    return error ? path : target.string();
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
    if (!is_in_place(path_)) {
        path_ = resolve(path_);
        part_ = path_ + ".part";
    }
}

OutputFile::~OutputFile() {
    if (file_ != nullptr && file_ != stdout) {
        std::fclose(file_);
        if (!part_.empty()) {
            std::remove(part_.c_str());
        }
    }
}

Outcome<void> OutputFile::check(const std::string& path) {
    std::error_code error;
    if (path == "-") {
        return {};
    }
    if (path.empty() || path.ends_with('/') || fs::is_directory(path, error)) {
        return wrong_usage("\"" + path + "\" is no file to write to");
    }
    const fs::path folder = fs::path(path).parent_path();
    if (access(folder.empty() ? "." : folder.c_str(), W_OK) != 0 && !is_in_place(path)) {
        return wrong_usage("cannot write " + path + ": " + std::strerror(errno));
    }
    return {};
}

bool OutputFile::write(std::string_view bytes) {
    if (file_ == nullptr) {
        open();
    }
    if (file_ != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) {
        note_error();
    }
    bytes_written_ += bytes.size();
    return is_good();
}

Outcome<void> OutputFile::commit() {
    if (is_good() && file_ == nullptr) {
        open();
    }
    if (is_good() && std::fflush(file_) != 0) {
        note_error();
    }
    if (is_good() && file_ != stdout) {
        if (std::fclose(std::exchange(file_, nullptr)) != 0 ||
            (!part_.empty() && std::rename(part_.c_str(), path_.c_str()) != 0)) {
            note_error();
            std::remove(part_.c_str());
        }
    }
    if (!is_good()) {
        return tl::unexpected(Failure{ExitCode::kFailed, "cannot write " + path_ + ": " + error_});
    }
    return {};
}

void OutputFile::open() {
    file_ = path_ == "-" ? stdout : std::fopen((part_.empty() ? path_ : part_).c_str(), "wb");
    if (file_ == nullptr) {
        note_error();
    }
}

void OutputFile::note_error() {
    if (error_.empty()) {
        error_ = std::strerror(errno);
    }
}

std::string numbered_file(const std::string& path, std::uint32_t number) {
    if (number == 0) {
        return path;
    }
    const std::size_t slash = path.rfind('/');
    const std::size_t first = slash == std::string::npos ? 0 : slash + 1;
    const std::size_t dot = path.rfind('.');
    const bool has_extension = dot != std::string::npos && dot > first;
    const std::size_t end = has_extension ? dot : path.size();
    return path.substr(0, end) + "-" + std::to_string(number) + path.substr(end);
}

}  // namespace modelsynth::cli
