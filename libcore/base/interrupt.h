// Work that can be ended from outside.
#pragma once

#include <functional>

namespace imgmesh {

/// While it lives, all of imgmesh calls `check` on this thread each time that it begins a piece of parallel
/// work here: many times a second in long work. What `check` throws ends the work and comes out of it; no
/// result is left, and no file. One at a time in a thread; the inner one counts.
class InterruptCheck {
  public:
    explicit InterruptCheck(std::function<void()> check);
    ~InterruptCheck();
    InterruptCheck(const InterruptCheck&) = delete;
    InterruptCheck& operator=(const InterruptCheck&) = delete;

  private:
    std::function<void()> check_;
    const std::function<void()>* outer_;
};

/// Calls the check of this thread's InterruptCheck, if there is one. For those who begin pieces of work.
void check_interrupt();

}  // namespace imgmesh
