// Large blocks of memory in huge pages.
#pragma once

namespace imgmesh {

/// Links into the tool a global operator new that asks the kernel for huge pages (2 MiB, if transparent huge
/// pages are available on request or always) for blocks that hold one or more. With small pages an image's
/// memory costs a fifth of a build (docs/performance.md). It does nothing at run time; the call makes the
/// linker include it. Not with a sanitizer, which has an operator new of its own.
void use_huge_pages();

}  // namespace imgmesh
