#include "formats/picture/decode/pnm_rows.h"

#include "formats/picture/decode/pam_header.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

int bits_of(std::int64_t largest) {
    return largest > 255 ? 16 : 8;
}

PnmRows pam_rows(const std::string& path, PnmText& text) {
    const PamHeader header = pam_header(path, text);
    PnmRows rows;
    rows.width = header.width;
    rows.height = header.height;
    rows.bits = bits_of(header.largest);
    constexpr std::int64_t kMost = 1 << 16;  // more than any limit of channels
    if (header.depth > kMost)
        throw Error(ErrorKind::kBadFile, cat(path, ": the PAM's DEPTH is ", header.depth));
    rows.channels = static_cast<int>(header.depth);
    rows.before = "P7\nWIDTH ";
    rows.between = "\nHEIGHT ";
    rows.after = cat("\nDEPTH ", header.depth, "\nMAXVAL ", header.largest,
                     header.type.empty() ? "" : "\nTUPLTYPE ", header.type, "\nENDHDR\n");
    return rows;
}

}  // namespace

std::vector<std::uint8_t> PnmRows::header(int of_width, int of_height) const {
    const std::string text = cat(before, of_width, between, of_height, after);
    return {text.begin(), text.end()};
}

std::optional<PnmRows> pnm_rows(const std::string& path, std::span<const std::uint8_t> start) {
    PnmText text(path, start.subspan(2));
    const auto at = [&] { return start.size() - text.rest().size(); };
    const char kind = static_cast<char>(start[1]);
    if (kind == '7') {
        PnmRows rows = pam_rows(path, text);
        rows.pixels = at();
        return rows;
    }
    const bool floats = kind == 'F' || kind == 'f';
    if (!floats && kind < '4') return {};
    PnmRows rows;
    rows.width = text.number("width");
    rows.height = text.number("height");
    const std::size_t rest = at();
    rows.channels = kind == '6' || kind == 'F' ? 3 : 1;
    if (floats) {
        text.real("scale");
        rows.bits = 32;
        rows.bottom_up = true;
    } else {
        rows.bits = kind == '4' ? 1 : bits_of(text.number("largest value"));
    }
    text.end_header();
    rows.pixels = at();
    rows.before = {'P', kind, ' '};
    rows.between = " ";
    rows.after.assign(start.begin() + static_cast<std::ptrdiff_t>(rest),
                      start.begin() + static_cast<std::ptrdiff_t>(rows.pixels));
    return rows;
}

}  // namespace imgmesh
