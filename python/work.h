// Work without the GIL: other Python threads run meanwhile, and Ctrl-C ends it.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <utility>

#include "libcore/base/interrupt.h"
#include "libcore/base/parallel.h"
#include "libcore/base/progress.h"

namespace imgmesh::python {

/// Returns a progress function that, a few times a second, takes the GIL and calls `callback` (None, or a
/// callable of the fraction and the stage). It throws what that raises, and so ends the work.
Progress python_progress(pybind11::object callback);

/// Lets Python handle signals, if it has not done so for some time, and throws what they raise. For
/// InterruptCheck, without the GIL.
void check_signals();

/// Returns the number of threads that was asked for, all for none. Throws Error(kBadArgument) unless it is
/// from 1 to 1024.
int thread_count(const std::optional<int>& threads);

/// While it lives, this thread is without the GIL. A thread that Python will not let back in, as it is at its
/// end, stops here for ever instead: it ends with the process.
class WithoutGil {
  public:
    WithoutGil();
    ~WithoutGil();
    WithoutGil(const WithoutGil&) = delete;
    WithoutGil& operator=(const WithoutGil&) = delete;

  private:
    PyThreadState* state_;
};

/// Calls `use` with the GIL, from a thread that may or may not have it, and throws what that throws. Stops
/// for ever as WithoutGil does.
void with_gil(const std::function<void()>& use);

/// Makes Python stop the work of daemon threads before it ends.
void stop_work_at_exit();

/// Returns the result of `work`, done without the GIL by at most `threads` threads. Ctrl-C ends it.
template <typename Work>
auto without_gil(const std::optional<int>& threads, Work&& work) {
    const ThreadLimit limit(thread_count(threads));
    const WithoutGil released;
    const InterruptCheck check(check_signals);
    return std::forward<Work>(work)();
}

}  // namespace imgmesh::python
