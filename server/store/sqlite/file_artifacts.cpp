#include "server/store/sqlite/file_artifacts.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>
#include <vector>

namespace modelsynth::server {

namespace {

namespace fs = std::filesystem;

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}

    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

    Descriptor& operator=(Descriptor&&) = delete;

    ~Descriptor() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }

    [[nodiscard]] int get() const { return fd_; }

  private:
    int fd_;
};

tl::unexpected<StoreError> failed_by_system(const std::string& what) {
    return tl::unexpected(StoreError{
        StoreErrorCode::kUnavailable, what + ": " + std::strerror(errno)});
}

bool write_all(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            return false;
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

bool sync_directory(const fs::path& path) {
    const Descriptor directory(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    return directory.get() >= 0 && ::fsync(directory.get()) == 0;
}

// A digest as sha256_hex() writes them; nothing else is the name of a file.
bool is_digest(std::string_view text) {
    return text.size() == 64 &&
           text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

tl::unexpected<StoreError> no_artifact(const std::string& digest) {
    return tl::unexpected(StoreError{StoreErrorCode::kNotFound, "there is no artifact " + digest});
}

class FileReader final : public ArtifactStore::Reader {
  public:
    FileReader(Descriptor file, std::uint64_t size) : file_(std::move(file)), size_(size) {}

    [[nodiscard]] std::uint64_t size() const override { return size_; }

    [[nodiscard]] Stored<void> read(std::uint64_t offset, std::span<char> into) override {
        while (!into.empty()) {
            const ssize_t got =
                ::pread(file_.get(), into.data(), into.size(), static_cast<off_t>(offset));
            if (got < 0 && errno == EINTR) {
                continue;
            }
            if (got < 0) {
                return failed_by_system("an artifact cannot be read");
            }
            if (got == 0) {
                return tl::unexpected(StoreError{
                    StoreErrorCode::kCorrupt, "an artifact is shorter than it was"});
            }
            into = into.subspan(static_cast<std::size_t>(got));
            offset += static_cast<std::uint64_t>(got);
        }
        return {};
    }

  private:
    Descriptor file_;
    std::uint64_t size_;
};

}  // namespace

std::string sha256_hex(std::string_view bytes) {
    std::array<unsigned char, 32> digest = {};
    unsigned int length = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
    static constexpr const char* kHex = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += kHex[byte >> 4];
        text += kHex[byte & 15];
    }
    return text;
}

class FileArtifacts::FilePin final : public Pin {
  public:
    FilePin(FileArtifacts& store, std::string digest) : store_(store), digest_(std::move(digest)) {
        const std::lock_guard lock(store_.mutex_);
        ++store_.pins_[digest_];
    }

    FilePin(const FilePin&) = delete;
    FilePin& operator=(const FilePin&) = delete;

    ~FilePin() override { store_.unpin(digest_); }

    [[nodiscard]] const std::string& digest() const override { return digest_; }

  private:
    FileArtifacts& store_;
    std::string digest_;
};

FileArtifacts::FileArtifacts(fs::path directory, fs::path temporary)
    : directory_(std::move(directory)), temporary_(std::move(temporary)) {
    fs::create_directories(directory_);
    fs::remove_all(temporary_);
    fs::create_directories(temporary_);
}

fs::path FileArtifacts::path_of(const std::string& digest) const {
    return directory_ / digest.substr(0, 2) / digest.substr(2, 2) / digest;
}

ArtifactStore::Space FileArtifacts::space() const {
    std::error_code error;
    const fs::space_info info = fs::space(directory_, error);
    // What cannot be told is not held against anybody; writing will show.
    return {used_bytes_, error ? std::numeric_limits<std::uint64_t>::max() : info.available};
}

Stored<std::unique_ptr<ArtifactStore::Pin>> FileArtifacts::put(std::string_view bytes) {
    // The pin comes first: from then on nobody removes the file, whether it is there already or
    // about to be.
    auto pin = std::make_unique<FilePin>(*this, sha256_hex(bytes));
    if (!exists(pin->digest())) {
        if (auto written = write_file(pin->digest(), bytes); !written) {
            return tl::unexpected(std::move(written.error()));
        }
    }
    // Also when the file was there: whoever put it may be about to do this, or have failed.
    if (!sync_directories(pin->digest())) {
        return failed_by_system("an artifact's directory cannot be synced");
    }
    return pin;
}

Stored<std::unique_ptr<ArtifactStore::Pin>> FileArtifacts::pin(const std::string& digest) {
    if (!is_digest(digest)) {
        return no_artifact(digest);  // its pin would have a file of that name removed in the end
    }
    auto pin = std::make_unique<FilePin>(*this, digest);  // first, as in put()
    if (!exists(digest)) {
        return no_artifact(digest);
    }
    return pin;
}

bool FileArtifacts::sync_directories(const std::string& digest) {
    const fs::path inner = path_of(digest).parent_path();
    if (!sync_directory(inner)) {
        return false;
    }
    // The way to it needs that once only: directories stay.
    const std::string name = inner.lexically_relative(directory_).string();
    {
        const std::lock_guard lock(mutex_);
        if (synced_ways_.contains(name)) {
            return true;
        }
    }
    if (!sync_directory(inner.parent_path()) || !sync_directory(directory_)) {
        return false;
    }
    const std::lock_guard lock(mutex_);
    synced_ways_.insert(name);
    return true;
}

Stored<void> FileArtifacts::write_file(const std::string& digest, std::string_view bytes) {
    fs::path temporary;
    {
        const std::lock_guard lock(mutex_);
        temporary = temporary_ / std::to_string(next_temporary_++);
    }
    const auto give_up = [&temporary](const std::string& what) {
        auto error = failed_by_system(what);
        std::error_code ignored;
        fs::remove(temporary, ignored);
        return error;
    };
    {
        const Descriptor file(
            ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640)
        );
        if (file.get() < 0 || !write_all(file.get(), bytes) || ::fsync(file.get()) != 0) {
            return give_up("an artifact cannot be written");
        }
    }
    const fs::path target = path_of(digest);
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    {
        const std::lock_guard lock(mutex_);
        const bool is_new = !exists(digest);
        fs::rename(temporary, target, error);
        used_bytes_ += !error && is_new ? bytes.size() : 0;
    }
    if (error) {
        return give_up("an artifact cannot be put in its place");
    }
    return {};
}

