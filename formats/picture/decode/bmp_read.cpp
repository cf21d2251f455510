// BMP by imgmesh itself: OpenImageIO 2.4 takes an unused fourth byte for alpha, ignores masks, and reads
// memory that it has not written for other headers (docs/decisions/0025-own-readers-of-small-formats.md).
#include <algorithm>
#include <bit>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/bmp_header.h"
#include "formats/picture/decode/bmp_runs.h"
#include "formats/picture/decode/picture_decoders.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

// One channel of a pixel.
class Field {
  public:
    explicit Field(std::uint32_t mask)
        : mask_(mask), shift_(mask == 0 ? 0 : std::countr_zero(mask)), largest_(mask >> shift_) {}

    float value(std::uint32_t pixel) const {
        if (largest_ == 0) return 0;
        return static_cast<float>(static_cast<double>((pixel & mask_) >> shift_) / largest_);
    }
    bool is_wide() const { return largest_ > 255; }

  private:
    std::uint32_t mask_;
    int shift_;
    std::uint32_t largest_;
};

struct Rows {
    const std::string& path;
    const BmpHeader& header;
    Bytes pixels;
    std::size_t row_bytes;

    // Throws for missing pixels; warns if only the padding of the last row is missing.
    void check(std::vector<std::string>& warnings) const {
        const auto height = static_cast<std::size_t>(header.height);
        const std::size_t unpadded =
            (static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.bits) + 7) / 8;
        const std::size_t needed = row_bytes * (height - 1) + unpadded;
        if (needed > pixels.size())
            throw Error(ErrorKind::kBadFile, cat(path, ": the BMP is truncated: its pixels take ", needed,
                                                 " bytes, ", pixels.size(), " are left"));
        if (row_bytes * height > pixels.size()) warnings.push_back("the padding of its last row is missing");
    }
    std::size_t begin(int y) const {
        const auto height = static_cast<int>(header.height);
        return static_cast<std::size_t>(header.top_down ? y : height - 1 - y) * row_bytes;
    }
};

std::vector<std::uint16_t> read_indices(const Rows& rows, int width, int height) {
    std::vector<std::uint16_t> indices;
    indices.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const int bits = rows.header.bits;
    for (int y = 0; y < height; ++y) {
        const Bytes row = rows.pixels.subspan(rows.begin(y));
        for (int x = 0; x < width; ++x) {
            const std::size_t bit = static_cast<std::size_t>(x) * static_cast<std::size_t>(bits);
            const unsigned byte = row[bit / 8],
                           shift = 8 - static_cast<unsigned>(bit % 8 + static_cast<std::size_t>(bits));
            indices.push_back(static_cast<std::uint16_t>(byte >> shift & ((1u << bits) - 1)));
        }
    }
    return indices;
}

Image read_colors(const Rows& rows, int width, int height) {
    const auto& masks = rows.header.masks;
    const Field fields[] = {Field(masks[0]), Field(masks[1]), Field(masks[2]), Field(masks[3])};
    Image image = make_image(width, height, masks[3] != 0 ? 4 : 3);
    const bool wide =
        std::any_of(fields, fields + image.channels, [](const Field& f) { return f.is_wide(); });
    image.sample_type = wide ? SampleType::kUint16 : SampleType::kUint8;
    const int size = rows.header.bits / 8;
    for (int y = 0; y < height; ++y) {
        ByteReader row(rows.pixels.subspan(rows.begin(y)), ByteOrder::kLittle);
        float* out = image.pixel(0, y);
        for (int x = 0; x < width; ++x, out += image.channels) {
            const std::uint32_t pixel = row.number(size);
            for (int c = 0; c < image.channels; ++c) out[c] = fields[c].value(pixel);
        }
    }
    return image;
}

}  // namespace

DecodedPicture decode_bmp(const PictureFile& file) {
    BmpHeader header = read_bmp_header(file.path, file.bytes);
    if (header.coding == BmpCoding::kFile)
        return decode_picture(file.path, file.bytes.subspan(header.pixels), file.options);
    check_size(file.path, header.width, header.height, header.masks[3] != 0 ? 4 : 3, file.options.limits);
    const auto width = static_cast<int>(header.width), height = static_cast<int>(header.height);
    const Bytes pixels = Bytes(file.bytes).subspan(header.pixels);
    DecodedPicture out;
    out.warnings = std::move(header.warnings);
    out.color = std::move(header.color);
    if (header.coding != BmpCoding::kRows) {
        const auto indices = read_bmp_runs(file.path, header, pixels, out.warnings);
        out.image = image_from_palette(width, height, indices, header.palette, false, out.warnings);
        return out;
    }
    const auto bits = static_cast<std::size_t>(header.bits);
    const Rows rows{file.path, header, pixels, (static_cast<std::size_t>(width) * bits + 31) / 32 * 4};
    rows.check(out.warnings);
    if (header.bits <= 8) {
        out.image = image_from_palette(width, height, read_indices(rows, width, height), header.palette,
                                       false, out.warnings);
    } else {
        out.image = read_colors(rows, width, height);
        drop_empty_alpha(out.image, out.warnings);
    }
    return out;
}

}  // namespace imgmesh
