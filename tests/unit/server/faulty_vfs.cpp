// A VFS of SQLite that hands every call on to the unix one and may fail before. The methods of a
// file are C functions that find the shim by a pointer in the file object; the unix file object
// stands behind ours in the same piece of memory, as SQLite's own shims do it.

#include "tests/unit/server/faulty_vfs.h"

#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <random>

namespace modelsynth::server {

namespace {

struct File {
    sqlite3_file base;
    FaultyVfs* disk;
    const std::string* path;  // owned
    sqlite3_file* real;
};

File& file_of(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }

sqlite3_file* real_of(sqlite3_file* file) { return file_of(file).real; }

int close_file(sqlite3_file* file) {
    File& own = file_of(file);
    const int code = own.real->pMethods->xClose(own.real);
    delete own.path;
    own.path = nullptr;
    own.disk->closed();
    return code;
}

int read_file(sqlite3_file* file, void* into, int size, sqlite3_int64 at) {
    const int code = file_of(file).disk->before(FaultyVfs::Call::kRead);
    return code != SQLITE_OK ? code : real_of(file)->pMethods->xRead(real_of(file), into, size, at);
}

int write_file(sqlite3_file* file, const void* from, int size, sqlite3_int64 at) {
    const File& own = file_of(file);
    const int code = own.disk->before(FaultyVfs::Call::kWrite);
    if (code != SQLITE_OK) {
        return code;
    }
    own.disk->change(
        *own.path,
        {false, at, std::string(static_cast<const char*>(from), static_cast<std::size_t>(size))}
    );
    return own.real->pMethods->xWrite(own.real, from, size, at);
}

int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
    const File& own = file_of(file);
    const int code = own.disk->before(FaultyVfs::Call::kTruncate);
    if (code != SQLITE_OK) {
        return code;
    }
    own.disk->change(*own.path, {true, size, ""});
    return own.real->pMethods->xTruncate(own.real, size);
}

// The unix file is not synced: what a sync is worth is told by the shim, and the tests are quick.
int sync_file(sqlite3_file* file, int) {
    const File& own = file_of(file);
    const int code = own.disk->before(FaultyVfs::Call::kSync);
    if (code == SQLITE_OK) {
        own.disk->synced(*own.path);
    }
    return code;
}

int file_size(sqlite3_file* file, sqlite3_int64* size) {
    return real_of(file)->pMethods->xFileSize(real_of(file), size);
}

int lock_file(sqlite3_file* file, int level) {
    return real_of(file)->pMethods->xLock(real_of(file), level);
}

int unlock_file(sqlite3_file* file, int level) {
    return real_of(file)->pMethods->xUnlock(real_of(file), level);
}

int check_reserved_lock(sqlite3_file* file, int* answer) {
    return real_of(file)->pMethods->xCheckReservedLock(real_of(file), answer);
}

int control_file(sqlite3_file* file, int operation, void* argument) {
    return real_of(file)->pMethods->xFileControl(real_of(file), operation, argument);
}

int sector_size(sqlite3_file* file) { return real_of(file)->pMethods->xSectorSize(real_of(file)); }

int device_characteristics(sqlite3_file* file) {
    return real_of(file)->pMethods->xDeviceCharacteristics(real_of(file));
}

int map_shared(sqlite3_file* file, int page, int size, int extend, void volatile** address) {
    return real_of(file)->pMethods->xShmMap(real_of(file), page, size, extend, address);
}

int lock_shared(sqlite3_file* file, int offset, int count, int flags) {
    return real_of(file)->pMethods->xShmLock(real_of(file), offset, count, flags);
}

void barrier_shared(sqlite3_file* file) { real_of(file)->pMethods->xShmBarrier(real_of(file)); }

int unmap_shared(sqlite3_file* file, int remove) {
    return real_of(file)->pMethods->xShmUnmap(real_of(file), remove);
}

// Version 2: shared memory for the write-ahead log, no mapping of the database.
const sqlite3_io_methods kMethods = {
    2,
    close_file,
    read_file,
    write_file,
    truncate_file,
    sync_file,
    file_size,
    lock_file,
    unlock_file,
    check_reserved_lock,
    control_file,
    sector_size,
    device_characteristics,
    map_shared,
    lock_shared,
    barrier_shared,
    unmap_shared,
    nullptr,
    nullptr};

std::string content_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void apply(const FaultyVfs::Change& change, std::string& content) {
    const auto at = static_cast<std::size_t>(change.at);
    if (change.is_truncation) {
        content.resize(at);
        return;
    }
    if (content.size() < at + change.bytes.size()) {
        content.resize(at + change.bytes.size());
    }
    content.replace(at, change.bytes.size(), change.bytes);
}

}  // namespace

struct FaultyVfs::Registration {
    sqlite3_vfs vfs;
    sqlite3_vfs* real;
    FaultyVfs* disk;

    static Registration& of(sqlite3_vfs* vfs) { return *static_cast<Registration*>(vfs->pAppData); }

