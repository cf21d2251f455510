#include "formats/picture/codecs/codec_server.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "formats/files/one_line.h"
#include "formats/picture/codecs/wire.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr int kProgramsSocket = 3;

// How posix_spawn() is to start it. Freed with its owner.
struct SpawnPlan {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    SpawnPlan() {
        ::posix_spawn_file_actions_init(&files);
        ::posix_spawnattr_init(&attributes);
    }
    ~SpawnPlan() {
        ::posix_spawn_file_actions_destroy(&files);
        ::posix_spawnattr_destroy(&attributes);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;
};

// The socket goes first: if this process has closed its standard streams, it may have one of their numbers.
int plan(SpawnPlan& to, int socket, int complaints) {
    int failed = ::posix_spawn_file_actions_adddup2(&to.files, socket, kProgramsSocket);
    if (!failed && complaints >= 0)
        failed = ::posix_spawn_file_actions_adddup2(&to.files, complaints, STDERR_FILENO);
    else if (!failed)
        failed = ::posix_spawn_file_actions_addopen(&to.files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (!failed)
        failed = ::posix_spawn_file_actions_addopen(&to.files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (!failed)
        failed = ::posix_spawn_file_actions_addopen(&to.files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (!failed) failed = ::posix_spawn_file_actions_addclosefrom_np(&to.files, kProgramsSocket + 1);
    if (!failed) failed = ::posix_spawn_file_actions_addchdir_np(&to.files, "/");
    if (failed) return failed;
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&to.attributes, &none);
    ::posix_spawnattr_setsigdefault(&to.attributes, &all);
    return ::posix_spawnattr_setflags(&to.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
}

Error cannot_start(const std::string& program, const std::string& reason) {
    return {ErrorKind::kUnsupported, cat("cannot start ", program, ": ", one_line(reason))};
}

}  // namespace

CodecServer::CodecServer(const std::string& program) : owner_(::getpid()) {
    auto [ours, theirs] = socket_pair();
#ifdef IMGMESH_SANITIZED
    const int complaints = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);  // what sanitizers find
#else
    const int complaints = ::memfd_create("imgmesh-complaints", MFD_CLOEXEC);
#endif
    complaints_ = above_standard(FileDescriptor(complaints));
    SpawnPlan how;
    // Nothing of this process's environment: no variable changes what is loaded or how images are read.
    std::array<std::string, 3> variables = {"LC_ALL=C", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"};
    std::array<char*, 4> environment = {variables[0].data(), variables[1].data(), variables[2].data(),
                                        nullptr};
    std::string name = program;
    std::array<char*, 2> arguments = {name.data(), nullptr};
    int failed = plan(how, theirs.get(), complaints_.get());
    if (!failed)
        failed = ::posix_spawn(&process_, program.c_str(), &how.files, &how.attributes, arguments.data(),
                               environment.data());
    if (failed) {
        process_ = -1;
        throw cannot_start(program, std::strerror(failed));
    }
    socket_ = std::move(ours);
}

bool CodecServer::is_ours() const {
    return owner_ == ::getpid();
}

CodecServer::~CodecServer() {
    socket_.close();
    if (is_ours()) reap();
}

// Returns how it ended, 0 if nobody knows: this process may have other children, and somebody in it who waits
// for any of them. A program that does not end by itself is ended.
int CodecServer::reap() {
    if (process_ < 0) return 0;
    constexpr int kSteps = 2000;
    constexpr struct timespec kStep = {0, 1000000};
    int status = 0;
    for (int step = 0;; ++step) {
        const pid_t ended = ::waitpid(process_, &status, WNOHANG);
        if (ended == process_) break;
        if (ended < 0 && errno != EINTR) {
            status = 0;
            break;
        }
        if (step == kSteps) ::kill(process_, SIGKILL);
        ::nanosleep(&kStep, nullptr);
    }
    process_ = -1;
    return status;
}

CodecServer::End CodecServer::end() {
    if (!is_ours()) return {};
    const int status = reap();
    if (status == 0) return {};
    const bool by_signal = WIFSIGNALED(status);
    std::array<char, 400> text{};
    const ssize_t n = complaints_ ? ::pread(complaints_.get(), text.data(), text.size() - 1, 0) : 0;
    if (n > 0) return {one_line(std::string(text.data(), static_cast<std::size_t>(n))), by_signal};
    return {by_signal ? cat("ended by signal ", WTERMSIG(status)) : cat("exit code ", WEXITSTATUS(status)),
            by_signal};
}

}  // namespace imgmesh
