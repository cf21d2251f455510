// Ctrl-C that ends a batch with a report.
#pragma once

#include <functional>
#include <thread>

namespace imgmesh {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP calls `ended` on a thread of its own instead of ending
/// the process; the process ends by that signal when `ended` returns. The second one ends it at once. Signals
/// that the process ignores stay ignored. One at a time.
class Interruption {
  public:
    explicit Interruption(std::function<void(int signal)> ended);
    /// If a signal has come, does not return: the process ends.
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

  private:
    void watch(const std::function<void(int)>& ended) const;

    int pipe_[2];
    std::thread watcher_;
};

}  // namespace imgmesh
