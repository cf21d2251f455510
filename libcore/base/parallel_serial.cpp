// One thread, for where there are no more: WebAssembly on a page of any host.
#include <utility>

#include "libcore/base/interrupt.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

const std::function<void()>* interrupt_check = nullptr;

}  // namespace

struct ThreadLimit::Control {};

ThreadLimit::ThreadLimit(int /*threads*/) {}
ThreadLimit::~ThreadLimit() = default;

InterruptCheck::InterruptCheck(std::function<void()> check)
    : check_(std::move(check)), outer_(std::exchange(interrupt_check, &check_)) {}
InterruptCheck::~InterruptCheck() {
    interrupt_check = outer_;
}

int hardware_threads() {
    return 1;
}

void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body) {
    for (int first = begin; first < end;) {
        if (interrupt_check) (*interrupt_check)();
        const int last = end - first > grain ? first + grain : end;
        body(first, last);
        first = last;
    }
}

}  // namespace imgmesh
