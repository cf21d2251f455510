#include "formats/files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "formats/files/stale_temporaries.h"
#include "formats/files/stream_file.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
    throw Error(ErrorKind::kIo, cat(path, ": ", what, ": ", std::generic_category().message(error)));
}

// A file descriptor that closes itself.
struct Descriptor {
    int fd;
    explicit Descriptor(int opened) : fd(opened) {}
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
};

// ---- Temporary names that a signal handler removes -------------------------------------------------------
// More files than slots at one time are no error: only their destructors remove the others.
std::array<std::atomic<const char*>, 256> g_temporaries;
std::atomic<bool> g_ending = false;
std::atomic<int> g_switches = 0;  // living SignalBlockers
static_assert(std::atomic<const char*>::is_always_lock_free, "a signal handler uses it");

void register_temporary(const char* path) {
    for (std::atomic<const char*>& slot : g_temporaries) {
        const char* empty = nullptr;
        if (slot.compare_exchange_strong(empty, path)) return;
    }
}

void forget_temporary(const char* path) {
    for (std::atomic<const char*>& slot : g_temporaries) {
        const char* expected = path;
        if (slot.compare_exchange_strong(expected, nullptr)) return;
    }
    // A signal handler on another thread has taken it: the process is ending, and the string must live until
    // then.
    while (g_ending) ::pause();
}

// Async-signal-safe: lock-free atomics, nanosleep, unlink, sigaction, pthread_sigmask, raise.
extern "C" void remove_temporaries_and_end(int signal) {
    if (g_ending.exchange(true)) return;  // a second signal must not cut short the work for the first one
    // A thread with a SignalBlocker blocks signals, so this waits for another thread. It does not wait
    // forever: that thread may want something that this one has locked.
    constexpr timespec kMillisecond = {0, 1'000'000};
    for (int n = 0; n < 10'000 && g_switches > 0; ++n) ::nanosleep(&kMillisecond, nullptr);
    for (std::atomic<const char*>& slot : g_temporaries)
        if (const char* path = slot.exchange(nullptr)) ::unlink(path);
    struct sigaction action = {};
    action.sa_handler = SIG_DFL;
    ::sigaction(signal, &action, nullptr);
    sigset_t one;
    ::sigemptyset(&one);
    ::sigaddset(&one, signal);
    ::pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
    ::raise(signal);
}

constexpr std::array kEndingSignals = {SIGINT, SIGTERM, SIGHUP};

// ---- Targets ---------------------------------------------------------------------------------------------
// Renaming over a device would replace it by a regular file; over a link it would replace the link.
std::string resolve_target(const std::string& path, bool overwrite) {
    struct stat info = {};
    if (::lstat(path.c_str(), &info) != 0) {
        if (errno == ENOENT) return path;
        fail(path, "cannot write", errno);
    }
    if (!overwrite) fail(path, "not overwritten", EEXIST);
    if (!S_ISLNK(info.st_mode)) {
        if (!S_ISREG(info.st_mode))
            throw Error(ErrorKind::kIo, cat(path, ": cannot write: it is not a regular file"));
        return path;
    }
    std::error_code error;
    const std::filesystem::path target = std::filesystem::canonical(path, error);
    if (error) throw Error(ErrorKind::kIo, cat(path, ": cannot follow the link: ", error.message()));
    if (!std::filesystem::is_regular_file(target, error))
        throw Error(ErrorKind::kIo, cat(path, ": cannot write: it is not a regular file"));
    return target.string();
}

// A rename reaches the disk with the folder. Some file systems cannot flush folders. The file is complete
// under its name all the same, so a failure here is not an error.
void flush_folder(const std::string& target) {
    const std::filesystem::path folder = std::filesystem::path(target).parent_path();
    const Descriptor dir(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (dir.fd >= 0) ::fsync(dir.fd);
}

// Not mkstemp(), whose files nobody else can read whatever the umask says. The descriptor is the claim to the
// file, and must be kept while its name is a temporary one.
int create_temporary(const std::string& target, std::string& name) {
    static std::atomic<unsigned> counter = 0;
    const std::filesystem::path path(target);
    for (;;) {
        const std::string base =
            cat(kTemporaryPrefix, ::getpid(), "-", counter.fetch_add(1), path.extension().string());
        name = (path.parent_path() / base).string();
        register_temporary(name.c_str());  // before it exists, so that a signal finds it at any time
        const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 && claim_temporary(fd, name)) return fd;
        const int error = fd >= 0 ? EEXIST : errno;
        if (fd >= 0) ::close(fd);
        forget_temporary(name.c_str());
        errno = error;
        if (error != EEXIST) return fd;  // a name in use was left by a killed run with our number
    }
}

}  // namespace

