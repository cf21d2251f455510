// The files beside a .gltf, so that the one rename of the .gltf switches from an old container to a new one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/files/atomic_file.h"

namespace imgmesh {

/// A .bin or .exr of the container `path`, a .gltf. It is named x.bin, or where another file has that name
/// x-HASH.bin by its content: it replaces nothing. A file that has the content already is used as it is.
class SidecarFile {
  public:
    /// Writes the content under a temporary name. Throws Error(kIo).
    SidecarFile(const std::string& path, const std::string& extension, std::span<const std::uint8_t> bytes);

    const std::string& name() const { return name_; }  ///< without the folder
    /// Gives it its name; until keep() it goes when this object does (AtomicFile::place).
    void place();
    void keep();

  private:
    std::string name_;
    std::unique_ptr<AtomicFile> file_;  ///< null where the content stands already
};

/// The files that the container `path`, a .gltf, refers to and that a SidecarFile of it may have written,
/// with the folder; none where there is no container that a reader accepts.
std::vector<std::string> sidecars_of(const std::string& path);

}  // namespace imgmesh
