// Large vectors whose memory all threads touch together. The kernel makes and clears pages when they are
// first touched, which is most of the time that a fresh vector takes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "libcore/base/parallel.h"

namespace imgmesh {

/// Touches the pages of fresh memory on all threads. The content does not matter yet.
inline void touch_pages(void* memory, std::size_t bytes) {
    constexpr std::size_t kPage = 4096, kGrain = 512;  // 512 pages are one huge page
    parallel_blocks(0, static_cast<int>(bytes / kPage), kGrain, [&](int first, int last) {
        for (int page = first; page < last; ++page)
            static_cast<volatile char*>(memory)[static_cast<std::size_t>(page) * kPage] = 0;
    });
}

/// Returns std::vector<T>(size, value).
template <class T>
std::vector<T> parallel_vector(std::size_t size, const T& value = {}) {
    std::vector<T> vector;
    vector.reserve(size);
    touch_pages(vector.data(), size * sizeof(T));
    // Block by block, as bytes. One by one, g++ 12 makes a store and a load of it for each value: 6 ns for a
    // PixelCoord instead of 0.5.
    const std::vector<T> block(std::min<std::size_t>(size, 1024), value);
    while (vector.size() < size) {
        const auto count = std::min(block.size(), size - vector.size());
        vector.insert(vector.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return vector;
}

/// Returns a copy.
template <class T>
std::vector<T> parallel_copy(const std::vector<T>& from) {
    std::vector<T> vector;
    vector.reserve(from.size());
    touch_pages(vector.data(), from.size() * sizeof(T));
    vector.assign(from.begin(), from.end());
    return vector;
}

}  // namespace imgmesh