// ---- Files -----------------------------------------------------------------------------------------------
class AtomicFile::Temporary {
  public:
    Temporary(std::string path, bool overwrite) : path_(std::move(path)), overwrite_(overwrite) {
        // A stream's file has no name to be given: it is written as it is.
        if (const int stream = stream_descriptor(path_); stream >= 0) {
            claim_ = ::fcntl(stream, F_DUPFD_CLOEXEC, 0);
            if (claim_ < 0) fail(path_, "cannot write", errno);
            return;
        }
        target_ = resolve_target(path_, overwrite);
        remove_stale_temporaries(std::filesystem::path(target_).parent_path().string());
        claim_ = create_temporary(target_, name_);
        if (claim_ < 0) fail(path_, "cannot write", errno);
        if (overwrite_) share_as(target_);
    }
    ~Temporary() {
        if (!kept_ && !is_stream()) {
            ::unlink(name_.c_str());
            forget_temporary(name_.c_str());
        }
        ::close(claim_);
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    const std::string& path() const { return path_; }
    int descriptor() const { return claim_; }
    void share_as(const std::string& path);
    void write_parts(std::span<const std::span<const std::uint8_t>> parts);
    void write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes);
    void flush() {
        if (::fsync(claim_) != 0) fail(path_, "cannot write", errno);
    }
    // Throws what rename() would, as far as that can be known.
    void check_rename() const;
    void rename();
    void keep() { kept_ = true; }

  private:
    bool is_stream() const { return name_.empty(); }

    std::string path_;    // as given: for messages
    std::string target_;  // of the rename: `path_` with symbolic links followed
    std::string name_;
    int claim_ = -1;  // the descriptor, which also holds the claim to the name
    bool overwrite_;
    bool kept_ = false;
};

void AtomicFile::Temporary::share_as(const std::string& path) {
    if (is_stream()) return;
    struct stat info = {}, own = {};
    if (::stat(path.c_str(), &info) != 0 || ::fstat(claim_, &own) != 0) return;
    mode_t mode = info.st_mode & 0777;
    if (info.st_uid != own.st_uid || info.st_gid != own.st_gid) {
        // Only root can give a file away; everybody can share it with the groups that he is in.
        const bool is_shared =
            ::fchown(claim_, info.st_uid, info.st_gid) == 0 || ::fchown(claim_, uid_t(-1), info.st_gid) == 0;
        const mode_t others = mode & 07;
        if (!is_shared) mode = (mode & ~mode_t{070}) | ((mode & 070) & (others << 3));
    }
    ::fchmod(claim_, mode);  // a file system without permissions refuses, and needs none
}

void AtomicFile::Temporary::write_parts(std::span<const std::span<const std::uint8_t>> parts) {
    if (::ftruncate(claim_, 0) != 0 || ::lseek(claim_, 0, SEEK_SET) != 0) fail(path_, "cannot write", errno);
    for (std::span<const std::uint8_t> bytes : parts)
        while (!bytes.empty()) {
            const ssize_t n = ::write(claim_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) fail(path_, "cannot write", errno);
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
}

void AtomicFile::Temporary::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::pwrite(claim_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(path_, "cannot write", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
        offset += static_cast<std::uint64_t>(n);
    }
}

void AtomicFile::Temporary::check_rename() const {
    if (is_stream()) return;
    if (!is_named(claim_, name_))
        throw Error(ErrorKind::kIo, cat(path_, ": cannot write: somebody has exchanged the file ", name_));
    struct stat there = {};
    if (::lstat(target_.c_str(), &there) != 0) return;
    if (!overwrite_) fail(path_, "not overwritten", EEXIST);
    if (S_ISDIR(there.st_mode)) throw Error(ErrorKind::kIo, cat(path_, ": cannot write: it is a folder"));
}

void AtomicFile::Temporary::rename() {
    if (is_stream()) return;
    check_rename();
    int status = 0;
    if (overwrite_) {
        status = ::rename(name_.c_str(), target_.c_str());
    } else {
        status = ::renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE);
        // File systems without that flag return EINVAL; then the check has to do.
        if (status != 0 && errno == EINVAL) status = ::rename(name_.c_str(), target_.c_str());
    }
    if (status != 0) fail(path_, overwrite_ ? "cannot write" : "not overwritten", errno);
    flush_folder(target_);
    forget_temporary(name_.c_str());
    name_ = target_;
}

