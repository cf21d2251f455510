// Files of a page. They lie in its own memory (emscripten's MEMFS): nobody else sees them, no signal comes,
// and what ends the page ends the files. Whole or not at all is all that is left of an AtomicFile's duties.
#include "formats/files/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "formats/files/stream_file.h"
#include "libcore/base/error.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

using FileHandle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

FileHandle open_file(const std::string& path, const char* mode) {
    return {std::fopen(path.c_str(), mode), std::fclose};
}

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
    throw Error(ErrorKind::kIo, cat(path, ": ", what, ": ", std::generic_category().message(error)));
}

JointFiles* g_joint = nullptr;

}  // namespace

class AtomicFile::Temporary {
  public:
    Temporary(std::string path, bool overwrite) : path_(std::move(path)), overwrite_(overwrite) {
        check_free();
    }
    ~Temporary() {
        if (!kept_) std::remove(name_.c_str());
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    const std::string& path() const { return path_; }
    void write_parts(std::span<const std::span<const std::uint8_t>> parts) {
        const FileHandle file = open_file(name_, "wb");
        if (!file) fail(path_, "cannot write", errno);
        for (const std::span<const std::uint8_t> bytes : parts)
            if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
                fail(path_, "cannot write", errno);
        if (std::fflush(file.get()) != 0) fail(path_, "cannot write", errno);
    }
    void write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
        std::error_code error;
        const FileHandle file = open_file(name_, fs::exists(name_, error) ? "r+b" : "wb");
        // Memory of a page ends long before what an offset of C can say.
        if (!file || std::fseek(file.get(), static_cast<long>(offset), SEEK_SET) != 0 ||
            std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() ||
            std::fflush(file.get()) != 0)
            fail(path_, "cannot write", errno);
    }
    void rename() {
        check_free();
        if (std::rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "cannot write", errno);
        name_ = path_;
    }
    void keep() { kept_ = true; }

  private:
    void check_free() const {
        std::error_code error;
        if (fs::is_directory(path_, error))
            throw Error(ErrorKind::kIo, cat(path_, ": cannot write: it is a folder"));
        if (!overwrite_ && fs::exists(path_, error)) fail(path_, "not overwritten", EEXIST);
    }

    std::string path_, name_ = path_ + ".incomplete";
    bool overwrite_, kept_ = false;
};

AtomicFile::AtomicFile(std::string path, bool overwrite)
    : file_(std::make_shared<Temporary>(std::move(path), overwrite)) {}

AtomicFile::~AtomicFile() = default;

void AtomicFile::share_as(const std::string&) {}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    file_->write_at(offset, bytes);
}

void AtomicFile::write_parts(std::span<const std::span<const std::uint8_t>> parts) {
    file_->write_parts(parts);
}

void AtomicFile::commit() {
    if (g_joint) {
        g_joint->complete_.push_back(file_);
        return;
    }
    place();
    keep();
}

void AtomicFile::place() {
    file_->rename();
}

void AtomicFile::keep() {
    file_->keep();
}

JointFiles::JointFiles() {
    g_joint = this;
}

JointFiles::~JointFiles() {
    g_joint = nullptr;
}

void JointFiles::commit() {
    for (const auto& file : complete_) {
        file->rename();
        file->keep();
    }
    complete_.clear();
}

SignalBlocker::SignalBlocker() {}
SignalBlocker::~SignalBlocker() {}
FolderLock::FolderLock(const std::string&) : fd_(-1) {}
FolderLock::~FolderLock() {}

std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes, FileKind) {
    std::error_code error;
    const FileHandle file = open_file(path, "rb");
    if (!file) fail(path, "cannot read", errno);
    const std::uint64_t size = fs::file_size(path, error);
    if (error) fail(path, "cannot read", error.value());
    if (size > max_bytes)
        throw Error(ErrorKind::kBadFile, cat(path, ": longer than the limit of ", max_bytes, " bytes"));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
        fail(path, "cannot read", errno);
    return bytes;
}

int stream_descriptor(const std::string&) {
    return -1;
}

std::string system_path(const std::string& path) {
    return path;
}

}  // namespace imgmesh
