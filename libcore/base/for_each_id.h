// Loops over vertices or faces on all threads.
#pragma once

#include "libcore/base/parallel.h"
#include "libcore/base/types.h"

namespace imgmesh {

/// Calls body(id) for 0 <= id < count, in any order and at the same time.
template <class Body>
void for_each_id(std::size_t count, Body&& body) {
    // One call takes a few microseconds in refinement.
    constexpr int kBlock = 32;
    parallel_blocks(0, static_cast<int>(count), kBlock, [&](int begin, int end) {
        for (int id = begin; id < end; ++id) body(static_cast<Id>(id));
    });
}

}  // namespace imgmesh
