// Libraries of JavaScript that stand in for those of C and C++ (web/package/src/libraries.ts).
#pragma once

#include <emscripten/val.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libcore/base/error.h"

namespace imgmesh::web {

using emscripten::val;

/// Returns one of the libraries with which the module was made. Throws Error(kInternal) if it was made
/// without.
inline val script_library(const char* name) {
    const val all = val::module_property("libraries");
    if (all.isUndefined() || all[name].isUndefined())
        throw Error(ErrorKind::kInternal,
                    cat("the engine was made without its library ", name, "; createImgmesh() brings all"));
    return all[name];
}

/// A view for a call alone: whatever takes memory may move the bytes.
inline val view_of(std::span<const std::uint8_t> bytes) {
    return val(emscripten::typed_memory_view(bytes.size(), bytes.data()));
}

/// Copies an array of JavaScript over `out`, which has room for it.
template <typename T>
void copy_from_script(const val& array, std::span<T> out) {
    val(emscripten::typed_memory_view(out.size(), out.data())).call<void>("set", array);
}

}  // namespace imgmesh::web
