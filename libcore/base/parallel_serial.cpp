// One thread, for where there are no more: WebAssembly on a page of any host.
#include "libcore/base/interrupt.h"
#include "libcore/base/parallel.h"

namespace imgmesh {

struct ThreadLimit::Control {};

ThreadLimit::ThreadLimit(int /*threads*/) {}
ThreadLimit::~ThreadLimit() = default;

int hardware_threads() {
    return 1;
}

void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body) {
    for (int first = begin; first < end;) {
        check_interrupt();
        const int last = end - first > grain ? first + grain : end;
        body(first, last);
        first = last;
    }
}

}  // namespace imgmesh
