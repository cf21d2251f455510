// Other libraries' exceptions as Errors.
#pragma once

#include <exception>
#include <new>
#include <string>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// Calls `work`, and gives what it gives. What another library throws in it becomes Error(kind) with the
/// text "WHAT: the library's reason", one line. Errors of ours and a lack of memory pass as they are.
template <typename Work>
auto translate_errors(ErrorKind kind, const std::string& what, Work&& work) {
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(kind, cat(what, ": ", one_line(error.what())));
    }
}

}  // namespace imgmesh
