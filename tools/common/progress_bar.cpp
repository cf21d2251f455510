#include "tools/common/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <string>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A line that wraps could not be redrawn in place.
constexpr std::size_t kUsualWidth = 80;

std::size_t terminal_width() {
    struct winsize size = {};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualWidth;
}

// The text's first bytes, without a part of a character in UTF-8.
std::string cut(const std::string& text, std::size_t bytes) {
    if (text.size() <= bytes) return text;
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
    return text.substr(0, bytes);
}

// What is left at the speed so far, in words.
std::string time_left(double seconds, double fraction) {
    constexpr double kLeastSeconds = 2, kLeastFraction = 0.02;  // before, the speed means nothing
    if (seconds < kLeastSeconds || fraction < kLeastFraction || fraction >= 1) return "";
    const auto left = static_cast<std::int64_t>(seconds * (1 - fraction) / fraction) + 1;
    if (left < 60) return cat(", ", left, " s left");
    if (left < 3600) return cat(", ", (left + 30) / 60, " min left");
    return cat(", ", left / 3600, " h ", left % 3600 / 60, " min left");
}

}  // namespace

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
    const std::string head = cat('[', bar, "] ", static_cast<int>(fraction * 100), "% ");
    const std::string left = time_left(std::chrono::duration<double>(now - start_).count(), fraction);
    const std::size_t width = terminal_width() - 1, taken = head.size() + left.size();
    // \033[K clears the rest of the line, which may still have a longer stage name.
    std::cerr << '\r' << cut(head + cut(std::string(stage), width - std::min(taken, width)) + left, width)
              << "\033[K" << std::flush;
}

void ProgressBar::clear() {
    const std::lock_guard lock(mutex_);
    erase();
}

void ProgressBar::erase() {
    if (visible_) std::cerr << "\r\033[K" << std::flush;
    visible_ = false;
}

}  // namespace imgmesh
