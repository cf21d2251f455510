// Source: TIFF 6.0, sections 2 to 4; "TIFF Technical Note 2", Adobe's deflate.
#include "formats/export/label_tiff.h"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>
#include <string_view>

#include "formats/files/byte_writer.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& out, std::uint64_t value, int count) {
    append_number(out, value, count, ByteOrder::kLittle);
}

// A field of the directory. The value, or where it is, stands in 4 bytes.
enum FieldType : int { kAscii = 2, kShort = 3, kLong = 4 };
void append_field(Bytes& out, int tag, FieldType type, std::uint64_t count, std::uint64_t value) {
    append(out, static_cast<std::uint64_t>(tag), 2);
    append(out, static_cast<std::uint64_t>(type), 2);
    append(out, count, 4);
    append(out, value, 4);
}

}  // namespace

std::vector<std::uint8_t> tiff_from_labels(int width, int height, std::span<const Id> labels) {
    constexpr int kLevel = 6;  // as zlib's usual one
    constexpr std::size_t kStrip = 256 << 10;
    constexpr std::string_view kNoData("4294967295\0", 11);
    const std::size_t row = as_index(width);
    const std::size_t rows = std::clamp<std::size_t>(kStrip / (row * sizeof(Id)), 1, as_index(height));
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> packer(
        libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
    if (!packer) throw std::bad_alloc();

    Bytes out = {'I', 'I', 42, 0, 0, 0, 0, 0};
    std::vector<std::size_t> offsets, sizes;
    for (std::size_t top = 0; top < as_index(height); top += rows) {
        const auto strip = labels.subspan(top * row, std::min(rows, as_index(height) - top) * row);
        Bytes bytes;
        bytes.reserve(strip.size_bytes());
        for (const Id label : strip) append(bytes, label, 4);
        const std::size_t most = libdeflate_zlib_compress_bound(packer.get(), bytes.size()), at = out.size();
        out.resize(at + most);
        const std::size_t size =
            libdeflate_zlib_compress(packer.get(), bytes.data(), bytes.size(), out.data() + at, most);
        out.resize(at + size);
        offsets.push_back(at);
        sizes.push_back(size);
    }
    if (out.size() % 2 != 0) out.push_back(0);
    const std::size_t no_data_at = out.size();
    out.insert(out.end(), kNoData.begin(), kNoData.end());
    if (out.size() % 2 != 0) out.push_back(0);
    const auto append_list = [&](const std::vector<std::size_t>& list) {
        const std::size_t at = out.size();
        for (const std::size_t number : list) append(out, number, 4);
        return list.size() == 1 ? list[0] : at;  // one number stands in the field itself
    };
    const std::size_t offsets_at = append_list(offsets), sizes_at = append_list(sizes);

    const std::size_t directory = out.size();
    for (int i = 0; i < 4; ++i) out[as_index(4 + i)] = static_cast<std::uint8_t>(directory >> 8 * i);
    constexpr int kFields = 12;
    append(out, kFields, 2);
    append_field(out, 256, kLong, 1, row);
    append_field(out, 257, kLong, 1, as_index(height));
    append_field(out, 258, kShort, 1, 32);  // bits a sample
    append_field(out, 259, kShort, 1, 8);   // deflate
    append_field(out, 262, kShort, 1, 1);   // 0 is black
    append_field(out, 273, kLong, offsets.size(), offsets_at);
    append_field(out, 277, kShort, 1, 1);  // samples a pixel
    append_field(out, 278, kLong, 1, rows);
    append_field(out, 279, kLong, sizes.size(), sizes_at);
    append_field(out, 284, kShort, 1, 1);  // samples of a pixel side by side
    append_field(out, 339, kShort, 1, 1);  // unsigned integers
    append_field(out, 42113, kAscii, kNoData.size(), no_data_at);
    append(out, 0, 4);
    return out;
}

}  // namespace imgmesh
