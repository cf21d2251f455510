#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "libcore/base/interrupt.h"
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

// What the check throws comes out of the loop, and later loops run as always. Other threads ask nothing.
TEST_CASE("InterruptCheck: ends parallel work of its own thread") {
    int asked = 0;
    {
        const InterruptCheck check([&] {
            if (++asked == 3) throw std::runtime_error("enough");
        });
        const auto loop = [] { parallel_blocks(0, 1000, 1, [](int, int) {}); };
        std::thread(loop).join();
        CHECK(asked == 0);
        const auto work = [&] {
            for (int i = 0; i < 1000; ++i) loop();
        };
        CHECK_THROWS_WITH_AS(work(), "enough", std::runtime_error);
        CHECK(asked == 3);
        const InterruptCheck inner([] {});
        loop();
        CHECK(asked == 3);
    }
    parallel_blocks(0, 10, 1, [](int, int) {});
    CHECK(asked == 3);
}
