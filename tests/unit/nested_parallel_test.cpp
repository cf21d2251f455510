#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>

#include "libcore/base/parallel.h"

using namespace imgmesh;

// A thread that waits for an inner loop would otherwise start more outer blocks on top of its own, each with
// all its memory. Two threads never get there, so the arena has six on any machine. Blocks of uneven length
// make some threads wait for others.
TEST_CASE("parallel_blocks: a thread is in one outer block at a time") {
    static thread_local int depth = 0;
    std::mutex mutex;
    int deepest = 0, done = 0;
    const ThreadLimit threads(6);
    tbb::task_arena arena(6);
    arena.execute([&] {
        parallel_blocks(0, 64, 1, [&](int outer, int) {
            ++depth;
            parallel_blocks(0, 16, 1, [&](int inner, int) {
                std::this_thread::sleep_for(std::chrono::microseconds(100 * ((outer * 7 + inner * 13) % 11)));
            });
            const std::lock_guard lock(mutex);
            deepest = std::max(deepest, depth--);
            ++done;
        });
    });
    CHECK(done == 64);
    CHECK(deepest == 1);
}
