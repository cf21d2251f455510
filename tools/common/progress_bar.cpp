#include "tools/common/progress_bar.h"

#include <algorithm>
#include <iostream>
#include <string>

namespace imgmesh {

void ProgressBar::show(double fraction, std::string_view stage) {
    if (!enabled_) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    visible_ = true;

    constexpr int kCells = 30;
    fraction = std::clamp(fraction, 0.0, 1.0);
    const auto full = static_cast<std::size_t>(fraction * kCells);
    const std::string bar = std::string(full, '#') + std::string(kCells - full, '.');
    // \033[K clears the rest of the line, which may still have a longer stage name.
    std::cerr << "\r[" << bar << "] " << static_cast<int>(fraction * 100) << "% " << stage << "\033[K"
              << std::flush;
}

void ProgressBar::clear() {
    const std::lock_guard lock(mutex_);
    if (visible_) std::cerr << "\r\033[K" << std::flush;
    visible_ = false;
}

}  // namespace imgmesh
