// The only place that names the thread library. Work is cut into blocks whose bounds depend on the problem
// alone, never on the number of threads, so results are the same bytes for any number.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

namespace imgmesh {

/// Calls body(block_begin, block_end) for consecutive blocks of [begin, end), `grain` long (the last may be
/// shorter), in any order and on any thread. Blocks must not write to what another block touches.
void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body);

/// Number of hardware threads, at least 1.
int hardware_threads();

/// While it lives, parallel_blocks uses at most `threads` threads (>= 1).
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    struct Control;
    std::unique_ptr<Control> control_;
};

}  // namespace imgmesh
