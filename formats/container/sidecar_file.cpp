#include "formats/container/sidecar_file.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "formats/files/sha256.h"
#include "formats/gltf/gltf_asset.h"
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
        const std::vector<std::uint8_t> found = read_file(path.string(), bytes.size());
        return std::equal(found.begin(), found.end(), bytes.begin(), bytes.end());
    } catch (const Error&) {
        return false;  // it cannot be read, or is growing: somebody else's
    }
}

// Returns whether a SidecarFile of `path` could have that name.
bool is_sidecar_name(const fs::path& path, const fs::path& name) {
    const std::string stem = path.stem().string(), found = name.stem().string();
    if (name.extension() != ".bin" && name.extension() != ".exr") return false;
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
        constexpr std::uint64_t kMaxJsonBytes = 1 << 24;  // ours have a few kilobytes
        const std::vector<std::uint8_t> bytes = read_file(path, kMaxJsonBytes);
        const Asset asset = asset_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {});
        for (const std::string& name : {asset.buffer_name, asset.layers_name})
            if (!name.empty() && is_sidecar_name(path, name))
                files.push_back((fs::path(path).parent_path() / name).string());
    } catch (const std::exception&) {
        // There is no file, or no container that a reader accepts.
    }
    return files;
}

}  // namespace imgmesh
