#include <dlfcn.h>

#include "formats/files/one_line.h"
#include "formats/picture/oiio_module.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

const OiioModule& load() {
    // By its name alone: the linker has written the search path into the program
    // (formats/CMakeLists.txt).
    void* const module = ::dlopen(IMGMESH_OIIO_MODULE, RTLD_NOW | RTLD_LOCAL);
    void* const entry = module ? ::dlsym(module, kOiioEntry) : nullptr;
    if (!entry) {
        const char* reason = ::dlerror();
        throw Error(ErrorKind::kUnsupported,
                    cat("images other than PNG, JPEG, TIFF, EXR and WebP need OpenImageIO: ",
                        one_line(reason ? reason : "no such module")));
    }
    return *reinterpret_cast<OiioEntry*>(entry)();
}

}  // namespace

const OiioModule& oiio_module() {
    static const OiioModule& module = load();  // if it throws, the next call tries again
    return module;
}

}  // namespace imgmesh
