#include "formats/container/sidecar_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "formats/container/container.h"
#include "formats/files/sha256.h"
#include "libcore/base/error.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

constexpr std::size_t kHashDigits = 16;  // 64 bits: two contents of one container never collide by chance

bool is_taken(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

bool has_content(const fs::path& path, std::span<const std::uint8_t> bytes) {
    std::error_code error;
    if (!fs::is_regular_file(path, error) || fs::file_size(path, error) != bytes.size() || error)
        return false;
    try {
        const std::vector<std::uint8_t> found = read_file(path.string(), bytes.size(), FileKind::kRegular);
        return std::equal(found.begin(), found.end(), bytes.begin(), bytes.end());
    } catch (const Error&) {
        return false;  // it cannot be read, or is growing: somebody else's
    }
}

// Returns whether a SidecarFile of `path` could have that name.
bool is_sidecar_name(const fs::path& path, const fs::path& name) {
    const std::string stem = path.stem().string(), found = name.stem().string();
    if (name.extension() != ".bin" && name.extension() != sidecar_extension(LayerLayout::kExr) &&
        name.extension() != sidecar_extension(LayerLayout::kCompact))
        return false;
    if (found == stem) return true;
    return found.size() == stem.size() + 1 + kHashDigits && found.starts_with(stem + "-") &&
           found.find_first_not_of("0123456789abcdef", stem.size() + 1) == std::string::npos;
}

}  // namespace

SidecarFile::SidecarFile(const std::string& path, const std::string& extension,
                         std::span<const std::uint8_t> bytes) {
    const fs::path base(path);
    fs::path target = fs::path(path).replace_extension(extension);
    bool stands = has_content(target, bytes);
    if (!stands && is_taken(target)) {
        target = base.parent_path() /
                 cat(base.stem().string(), "-", sha256_hex(bytes).substr(0, kHashDigits), extension);
        stands = has_content(target, bytes);
    }
    name_ = target.filename().string();
    if (stands) return;
    file_ = std::make_unique<AtomicFile>(target.string(), /*overwrite=*/false);
    file_->share_as(path);
    file_->write(bytes);
}

void SidecarFile::place() {
    if (file_) file_->place();
}

void SidecarFile::keep() {
    if (file_) file_->keep();
}

std::vector<std::string> sidecars_of(const std::string& path) {
    std::vector<std::string> files;
    try {
        // Reads the meshes and the layers: a reader accepts them only with the hashes that belong together.
        files = read_container(path).facts.files;
        std::erase_if(files, [&](const std::string& file) { return !is_sidecar_name(path, file); });
    } catch (const std::exception&) {
        // There is no file, or no container that a reader accepts.
    }
    return files;
}

}  // namespace imgmesh
