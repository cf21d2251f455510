// The arrays of a mesh compressed for EXT_meshopt_compression: decoded faster than Draco's, and by engines
// that have no Draco. Only for assets without pixel maps, as imgmesh does not read it.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "formats/gltf/byte_range.h"
#include "formats/gltf/stored_mesh.h"

namespace imgmesh {

/// One array: where its compressed bytes are, and where a reader that has decoded it finds it.
struct MeshoptView {
    ByteRange encoded;  ///< in the buffer of the file
    ByteRange decoded;  ///< in the fallback buffer, which no file has
    std::uint64_t stride = 0, count = 0;
    bool triangles = false;  ///< indices of triangles; else attributes of vertices
    bool operator==(const MeshoptView&) const = default;
};

/// Returns the mesh with vertices and faces in an order that compresses well, without vertices that no face
/// has. The same faces, with their corners in the same order up to rotation.
StoredMesh ordered_for_meshopt(const StoredMesh& mesh);

/// Appends arrays to a buffer, compressed without loss; of triangles the first corners may change. The same
/// arrays give the same bytes.
class MeshoptWriter {
  public:
    explicit MeshoptWriter(std::vector<std::uint8_t>& buffer) : buffer_(buffer) {}

    /// Returns where the decoded array is in the fallback buffer. Values have 4 to 256 bytes, a multiple
    /// of 4.
    template <typename T>
    ByteRange add(const std::vector<T>& values) {
        const std::span bytes(reinterpret_cast<const std::uint8_t*>(values.data()),
                              values.size() * sizeof(T));
        if constexpr (std::is_same_v<T, Face>) return add_array(bytes, sizeof(Id), true);
        return add_array(bytes, sizeof(T), false);
    }

    const std::vector<MeshoptView>& views() const { return views_; }
    std::uint64_t fallback_length() const { return fallback_; }

  private:
    ByteRange add_array(std::span<const std::uint8_t> bytes, std::size_t stride, bool triangles);

    std::vector<std::uint8_t>& buffer_;
    std::vector<MeshoptView> views_;
    std::uint64_t fallback_ = 0;
};

}  // namespace imgmesh
