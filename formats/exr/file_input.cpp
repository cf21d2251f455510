#include "formats/exr/file_input.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "formats/exr/exr_opaque.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A preview of a megapixel takes 4 MB, names of objects some more.
constexpr std::size_t kMostHeaders = std::size_t{64} << 20;

std::vector<std::uint8_t> safe_headers(const RandomFile& file) {
    for (std::size_t most = std::size_t{1} << 16;; most *= 4) {
        std::vector<std::uint8_t> start = file.bytes_at(0, most);
        const bool all = start.size() < most;
        if (const std::optional<std::size_t> count = make_start_opaque(file.path(), start)) {
            start.resize(*count);
            start.shrink_to_fit();
            return start;
        }
        if (all) throw Error(ErrorKind::kBadFile, cat(file.path(), ": the EXR ends in its header"));
        if (most >= kMostHeaders)
            throw Error(ErrorKind::kBadFile,
                        cat(file.path(), ": the EXR's headers have more than ", kMostHeaders, " bytes"));
    }
}

}  // namespace

FileInput::FileInput(const RandomFile& file)
    : IStream(file.path().c_str()), file_(file), headers_(safe_headers(file)) {}

std::size_t FileInput::copy_from(const std::vector<std::uint8_t>& bytes, std::uint64_t start, char* out,
                                 std::size_t count) const {
    if (at_ < start || at_ - start >= bytes.size()) return 0;
    const auto from = static_cast<std::size_t>(at_ - start);
    const std::size_t n = std::min(count, bytes.size() - from);
    std::memcpy(out, bytes.data() + from, n);
    return n;
}

bool FileInput::read(char* out, int count) {
    constexpr std::size_t kAhead = 4096;
    auto left = static_cast<std::size_t>(std::max(count, 0));
    while (left > 0) {
        std::size_t n = copy_from(headers_, 0, out, left);
        if (n == 0) n = copy_from(ahead_, ahead_at_, out, left);
        if (n == 0 && left >= kAhead) n = file_.read_at(at_, {reinterpret_cast<std::uint8_t*>(out), left});
        if (n == 0 && left < kAhead) {
            ahead_ = file_.bytes_at(at_, kAhead);
            ahead_at_ = at_;
            n = copy_from(ahead_, ahead_at_, out, left);
        }
        if (n == 0) throw std::runtime_error("the file ends too early");
        at_ += n;
        out += n;
        left -= n;
    }
    return at_ < file_.size();
}

}  // namespace imgmesh
