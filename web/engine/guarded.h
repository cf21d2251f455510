// Errors of C++ as errors of JavaScript.
#pragma once

#include <utility>

namespace imgmesh::web {

/// Throws the exception that is being handled as an ImgmeshError of JavaScript, with its kind and text.
[[noreturn]] void throw_as_script_error();

/// Returns the result of `work`; what it throws reaches the caller in JavaScript as an ImgmeshError. What a
/// callback of JavaScript throws passes through unchanged.
template <typename Work>
auto guarded(Work&& work) -> decltype(work()) {
    try {
        return std::forward<Work>(work)();
    } catch (const std::exception&) {
        throw_as_script_error();
    }
}

}  // namespace imgmesh::web
