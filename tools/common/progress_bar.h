// Shows the progress of the work on a terminal.
#pragma once

#include <chrono>
#include <mutex>
#include <string_view>

namespace imgmesh {

/// One line on standard error, redrawn in place: a bar, the stage and the time left. It appears only after a
/// second of work, and disappears before anything else is printed.
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
    /// Clears the line and calls `print`, during which no other thread draws.
    template <typename Print>
    void above(Print&& print) {
        const std::lock_guard lock(mutex_);
        erase();
        print();
    }

  private:
    using Clock = std::chrono::steady_clock;

    void erase();

    std::mutex mutex_;
    bool enabled_;
    bool visible_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point next_ = start_ + std::chrono::seconds(1);
};

}  // namespace imgmesh