Stored<std::unique_ptr<ArtifactStore::Reader>> FileArtifacts::open(const std::string& digest) {
    Descriptor file(is_digest(digest) ? ::open(path_of(digest).c_str(), O_RDONLY | O_CLOEXEC) : -1);
    if (file.get() < 0) {
        return no_artifact(digest);
    }
    struct stat status = {};
    if (::fstat(file.get(), &status) != 0) {
        return failed_by_system("an artifact cannot be read");
    }
    return std::make_unique<FileReader>(
        std::move(file), static_cast<std::uint64_t>(status.st_size)
    );
}

Stored<std::string> FileArtifacts::load(const std::string& digest) {
    auto reader = open(digest);
    if (!reader) {
        return tl::unexpected(std::move(reader.error()));
    }
    std::string bytes((*reader)->size(), '\0');
    if (auto read = (*reader)->read(0, bytes); !read) {
        return tl::unexpected(std::move(read.error()));
    }
    if (sha256_hex(bytes) != digest) {
        return tl::unexpected(StoreError{
            StoreErrorCode::kCorrupt, "artifact " + digest + " has other content"});
    }
    return bytes;
}

bool FileArtifacts::exists(const std::string& digest) const {
    std::error_code error;
    return is_digest(digest) && fs::exists(path_of(digest), error);
}

bool FileArtifacts::empty() const {
    const fs::recursive_directory_iterator entries(directory_);
    return std::none_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
        return entry.is_regular_file();
    });
}

void FileArtifacts::remove_if_unpinned(const std::string& digest) {
    const std::lock_guard lock(mutex_);
    if (!pins_.contains(digest)) {
        const std::uint64_t size = size_of(digest);
        std::error_code ignored;  // an orphan is found again at the next start
        used_bytes_ -= fs::remove(path_of(digest), ignored) ? size : 0;
    }
}

std::uint64_t FileArtifacts::size_of(const std::string& digest) const {
    std::error_code error;
    const std::uint64_t size = is_digest(digest) ? fs::file_size(path_of(digest), error) : 0;
    return error ? 0 : size;
}

void FileArtifacts::sweep(const std::function<bool(const std::string&)>& is_used) {
    std::vector<fs::path> orphans;
    for (const auto& entry : fs::recursive_directory_iterator(directory_)) {
        if (!entry.is_regular_file()) {
            continue;
        }
        if (is_used(entry.path().filename().string())) {
            used_bytes_ += entry.file_size();
        } else {
            orphans.push_back(entry.path());
        }
    }
    for (const fs::path& orphan : orphans) {
        std::error_code ignored;
        fs::remove(orphan, ignored);
    }
}

void FileArtifacts::unpin(const std::string& digest) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = pins_.find(digest);
        if (--found->second > 0) {
            return;
        }
        pins_.erase(found);
    }
    if (on_unpinned_) {
        on_unpinned_(digest);
    }
}

}  // namespace modelsynth::server
