#include "tools/common/container_input.h"

#include "formats/files/extension.h"
#include "libcore/base/error.h"

namespace imgmesh {

bool is_container(const std::string& path) {
    const std::string extension = lower_extension(path);
    return extension == ".glb" || extension == ".gltf";
}

void check_level(const std::string& option, std::int64_t level, const std::string& path,
                 const MeshImage& mesh_image) {
    const auto levels = static_cast<std::int64_t>(mesh_image.levels.size());
    if (level >= levels)
        throw Error(ErrorKind::kBadArgument,
                    cat(option, " ", level, ": ", path, " has levels 0 to ", levels - 1));
}

}  // namespace imgmesh
