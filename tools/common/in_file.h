// Errors of libraries that know no file, with the name of the file that they are about.
#pragma once

#include <string>
#include <utility>

#include "libcore/base/error.h"

namespace imgmesh {

/// The result of `work`. The text of an Error that it throws gets `name` before it, a file or an option.
template <typename Work>
auto in_file(const std::string& name, Work&& work) {
    try {
        return std::forward<Work>(work)();
    } catch (const Error& e) {
        throw Error(e.kind(), cat(name, ": ", e.what()));
    }
}

}  // namespace imgmesh
