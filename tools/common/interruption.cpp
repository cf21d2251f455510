#include "tools/common/interruption.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <utility>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

std::array<struct sigaction, kSignals.size()> g_before;
std::array<bool, kSignals.size()> g_taken;
std::atomic<int> g_pipe = -1;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler uses it");

// Async-signal-safe, as what it calls.
void give_back() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
        if (g_taken[i]) ::sigaction(kSignals[i], &g_before[i], nullptr);
}

extern "C" void tell_watcher(int signal) {
    const int error = errno;
    give_back();  // the next one is for whoever had it before
    const auto number = static_cast<unsigned char>(signal);
    if (::write(g_pipe, &number, 1) != 1) ::raise(signal);
    errno = error;
}

}  // namespace

Interruption::Interruption(std::function<void(int signal)> ended) {
    if (::pipe2(pipe_, O_CLOEXEC) != 0)
        throw Error(ErrorKind::kIo, "cannot make a pipe: too many open files");
    g_pipe = pipe_[1];
    watcher_ = std::thread([this, ended = std::move(ended)] { watch(ended); });
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        g_taken[i] =
            ::sigaction(kSignals[i], nullptr, &g_before[i]) == 0 && g_before[i].sa_handler != SIG_IGN;
        struct sigaction action = {};
        action.sa_handler = tell_watcher;
        action.sa_flags = SA_RESTART;
        if (g_taken[i]) ::sigaction(kSignals[i], &action, nullptr);
    }
}

Interruption::~Interruption() {
    give_back();
    const unsigned char none = 0;
    while (::write(pipe_[1], &none, 1) < 0 && errno == EINTR) {
    }
    watcher_.join();  // after a signal it ends the process
    ::close(pipe_[0]);
    ::close(pipe_[1]);
}

void Interruption::watch(const std::function<void(int)>& ended) const {
    unsigned char signal = 0;
    while (::read(pipe_[0], &signal, 1) < 0 && errno == EINTR) {
    }
    if (signal == 0) return;
    ended(signal);
    ::raise(signal);  // the handler that was there before, which removes temporary files
}

}  // namespace imgmesh
