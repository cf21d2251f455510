// Translates other libraries' exceptions into Errors.
#pragma once

#include <exception>
#include <new>
#include <string>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// Calls `work` and returns its result. Exceptions of another library become Error(kind) with the text "WHAT:
/// the library's reason", one line. Our own Errors and std::bad_alloc pass unchanged.
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
