// Adds a file's name to Errors of libraries that do not know it.
#pragma once

#include <string>
#include <utility>

#include "libcore/base/error.h"

namespace imgmesh {

/// Returns the result of `work`. The text of an Error from it is preceded by `name`, a file or an option.
template <typename Work>
auto in_file(const std::string& name, Work&& work) {
    try {
        return std::forward<Work>(work)();
    } catch (const Error& e) {
        throw Error(e.kind(), cat(name, ": ", e.what()));
    }
}

}  // namespace imgmesh
