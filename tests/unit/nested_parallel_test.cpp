#include <doctest/doctest.h>

#include <atomic>
#include <numeric>
#include <vector>

#include "libcore/base/parallel.h"

using namespace imgmesh;

// A thread that waits for an inner loop would otherwise begin further outer blocks on top of the one it is
// in, each with all its memory.
TEST_CASE("parallel_blocks: a thread is in one outer block at a time") {
    thread_local int depth = 0;
    std::atomic<int> deepest = 0;
    std::atomic<int> sum = 0;
    const ThreadLimit limit(4);
    parallel_blocks(0, 64, 1, [&](int, int) {
        ++depth;
        int seen = deepest;
        while (depth > seen && !deepest.compare_exchange_weak(seen, depth)) {
        }
        parallel_blocks(0, 64, 1, [&](int begin, int end) {
            std::vector<double> work(20000);
            std::iota(work.begin(), work.end(), 1.0);
            if (std::accumulate(work.begin(), work.end(), 0.0) > 0) sum += end - begin;
        });
        --depth;
    });
    CHECK(sum == 64 * 64);
    CHECK(deepest == 1);
}
