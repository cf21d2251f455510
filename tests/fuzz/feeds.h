// The readers, each fed with bytes. Internal to this folder.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "libcore/base/error.h"
#include "tests/fuzz/targets.h"

namespace imgmesh::fuzz {

/// Bytes as a file without a disk.
class MemoryFile {
  public:
    explicit MemoryFile(std::span<const std::uint8_t> bytes) : fd_(::memfd_create("fuzz", 0)) {
        if (fd_ < 0) throw std::runtime_error("memfd_create");
        while (!bytes.empty()) {
            const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
            if (n <= 0) throw std::runtime_error("write");
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }
    ~MemoryFile() { ::close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return cat("/proc/self/fd/", fd_); }

  private:
    int fd_;
};

/// Returns whether `read` ends without an Error. What no reader may say is thrown.
template <typename Read>
bool accepts(Read&& read) {
    try {
        read();
        return true;
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::kIo && e.kind() != ErrorKind::kBadFile &&
            e.kind() != ErrorKind::kUnsupported)
            throw;
        if (std::string_view(e.what()).find('\n') != std::string_view::npos)
            throw std::logic_error("a message of more than one line");
        return false;
    }
}

/// kPng to kHeif.
bool feed_image(Target target, std::span<const std::uint8_t> bytes);
bool feed_profile(std::span<const std::uint8_t> bytes);
bool feed_config(std::span<const std::uint8_t> bytes);
bool feed_compact(std::span<const std::uint8_t> bytes);
bool feed_coded(std::span<const std::uint8_t> bytes);

}  // namespace imgmesh::fuzz
