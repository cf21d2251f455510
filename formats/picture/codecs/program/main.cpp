// imgmesh-codecs: decodes and encodes images for imgmesh with libraries that may crash. Not for people:
// imgmesh starts it with a socket as file 3, sends jobs there, and closes it. Each job is done by a fork of
// this process: the libraries, which take 0.2 s to load, are loaded once, and whatever a file does to a
// library's memory is over with its job.
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "formats/picture/codecs/program/codecs.h"
#include "formats/picture/codecs/program/job.h"
#include "libcore/base/error.h"

using namespace imgmesh;

namespace {

constexpr int kSocket = 3;
// Without work it ends: somebody may wait for all children of the process that has started it. Starting anew
// is a small part of what has then passed.
constexpr struct timespec kIdle = {3, 0};

struct RunningJob {
    pid_t process;
    FileDescriptor socket;  // the job's own, for the case that it dies
};

void on_child(int) {}  // wakes ppoll()

void set_up_process() {
    const struct rlimit no_core = {0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    // What a terminal sends to all its processes is for imgmesh, and this program ends with it.
    for (const int signal : {SIGINT, SIGQUIT, SIGHUP, SIGTERM, SIGTSTP, SIGPIPE, SIGXFSZ})
        std::signal(signal, SIG_IGN);
    struct sigaction action = {};
    action.sa_handler = on_child;
    ::sigaction(SIGCHLD, &action, nullptr);
    sigset_t child;
    ::sigemptyset(&child);
    ::sigaddset(&child, SIGCHLD);
    ::sigprocmask(SIG_BLOCK, &child, nullptr);
}

// What libraries say of images is not for people. Only now: of what ends this program before, imgmesh tells.
void be_silent() {
#ifndef IMGMESH_SANITIZED  // which writes there what it has found
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
#endif
}

// Whether another thread than this one is at work. Threads may end while their folder is read, so none of the
// steps may throw: the operator ++ of an iterator would, and so would an iterator over the text of a file
// whose thread ends between open() and read().
bool other_threads_work() {
    std::error_code failed;
    std::filesystem::directory_iterator thread("/proc/self/task", failed);
    if (failed) return false;  // nobody knows
    for (; !failed && thread != std::filesystem::directory_iterator(); thread.increment(failed)) {
        if (thread->path().filename() == std::to_string(::getpid())) continue;
        std::ifstream file(thread->path() / "stat");
        std::string text;
        std::getline(file, text, '\0');  // all of it; a thread's name may hold a line feed
        if (text.find(") S ") == std::string::npos) return true;
    }
    return bool(failed);
}

// Waits until all other threads sleep. A library's threads have nothing to do, and OpenImageIO's pool has
// only just ended one, but as they start and end they hold locks. A fork in that moment would keep such a
// lock, and jobs were seen to wait for ever for one.
void wait_for_threads() {
    constexpr int kSteps = 1000;
    constexpr struct timespec kStep = {0, 1000000};
    for (int step = 0; step < kSteps; ++step) {
        if (!other_threads_work()) return;
        ::nanosleep(&kStep, nullptr);
    }
}

// A file that becomes readable when imgmesh has ended; -1 where the system has none. The socket's end tells
// the same, unless imgmesh has forked and the copy still holds it.
int open_parent() {
#ifdef SYS_pidfd_open
    return static_cast<int>(::syscall(SYS_pidfd_open, ::getppid(), 0));
#else
    return -1;
#endif
}

class Server {
  public:
    [[noreturn]] void serve() {
        const FileDescriptor parent(open_parent());
        sigset_t none;
        ::sigemptyset(&none);
        for (;;) {
            std::vector<struct pollfd> wait = {{kSocket, POLLIN, 0}, {parent.get(), POLLIN, 0}};
            for (const RunningJob& job : jobs_) wait.push_back({job.socket.get(), 0, 0});  // POLLHUP alone
            const int ready = ::ppoll(wait.data(), wait.size(), jobs_.empty() ? &kIdle : nullptr, &none);
            if (ready == 0) end();
            if (ready > 0) {
                if (wait[1].revents) end();
                for (std::size_t i = 0; i < jobs_.size(); ++i)
                    if (wait[2 + i].revents) ::kill(jobs_[i].process, SIGKILL);  // nobody waits for it
                if (wait[0].revents) take_job();
            }
            bury();
        }
    }

  private:
    [[noreturn]] void end() {
        for (const RunningJob& job : jobs_) ::kill(job.process, SIGKILL);
        ::_exit(0);
    }

    void take_job() {
        JobMessage message;
        std::vector<FileDescriptor> files(2);
        if (receive_message(kSocket, message, &files, std::chrono::milliseconds(0)) != Received::kMessage)
            end();
        FileDescriptor socket = std::move(files[0]);
        if (message.magic != kCodecMagic || message.protocol != kCodecProtocol) {
            send_message(socket.get(), error_reply(static_cast<int>(ErrorKind::kUnsupported),
                                                   "imgmesh-codecs is of another version of imgmesh"));
            return;
        }
        const pid_t self = ::getpid();
        const pid_t process = ::fork();
        if (process == 0) {
            // With this program, which lets go of a job when imgmesh does.
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (::getppid() != self) ::_exit(0);
            ::close(kSocket);
            jobs_.clear();
            do_job(message, std::move(socket), std::move(files[1]));
        }
        if (process < 0)
            send_message(socket.get(), error_reply(static_cast<int>(ErrorKind::kIo),
                                                   "imgmesh-codecs cannot start a process"));
        else
            jobs_.push_back({process, std::move(socket)});
    }

    // Tells of jobs that have ended as they should not.
    void bury() {
        std::erase_if(jobs_, [](const RunningJob& job) {
            int status = 0;
            if (::waitpid(job.process, &status, WNOHANG) != job.process) return false;
            if (status != 0) {
                ReplyMessage reply{.kind = ReplyKind::kDied};
                reply.code = status;
                send_message(job.socket.get(), reply);
            }
            return true;
        });
    }

    std::vector<RunningJob> jobs_;
};

}  // namespace

int main() {
    int type = 0;
    socklen_t size = sizeof(type);
    if (::getsockopt(kSocket, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
        std::fputs("imgmesh-codecs: error: is a part of imgmesh, which starts it when it is needed\n",
                   stderr);
        return 2;
    }
    set_up_process();
    try {
        prepare_oiio();
        wait_for_threads();
    } catch (const std::exception& error) {  // no memory, or no further thread
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    be_silent();
    Server().serve();
}
