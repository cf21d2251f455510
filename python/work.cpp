#include "python/work.h"

#include <chrono>
#include <memory>
#include <string>

#include "libcore/base/error.h"

namespace imgmesh::python {
namespace {

namespace py = pybind11;
using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(50);
constexpr int kMaxThreads = 1024;  // as in the tools

// Copies of a Progress are made without the GIL; they share this.
struct Callback {
    explicit Callback(py::object callable) : function(std::move(callable)) {}
    ~Callback() {
        const py::gil_scoped_acquire acquire;
        function = py::object();
    }
    Callback(const Callback&) = delete;
    Callback& operator=(const Callback&) = delete;

    py::object function;
    Clock::time_point next = Clock::now();
};

}  // namespace

Progress python_progress(py::object callback) {
    if (!callback.is_none() && !PyCallable_Check(callback.ptr()))
        throw py::type_error("progress: expected a callable of the fraction and the stage");
    if (callback.is_none()) return [](double, std::string_view) { check_signals(); };
    const auto shared = std::make_shared<Callback>(std::move(callback));
    return [shared](double fraction, std::string_view stage) {
        check_signals();
        if (Clock::now() < shared->next && fraction < 1) return;
        const py::gil_scoped_acquire acquire;
        shared->function(fraction, py::str(stage.data(), stage.size()));
        shared->next = Clock::now() + kPause;
    };
}

void check_signals() {
    thread_local Clock::time_point next;
    const Clock::time_point now = Clock::now();
    if (now < next) return;
    next = now + kPause;
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

int thread_count(const std::optional<int>& threads) {
    if (!threads) return hardware_threads();
    if (*threads < 1 || *threads > kMaxThreads)
        throw Error(ErrorKind::kBadArgument,
                    cat("threads is ", *threads, ", expected a whole number from 1 to ", kMaxThreads));
    return *threads;
}

}  // namespace imgmesh::python
