#include "formats/picture/codecs/wire.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::size_t kMostFiles = 2;

}  // namespace

std::pair<FileDescriptor, FileDescriptor> socket_pair() {
    int ends[2] = {-1, -1};
    const bool made = ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) == 0;
    FileDescriptor one = above_standard(FileDescriptor(ends[0]));
    FileDescriptor other = above_standard(FileDescriptor(ends[1]));
    if (!made || !one || !other)
        throw Error(ErrorKind::kIo, cat("cannot reach the program of codecs: ", std::strerror(errno)));
    return {std::move(one), std::move(other)};
}

bool send_bytes(int socket, std::span<const std::uint8_t> bytes, std::initializer_list<int> files) {
    struct iovec piece = {const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
    struct msghdr message = {};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    alignas(struct cmsghdr) std::array<char, CMSG_SPACE(kMostFiles * sizeof(int))> control{};
    if (files.size() != 0) {
        message.msg_control = control.data();
        message.msg_controllen = CMSG_SPACE(files.size() * sizeof(int));
        struct cmsghdr* head = CMSG_FIRSTHDR(&message);
        head->cmsg_level = SOL_SOCKET;
        head->cmsg_type = SCM_RIGHTS;
        head->cmsg_len = CMSG_LEN(files.size() * sizeof(int));
        std::memcpy(CMSG_DATA(head), std::data(files), files.size() * sizeof(int));
    }
    for (;;) {
        const ssize_t n = ::sendmsg(socket, &message, MSG_NOSIGNAL);
        if (n >= 0) return static_cast<std::size_t>(n) == bytes.size();
        if (errno != EINTR) return false;
    }
}

Received receive_bytes(int socket, std::span<std::uint8_t> bytes, std::vector<FileDescriptor>* files,
                       std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        struct pollfd wait = {socket, POLLIN, 0};
        const int ready =
            ::poll(&wait, 1, static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1 << 30)));
        if (ready == 0) return Received::kTimeout;
        if (ready > 0) break;
        if (errno != EINTR) return Received::kEnd;
    }
    struct iovec piece = {bytes.data(), bytes.size()};
    struct msghdr message = {};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    alignas(struct cmsghdr) std::array<char, CMSG_SPACE(kMostFiles * sizeof(int))> control{};
    if (files) {
        message.msg_control = control.data();
        message.msg_controllen = control.size();
    }
    ssize_t n = -1;
    do {
        n = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
    } while (n < 0 && errno == EINTR);
    std::vector<FileDescriptor> got;
    if (n >= 0 && files) {
        for (struct cmsghdr* head = CMSG_FIRSTHDR(&message); head; head = CMSG_NXTHDR(&message, head)) {
            if (head->cmsg_level != SOL_SOCKET || head->cmsg_type != SCM_RIGHTS) continue;
            for (std::size_t i = 0; i < (head->cmsg_len - CMSG_LEN(0)) / sizeof(int); ++i) {
                int file = -1;
                std::memcpy(&file, CMSG_DATA(head) + i * sizeof(int), sizeof(int));
                got.emplace_back(file);
            }
        }
    }
    if (n != static_cast<ssize_t>(bytes.size()) || (message.msg_flags & MSG_TRUNC)) return Received::kEnd;
    if (files) {
        if (got.size() != files->size()) return Received::kEnd;
        *files = std::move(got);
    }
    return Received::kMessage;
}

}  // namespace imgmesh
