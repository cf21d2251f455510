#include "libcore/base/interrupt.h"

#include <utility>

namespace imgmesh {
namespace {

// That of this thread's InterruptCheck; null on threads that only help.
thread_local const std::function<void()>* interrupt_check = nullptr;

}  // namespace

InterruptCheck::InterruptCheck(std::function<void()> check)
    : check_(std::move(check)), outer_(std::exchange(interrupt_check, &check_)) {}
InterruptCheck::~InterruptCheck() {
    interrupt_check = outer_;
}

void check_interrupt() {
    if (interrupt_check) (*interrupt_check)();
}

}  // namespace imgmesh
