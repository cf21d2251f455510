#include "formats/picture/codecs/codec_program.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>

namespace imgmesh {
namespace {

bool is_program(const std::string& path, struct stat& is) {
    return path.starts_with('/') && ::stat(path.c_str(), &is) == 0 && S_ISREG(is.st_mode) &&
           ::access(path.c_str(), X_OK) == 0;
}

// BIN/../lib/imgmesh/..., if BIN is a folder of that name and the file belongs to the system or to whoever
// owns the running program: next to a program in /tmp anybody might have made such a folder.
std::string beside_this_program() {
    std::array<char, 4096> link{};
    const ssize_t length = ::readlink("/proc/self/exe", link.data(), link.size());
    if (length <= 0 || length == static_cast<ssize_t>(link.size())) return {};
    const std::string self(link.data(), static_cast<std::size_t>(length));
    const std::string folder = self.substr(0, self.rfind('/'));
    const std::string bin = IMGMESH_BIN_FOLDER;
    if (!folder.ends_with("/" + bin)) return {};
    const std::string path = folder.substr(0, folder.size() - bin.size()) + IMGMESH_CODECS_IN_PREFIX;
    struct stat program = {}, own = {};
    if (!is_program(path, program) || ::stat(self.c_str(), &own) != 0) return {};
    return program.st_uid == 0 || program.st_uid == own.st_uid ? path : std::string();
}

}  // namespace

std::string find_codec_program() {
    struct stat ignored = {};
    if (imgmesh_linked_codecs)
        if (const std::string path = imgmesh_linked_codecs(); is_program(path, ignored)) return path;
    if (const std::string path = beside_this_program(); !path.empty()) return path;
    if (const std::string path = IMGMESH_CODECS_PATH; is_program(path, ignored)) return path;
    return {};
}

}  // namespace imgmesh
