#include "tools/common/huge_pages.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace imgmesh {
void use_huge_pages() {}
}  // namespace imgmesh

#ifndef IMGMESH_SANITIZED  // sanitizers have an operator new of their own
namespace {

constexpr std::size_t kPage = std::size_t{1} << 21;

void* allocate(std::size_t size, std::size_t alignment) {
    const bool large = size >= kPage;
    if (large) alignment = std::max(alignment, kPage);
    for (;;) {
        void* block = nullptr;
        if (alignment <= alignof(std::max_align_t))
            block = std::malloc(std::max<std::size_t>(size, 1));
        else if (::posix_memalign(&block, alignment, size) != 0)
            block = nullptr;
        if (block) {
            // The rest of a page stays in small pages. A kernel without huge pages refuses; then there are
            // none.
            if (large) ::madvise(block, size / kPage * kPage, MADV_HUGEPAGE);
            return block;
        }
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

}  // namespace

#if defined(__GNUC__) && !defined(__clang__)
// g++ 12 inlines one half of such a pair and not the other, and then takes them for a mismatch.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t size) {
    return allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept {
    std::free(block);
}
void operator delete(void* block, std::size_t) noexcept {
    std::free(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
    std::free(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
    std::free(block);
}
#endif
