// SHA-256 by a library of JavaScript.
#include "formats/files/sha256.h"

#include <array>
#include <limits>

#include "formats/files/atomic_file.h"
#include "libcore/base/error.h"
#include "web/ports/script_libraries.h"

namespace imgmesh {

std::string sha256_hex(std::initializer_list<std::span<const std::uint8_t>> pieces) {
    const emscripten::val hash = web::script_library("sha256").call<emscripten::val>("create");
    for (const auto piece : pieces) hash.call<void>("update", web::view_of(piece));
    std::array<std::uint8_t, 32> digest;
    web::copy_from_script(hash.call<emscripten::val>("digest"), std::span<std::uint8_t>(digest));
    std::string hex;
    for (const unsigned byte : digest) {
        hex += "0123456789abcdef"[byte >> 4];
        hex += "0123456789abcdef"[byte & 15];
    }
    return hex;
}

std::string file_sha256_hex(const std::string& name) {
    try {
        return sha256_hex({read_file(name, std::numeric_limits<std::uint64_t>::max())});
    } catch (const Error&) {
        return "";
    }
}

}  // namespace imgmesh
