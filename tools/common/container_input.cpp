#include "tools/common/container_input.h"

#include <unistd.h>

#include <array>
#include <string_view>

#include "formats/files/extension.h"
#include "formats/files/stream_file.h"
#include "libcore/base/error.h"

namespace imgmesh {

bool is_container(const std::string& path) {
    const std::string extension = lower_extension(path);
    if (const int stream = stream_descriptor(path); stream >= 0 && extension.empty()) {
        std::array<char, 4> start = {};
        const auto size = static_cast<ssize_t>(start.size());
        return ::pread(stream, start.data(), start.size(), 0) == size &&
               std::string_view(start.data(), start.size()) == "glTF";
    }
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
