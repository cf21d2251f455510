#include "libcore/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "libcore/base/interrupt.h"

#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#endif

namespace imgmesh {

struct ThreadLimit::Control {
    tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                               static_cast<std::size_t>(std::max(1, threads)))}) {}
ThreadLimit::~ThreadLimit() = default;

int hardware_threads() {
    return std::max(1, tbb::info::default_concurrency());
}

#if defined(__SANITIZE_THREAD__)
// The distribution's TBB is not built for ThreadSanitizer, which reports races wherever it hands over work.
// With std::thread only our own races are reported.
void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body) {
    std::atomic<int> next{begin};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&] {
        try {
            for (int first; (first = next.fetch_add(grain)) < end;) {
                check_interrupt();
                body(first, std::min(first + grain, end));
            }
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            failure = std::current_exception();
        }
    };
    {
        const std::jthread other(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}
#else
void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body) {
    if (begin >= end) return;
    const int blocks = (end - begin + grain - 1) / grain;
    // A thread that waits for these blocks must not begin a block of an enclosing loop. With one image a
    // block, it would hold several images at a time.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(0, blocks, [&](int b) {
            check_interrupt();
            const int first = begin + b * grain;
            body(first, std::min(first + grain, end));
        });
    });
}
#endif

}  // namespace imgmesh
