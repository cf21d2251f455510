// Where this module finds imgmesh-codecs: as the folders of the build and of an installation lie to its own.
#include <dlfcn.h>
#include <unistd.h>

#include <string>

extern "C" const char* imgmesh_linked_codecs();

namespace {

std::string beside_this_module() {
    Dl_info info = {};
    if (::dladdr(reinterpret_cast<const void*>(&imgmesh_linked_codecs), &info) == 0 || !info.dli_fname)
        return {};
    const std::string module = info.dli_fname, folder = module.substr(0, module.rfind('/'));
    if (!module.starts_with('/')) return {};
    for (const char* up : {IMGMESH_CODECS_BUILT, IMGMESH_CODECS_INSTALLED}) {
        const std::string path = folder + "/" + up;
        if (::access(path.c_str(), X_OK) == 0) return path;
    }
    return {};
}

}  // namespace

extern "C" const char* imgmesh_linked_codecs() {
    static const std::string path = beside_this_module();
    return path.c_str();
}
