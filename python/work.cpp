#include "python/work.h"

#include <cxxabi.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "libcore/base/error.h"

namespace imgmesh::python {
namespace {

namespace py = pybind11;
using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(50);
constexpr int kMaxThreads = 1024;  // as in the tools
constexpr auto kLongestStop = std::chrono::seconds(5);

// Threads that are at work now, each of which adds to its own depth for work within work.
std::atomic<int> working = 0;
thread_local int depth = 0;
// Set once, by the thread that ends Python.
std::atomic<bool> ending = false;
std::thread::id ending_thread;

bool must_stop() {
    return ending && std::this_thread::get_id() != ending_thread;
}

// The objects of this thread may belong to an interpreter that is gone: nothing may run any more, not even a
// destructor.
[[noreturn]] void stop_for_ever() {
    if (depth > 0) --working;
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

void stop_work() {
    ending_thread = std::this_thread::get_id();
    ending = true;
    const WithoutGil released;
    const Clock::time_point last = Clock::now() + kLongestStop;
    // One of them is this wait.
    while (working > 1 && Clock::now() < last) std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

// Copies of a Progress are made without the GIL; they share this.
struct Callback {
    explicit Callback(py::object callable) : function(std::move(callable)) {}
    ~Callback() {
        with_gil([this] { function = py::object(); });
    }
    Callback(const Callback&) = delete;
    Callback& operator=(const Callback&) = delete;

    py::object function;
    Clock::time_point next = Clock::now();
};

}  // namespace

WithoutGil::WithoutGil() : state_(PyEval_SaveThread()) {
    if (depth++ == 0) ++working;
}

// A Python that is at its end answers a thread that asks for the GIL with pthread_exit(), which unwinds the
// stack as an exception does. It must not get out of here: noexcept functions and destructors that use Python
// would abort the process.
WithoutGil::~WithoutGil() {
    if (must_stop()) stop_for_ever();
    try {
        PyEval_RestoreThread(state_);
    } catch (const abi::__forced_unwind&) {
        stop_for_ever();
    }
    if (--depth == 0) --working;
}

void with_gil(const std::function<void()>& use) {
    if (must_stop()) stop_for_ever();
    try {
        const PyGILState_STATE state = PyGILState_Ensure();
        try {
            use();
        } catch (const abi::__forced_unwind&) {
            stop_for_ever();
        } catch (...) {
            PyGILState_Release(state);
            throw;
        }
        PyGILState_Release(state);
    } catch (const abi::__forced_unwind&) {
        stop_for_ever();
    }
}

void stop_work_at_exit() {
    py::module_::import("atexit").attr("register")(py::cpp_function(stop_work));
}

Progress python_progress(py::object callback) {
    if (!callback.is_none() && !PyCallable_Check(callback.ptr()))
        throw py::type_error("progress: expected a callable of the fraction and the stage");
    if (callback.is_none()) return [](double, std::string_view) { check_signals(); };
    const auto shared = std::make_shared<Callback>(std::move(callback));
    return [shared](double fraction, std::string_view stage) {
        check_signals();
        if (Clock::now() < shared->next && fraction < 1) return;
        with_gil([&] { shared->function(fraction, py::str(stage.data(), stage.size())); });
        shared->next = Clock::now() + kPause;
    };
}

void check_signals() {
    if (must_stop()) stop_for_ever();
    thread_local Clock::time_point next;
    const Clock::time_point now = Clock::now();
    if (now < next) return;
    next = now + kPause;
    with_gil([] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
}

int thread_count(const std::optional<int>& threads) {
    if (!threads) return hardware_threads();
    if (*threads < 1 || *threads > kMaxThreads)
        throw Error(ErrorKind::kBadArgument,
                    cat("threads is ", *threads, ", expected a whole number from 1 to ", kMaxThreads));
    return *threads;
}

}  // namespace imgmesh::python
