#include "formats/files/sha256.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <vector>

#include "formats/files/stream_file.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

class Hash {
  public:
    Hash() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
        good_ = context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
    }
    void add(std::span<const std::uint8_t> bytes) {
        good_ = good_ && EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
    }
    std::string hex() {
        std::array<unsigned char, 32> digest;
        if (!good_ || !EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr))
            throw Error(ErrorKind::kInternal, "libcrypto has no SHA-256");
        std::string hex;
        for (const unsigned byte : digest) {
            hex += "0123456789abcdef"[byte >> 4];
            hex += "0123456789abcdef"[byte & 15];
        }
        return hex;
    }

  private:
    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
    bool good_;
};

}  // namespace

std::string sha256_hex(std::initializer_list<std::span<const std::uint8_t>> pieces) {
    Hash hash;
    for (const auto piece : pieces) hash.add(piece);
    return hash.hex();
}

std::string file_sha256_hex(const std::string& name) {
    const std::string path = system_path(name);
    // A pipe that is only opened and closed loses what its writer has begun to write.
    struct stat info = {};
    if (::stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return "";
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (fd < 0) return "";
    ssize_t got = ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode) ? 1 : -1;
    Hash hash;
    std::vector<std::uint8_t> piece(std::size_t{1} << 18);
    while (got > 0) {
        do {
            got = ::read(fd, piece.data(), piece.size());
        } while (got < 0 && errno == EINTR);
        if (got > 0) hash.add({piece.data(), static_cast<std::size_t>(got)});
    }
    ::close(fd);
    return got < 0 ? "" : hash.hex();
}

}  // namespace imgmesh
