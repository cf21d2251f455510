#include "formats/files/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <memory>

#include "libcore/base/error.h"

namespace imgmesh {

std::string sha256_hex(std::initializer_list<std::span<const std::uint8_t>> pieces) {
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    std::array<unsigned char, 32> digest;
    bool done = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
    for (const auto piece : pieces)
        done = done && EVP_DigestUpdate(context.get(), piece.data(), piece.size());
    if (!done || !EVP_DigestFinal_ex(context.get(), digest.data(), nullptr))
        throw Error(ErrorKind::kInternal, "libcrypto has no SHA-256");
    std::string hex;
    for (const unsigned byte : digest) {
        hex += "0123456789abcdef"[byte >> 4];
        hex += "0123456789abcdef"[byte & 15];
    }
    return hex;
}

}  // namespace imgmesh
