// Sidecar files of a .gltf. One rename of the .gltf switches from an old container to a new one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/files/atomic_file.h"

namespace imgmesh {

/// A .bin, .exr or .imgmap of the container `path`, a .gltf. It is named x.bin, or x-HASH.bin by its content
/// if another file has that name, so it replaces nothing. An existing file with the same content is used
/// again.
class SidecarFile {
  public:
    /// Writes the content under a temporary name, for those who may read `path`. Throws Error(kIo).
    SidecarFile(const std::string& path, const std::string& extension, std::span<const std::uint8_t> bytes);

    const std::string& name() const { return name_; }  ///< without the folder
    /// Renames it to its name. Until keep() it is removed with this object (AtomicFile::place).
    void place();
    void keep();

  private:
    std::string name_;
    std::unique_ptr<AtomicFile> file_;  ///< null if a file with the content exists already
};

/// Returns the files, with the folder, that belong to the container `path` (a .gltf) alone: they have names
/// that a SidecarFile may have given them, and they are its buffer and its layers by the hashes of all their
/// meshes. Returns none if there is no container that a reader accepts: what a .gltf merely names may be
/// anybody's.
std::vector<std::string> sidecars_of(const std::string& path);

}  // namespace imgmesh
