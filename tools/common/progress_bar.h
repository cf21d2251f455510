// How far the work is, for someone who watches a terminal.
#pragma once

#include <chrono>
#include <mutex>
#include <string_view>

namespace imgmesh {

/// One line on standard error, redrawn in place. It shows up only when the work has taken a second, and goes
/// away before anything else is printed.
class ProgressBar {
  public:
    /// A bar that is not `enabled` never draws.
    explicit ProgressBar(bool enabled) : enabled_(enabled) {}
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// `fraction` of the whole in [0, 1]. Any thread.
    void show(double fraction, std::string_view stage);
    void clear();

  private:
    using Clock = std::chrono::steady_clock;

    std::mutex mutex_;
    bool enabled_;
    bool visible_ = false;
    Clock::time_point next_ = Clock::now() + std::chrono::seconds(1);
};

}  // namespace imgmesh
