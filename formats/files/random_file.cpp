#include "formats/files/random_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "formats/files/stream_file.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

Error unreadable(const std::string& path, int error) {
    return {ErrorKind::kIo, cat(path, ": cannot read: ", std::generic_category().message(error))};
}

}  // namespace

RandomFile::RandomFile(const std::string& path)
    : path_(path), fd_(::open(system_path(path).c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) {
    struct stat info = {};
    if (fd_ < 0) throw unreadable(path, errno);
    const bool known = ::fstat(fd_, &info) == 0;
    const int error = errno;
    if (known && S_ISREG(info.st_mode)) {
        size_ = static_cast<std::uint64_t>(info.st_size);
        return;
    }
    ::close(fd_);
    if (!known) throw unreadable(path, error);
    throw Error(ErrorKind::kIo, cat(path, ": cannot read: it is not a regular file"));
}

RandomFile::~RandomFile() {
    ::close(fd_);
}

std::size_t RandomFile::read_at(std::uint64_t at, std::span<std::uint8_t> out) const {
    if (at >= size_) return 0;  // which is also before what off_t cannot hold
    std::size_t done = 0;
    while (done < out.size()) {
        const ssize_t n = ::pread(fd_, out.data() + done, out.size() - done, static_cast<off_t>(at + done));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw unreadable(path_, errno);
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

std::vector<std::uint8_t> RandomFile::bytes_at(std::uint64_t at, std::size_t most) const {
    const std::uint64_t left = size_ - std::min(size_, at);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(left, most)));
    bytes.resize(read_at(at, bytes));
    return bytes;
}

}  // namespace imgmesh
