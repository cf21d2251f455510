#include "formats/files/stream_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18;

std::mutex g_mutex;
std::map<std::string, int>& descriptors() {
    static std::map<std::string, int> of_name;
    return of_name;
}

[[noreturn]] void fail(const std::string& name, const char* what, int error) {
    throw Error(ErrorKind::kIo, cat(name, ": ", what, ": ", std::generic_category().message(error)));
}

void write_all(int fd, const std::uint8_t* bytes, std::size_t size, const std::string& name) {
    while (size > 0) {
        const ssize_t n = ::write(fd, bytes, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(name, "cannot write", errno);
        bytes += n;
        size -= static_cast<std::size_t>(n);
    }
}

}  // namespace

StreamFile::StreamFile(std::string name)
    : name_(std::move(name)), fd_(::memfd_create("imgmesh", MFD_CLOEXEC)) {
    if (fd_ < 0) fail(name_, "cannot be kept in memory", errno);
    const std::lock_guard lock(g_mutex);
    descriptors()[name_] = fd_;
}

StreamFile::~StreamFile() {
    {
        const std::lock_guard lock(g_mutex);
        descriptors().erase(name_);
    }
    ::close(fd_);
}

void StreamFile::fill(int from, std::uint64_t most) {
    std::vector<std::uint8_t> piece(kPiece);
    for (std::uint64_t size = 0;;) {
        const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, most - size + 1));
        const ssize_t n = ::read(from, piece.data(), wanted);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(name_, "cannot read", errno);
        if (n == 0) return;
        size += static_cast<std::uint64_t>(n);
        if (size > most)
            throw Error(ErrorKind::kBadFile, cat(name_, ": longer than the limit of ", most, " bytes"));
        write_all(fd_, piece.data(), static_cast<std::size_t>(n), name_);
    }
}

void StreamFile::pour(int to, const std::string& what) const {
    std::vector<std::uint8_t> piece(kPiece);
    for (off_t at = 0;;) {
        const ssize_t n = ::pread(fd_, piece.data(), piece.size(), at);
        if (n < 0) fail(name_, "cannot read", errno);
        if (n == 0) return;
        write_all(to, piece.data(), static_cast<std::size_t>(n), what);
        at += n;
    }
}

int stream_descriptor(const std::string& path) {
    const std::lock_guard lock(g_mutex);
    const auto found = descriptors().find(path);
    return found == descriptors().end() ? -1 : found->second;
}

std::string system_path(const std::string& path) {
    const int fd = stream_descriptor(path);
    return fd < 0 ? path : cat("/proc/self/fd/", fd);
}

}  // namespace imgmesh
