#include "formats/picture/codecs/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

Error refused() {
    return {ErrorKind::kIo, cat("cannot share memory with the program of codecs: ", std::strerror(errno))};
}

FileDescriptor new_file() {
    // Linux 6.3 and later wants to be told whether programs may be run from it; older ones do not know the
    // flag.
    constexpr unsigned kNoExec = 8;
    int file = ::memfd_create("imgmesh", MFD_CLOEXEC | MFD_ALLOW_SEALING | kNoExec);
    if (file < 0 && errno == EINVAL) file = ::memfd_create("imgmesh", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    FileDescriptor out = above_standard(FileDescriptor(file));
    if (!out) throw refused();
    return out;
}

}  // namespace

SharedMemory::SharedMemory(std::uint64_t size) : size_(std::max<std::size_t>(size, 1)) {
    // Beyond this limit ftruncate() would end the process by a signal.
    struct rlimit most = {};
    if (::getrlimit(RLIMIT_FSIZE, &most) == 0 && size_ > most.rlim_cur) {
        errno = EFBIG;
        throw refused();
    }
    file_ = new_file();
    if (::ftruncate(file_.get(), static_cast<off_t>(size_)) != 0 ||
        ::fcntl(file_.get(), F_ADD_SEALS, kSeals) != 0)
        throw refused();
    map();
}

SharedMemory::SharedMemory(FileDescriptor file, std::uint64_t size)
    : file_(std::move(file)), size_(std::max<std::size_t>(size, 1)) {
    struct stat is = {};
    const int seals = ::fcntl(file_.get(), F_GET_SEALS);
    if (::fstat(file_.get(), &is) != 0 || static_cast<std::uint64_t>(is.st_size) != size_ || seals < 0 ||
        (seals & kSeals) != kSeals)
        throw Error(ErrorKind::kInternal, "shared memory of a wrong size");
    map();
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : file_(std::move(other.file_)),
      start_(std::exchange(other.start_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(start_, other.start_);
    std::swap(size_, other.size_);
    return *this;
}

SharedMemory::~SharedMemory() {
    if (start_) ::munmap(start_, size_);
}

// All pages at once: all will be used, and one by one they take several times as long.
void SharedMemory::map() {
    void* at = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file_.get(), 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    start_ = static_cast<std::uint8_t*>(at);
}

}  // namespace imgmesh