    static int open(
        sqlite3_vfs* vfs, sqlite3_filename name, sqlite3_file* file, int flags, int* flags_out
    ) {
        const Registration& own = of(vfs);
        File& opened = file_of(file);
        opened.base.pMethods = nullptr;
        opened.disk = own.disk;
        opened.real = reinterpret_cast<sqlite3_file*>(&opened + 1);
        const int code = own.real->xOpen(own.real, name, opened.real, flags, flags_out);
        if (code == SQLITE_OK) {
            opened.path = new std::string(name == nullptr ? "" : name);
            opened.base.pMethods = &kMethods;
            own.disk->opened();
        }
        return code;
    }

    static int remove(sqlite3_vfs* vfs, const char* name, int sync) {
        const Registration& own = of(vfs);
        const int code = own.disk->before(Call::kTruncate);
        if (code != SQLITE_OK) {
            return code;
        }
        own.disk->removed(name);
        return own.real->xDelete(own.real, name, sync);
    }
};

FaultyVfs::FaultyVfs() : registration_(std::make_unique<Registration>()) {
    sqlite3_vfs* real = sqlite3_vfs_find("unix");
    sqlite3_vfs& vfs = registration_->vfs;
    vfs = *real;  // what is not replaced needs no file of ours
    vfs.pNext = nullptr;
    vfs.zName = "faulty";
    vfs.szOsFile = static_cast<int>(sizeof(File)) + real->szOsFile;
    vfs.pAppData = registration_.get();
    vfs.xOpen = Registration::open;
    vfs.xDelete = Registration::remove;
    registration_->real = real;
    registration_->disk = this;
    sqlite3_vfs_register(&vfs, 1);
}

FaultyVfs::~FaultyVfs() {
    sqlite3_vfs_unregister(&registration_->vfs);
    sqlite3_vfs_register(registration_->real, 1);
}

void FaultyVfs::fail(Call call, std::size_t n, int code, std::size_t count) {
    const std::lock_guard lock(mutex_);
    failing_ = call;
    calls_to_failure_ = n;
    failures_left_ = count;
    code_ = code;
    failed_ = false;
}

void FaultyVfs::heal() {
    const std::lock_guard lock(mutex_);
    calls_to_failure_ = 0;
}

bool FaultyVfs::has_failed() const {
    const std::lock_guard lock(mutex_);
    return failed_;
}

int FaultyVfs::open_file_count() const {
    const std::lock_guard lock(mutex_);
    return open_file_count_;
}

void FaultyVfs::opened() {
    const std::lock_guard lock(mutex_);
    ++open_file_count_;
}

void FaultyVfs::closed() {
    const std::lock_guard lock(mutex_);
    --open_file_count_;
}

void FaultyVfs::watch() {
    const std::lock_guard lock(mutex_);
    is_watching_ = true;
    files_.clear();
}

void FaultyVfs::cut_power_at(std::size_t n) {
    const std::lock_guard lock(mutex_);
    calls_to_power_cut_ = n;
    failed_ = false;
}

void FaultyVfs::restore_power(std::uint64_t seed) {
    const std::lock_guard lock(mutex_);
    std::mt19937_64 random(seed);
    for (const auto& [path, file] : files_) {
        std::string content = file.synced;
        for (const Change& change : file.changes) {
            if (seed != 0 && random() % 2 == 0) {
                apply(change, content);
            }
        }
        std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
    }
    files_.clear();
    is_watching_ = false;
    is_powerless_ = false;
    calls_to_power_cut_ = 0;
}

int FaultyVfs::before(Call call) {
    const std::lock_guard lock(mutex_);
    if (is_powerless_) {
        return SQLITE_IOERR;
    }
    if (calls_to_power_cut_ > 0 && call != Call::kRead && --calls_to_power_cut_ == 0) {
        is_powerless_ = true;
        failed_ = true;
        return SQLITE_IOERR;
    }
    if (calls_to_failure_ == 0 || call != failing_) {
        return SQLITE_OK;
    }
    if (calls_to_failure_ > 1) {
        --calls_to_failure_;
        return SQLITE_OK;
    }
    failed_ = true;
    if (--failures_left_ == 0) {
        calls_to_failure_ = 0;
    }
    return code_;
}

void FaultyVfs::change(const std::string& path, Change change) {
    const std::lock_guard lock(mutex_);
    if (!is_watching_) {
        return;
    }
    if (!files_.contains(path)) {
        files_[path].synced = content_of(path);
    }
    files_[path].changes.push_back(std::move(change));
}

void FaultyVfs::synced(const std::string& path) {
    const std::lock_guard lock(mutex_);
    if (is_watching_) {
        files_[path] = {content_of(path), {}};
    }
}

void FaultyVfs::removed(const std::string& path) {
    const std::lock_guard lock(mutex_);
    files_.erase(path);
}

}  // namespace modelsynth::server
