// Arrays for numpy: .npy of one, .npz of several. Target imgmesh::pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace imgmesh {

/// An array whose last index runs fastest.
struct NumpyArray {
    std::string name;  ///< in an .npz
    std::string type;  ///< numpy's name of the numbers without the order of bytes: f4, u4, S3, ...
    std::vector<std::size_t> shape;
    std::span<const std::uint8_t> bytes;  ///< of this machine's order
};

/// Returns the bytes of values, for NumpyArray::bytes.
template <typename Values>
std::span<const std::uint8_t> bytes_of(const Values& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

/// Writes an .npy, version 1.0 (numpy's format document); the name does not count. The file appears whole or
/// not at all. Throws Error(kIo) if it cannot be written, or exists and `overwrite` is false.
void write_npy(const std::string& path, const NumpyArray& array, bool overwrite);

/// Writes an .npz, a ZIP of .npy that are not compressed, as numpy.savez() does; the same arrays give the
/// same bytes. Throws as write_npy(), and Error(kUnsupported) above 4 GB, which ZIP's plain form holds.
void write_npz(const std::string& path, std::span<const NumpyArray> arrays, bool overwrite);

}  // namespace imgmesh
