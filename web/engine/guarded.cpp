#include "web/engine/guarded.h"

#include <emscripten.h>

#include <exception>
#include <new>
#include <string>

#include "libcore/base/error.h"

namespace imgmesh::web {
namespace {

// clang-format off
EM_JS(void, throw_script_error, (const char* kind, const char* text), {
    const error = new Error(UTF8ToString(text));
    error.name = "ImgmeshError";
    error.kind = UTF8ToString(kind);
    throw error;
});
// clang-format on

const char* kind_name(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::kInternal:
            return "internal";
        case ErrorKind::kBadArgument:
            return "argument";
        case ErrorKind::kIo:
            return "io";
        case ErrorKind::kBadFile:
            return "file";
        case ErrorKind::kUnsupported:
            return "unsupported";
    }
    return "internal";
}

}  // namespace

void throw_as_script_error() {
    std::string kind = "internal", text = "unknown error";
    try {
        throw;
    } catch (const Error& error) {
        kind = kind_name(error.kind());
        text = error.what();
    } catch (const std::bad_alloc&) {
        kind = "memory";
        text = "the image needs more memory than there is";
    } catch (const std::exception& error) {
        text = error.what();
    }
    throw_script_error(kind.c_str(), text.c_str());
    __builtin_unreachable();
}

}  // namespace imgmesh::web
