// Shows the progress of the work on a terminal.
#pragma once

#include <chrono>
#include <mutex>
#include <string_view>

namespace imgmesh {

/// One line on standard error, redrawn in place. It appears only after a second of work, and disappears
/// before anything else is printed.
class ProgressBar {
  public:
    /// A bar that is not `enabled` never draws.
    explicit ProgressBar(bool enabled) : enabled_(enabled) {}
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// `fraction` is the share of the whole in [0, 1]. Any thread may call it.
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
