// SHA-256 through libcrypto.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

namespace imgmesh {

/// Returns the hash of the pieces, one after the other, in lower-case hex.
std::string sha256_hex(std::initializer_list<std::span<const std::uint8_t>> pieces);
inline std::string sha256_hex(std::span<const std::uint8_t> bytes) {
    return sha256_hex({bytes});
}

/// Returns the hash of a regular file's content; "" if it cannot be read or is of another kind.
std::string file_sha256_hex(const std::string& path);

}  // namespace imgmesh