namespace {

thread_local JointFiles* g_joint = nullptr;

}  // namespace

AtomicFile::AtomicFile(std::string path, bool overwrite)
    : file_(std::make_shared<Temporary>(std::move(path), overwrite)) {}

AtomicFile::~AtomicFile() = default;

void AtomicFile::share_as(const std::string& path) {
    file_->share_as(path);
}

void AtomicFile::write_parts(std::span<const std::span<const std::uint8_t>> parts) {
    file_->write_parts(parts);
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    file_->write_at(offset, bytes);
}

int AtomicFile::descriptor() const {
    return file_->descriptor();
}

void AtomicFile::commit() {
    if (g_joint) {
        file_->flush();
        g_joint->complete_.push_back(file_);
        return;
    }
    place();
    keep();
}

void AtomicFile::place() {
    file_->flush();
    file_->rename();
    if (g_joint) g_joint->appeared_.push_back(file_->path());
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
    const SignalBlocker whole;
    try {
        for (const auto& file : complete_) file->check_rename();
        for (const auto& file : complete_) {
            file->rename();
            file->keep();
            appeared_.push_back(file->path());
        }
    } catch (const Error& error) {
        if (appeared_.empty()) throw;
        std::string names;
        for (const std::string& name : appeared_) names += (names.empty() ? "" : ", ") + name;
        throw Error(error.kind(), cat(error.what(), "; written before: ", names));
    }
    complete_.clear();
}

SignalBlocker::SignalBlocker() {
    sigset_t ending;
    ::sigemptyset(&ending);
    for (const int signal : kEndingSignals) ::sigaddset(&ending, signal);
    ::pthread_sigmask(SIG_BLOCK, &ending, &before_);
    ++g_switches;
    if (!g_ending) return;
    --g_switches;  // the handler on another thread is at work, or waits for this one
    for (;;) ::pause();
}

SignalBlocker::~SignalBlocker() {
    --g_switches;
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void remove_temporaries_on_signals() {
    for (const int signal : kEndingSignals) {
        struct sigaction action = {};
        if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
        action = {};
        action.sa_handler = remove_temporaries_and_end;
        ::sigaction(signal, &action, nullptr);
    }
}

FolderLock::FolderLock(const std::string& folder)
    : fd_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    constexpr timespec kStep = {0, 10'000'000};  // 10 ms
    constexpr int kSteps = 3000;
    // Who holds a lock forever may delay others, but not stop them.
    for (int n = 0; fd_ >= 0 && n < kSteps && ::flock(fd_, LOCK_EX | LOCK_NB) != 0; ++n) {
        if (errno != EWOULDBLOCK && errno != EINTR) return;
        ::nanosleep(&kStep, nullptr);
    }
}

FolderLock::~FolderLock() {
    if (fd_ >= 0) ::close(fd_);
}

std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes, FileKind kind) {
    const auto too_long = [&] {
        return Error(ErrorKind::kBadFile, cat(path, ": longer than the limit of ", max_bytes, " bytes"));
    };
    // Opening a named pipe waits for its writer, unless it is not to block.
    const int wait = kind == FileKind::kRegular ? O_NONBLOCK : 0;
    const Descriptor file(::open(system_path(path).c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | wait));
    struct stat info = {};
    if (file.fd < 0 || ::fstat(file.fd, &info) != 0) fail(path, "cannot read", errno);
    if (S_ISDIR(info.st_mode))
        throw Error(ErrorKind::kIo,
                    cat(path, ": cannot read: it is a folder, expected a file; name those in it"));
    const bool is_pipe = S_ISFIFO(info.st_mode) && kind == FileKind::kStream;
    if (!S_ISREG(info.st_mode) && !is_pipe)
        throw Error(ErrorKind::kIo, cat(path, ": cannot read: it is not a regular file",
                                        kind == FileKind::kStream ? " or a pipe" : ""));
    if (S_ISREG(info.st_mode) && static_cast<std::uint64_t>(info.st_size) > max_bytes) throw too_long();

    // With one byte more than the size, the last read() sees the end without another call; pipes have size 0.
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(info.st_size) + 1);
    std::size_t size = 0;
    for (;;) {
        if (size == bytes.size()) bytes.resize(2 * size + 65536);
        const ssize_t n = ::read(file.fd, bytes.data() + size, bytes.size() - size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(path, "cannot read", errno);
        if (n == 0) break;
        size += static_cast<std::size_t>(n);
        if (size > max_bytes) throw too_long();
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace imgmesh
