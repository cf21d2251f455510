// Threads: how many are used, and how work is shared among them. Work is cut into blocks whose bounds depend
// only on the problem, never on the number of threads. So results are the same bytes for any number.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>

namespace imgmesh {

/// Calls body(block_begin, block_end) for consecutive blocks of [begin, end) of `grain` (the last may be
/// shorter), in any order and on any thread. A block must not write to anything that another one touches.
/// Returns when all blocks are done, and throws what a block has thrown.
void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body);

/// Returns the number of hardware threads, at least 1.
int hardware_threads();

/// While this object lives, all of imgmesh in this process uses at most `threads` threads. Values below 1
/// count as 1; the lowest of several limits counts.
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
