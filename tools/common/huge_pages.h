// Large blocks of memory in large pages.
#pragma once

namespace imgmesh {

/// Links a global operator new into the tool that asks the kernel for large pages (2 MiB, where transparent
/// huge pages are there on request or always) for blocks that hold one or more: page by page an image's
/// memory costs a fifth of a build (docs/performance.md). Nothing to call at run time; calling it makes the
/// linker take it in. Not with a sanitizer, which has an operator new of its own.
void use_huge_pages();

}  // namespace imgmesh
