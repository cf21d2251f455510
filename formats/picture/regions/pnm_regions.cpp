// Regions of Netpbm's files of bytes: their rows have places.
#include <algorithm>

#include "formats/files/random_file.h"
#include "formats/picture/decode/pnm_rows.h"
#include "formats/picture/regions/decoded_regions.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::size_t kStart = std::size_t{1} << 16;  // above any header but one of long comments

class PnmDecoder : public RegionDecoder {
  public:
    PnmDecoder(const std::string& path, const ReadImageOptions& options, PnmRows rows)
        : options_(options), file_(path), rows_(std::move(rows)) {
        options_.limits = source_limits(options, file_.size());
    }

    DecodedPicture decode(const PixelRect& stored) override {
        // Bits begin inside of a byte.
        const int unit = rows_.bits < 8 ? 8 : 1, left = stored.left / unit * unit;
        const int sample_bits = rows_.channels * rows_.bits;
        const std::uint64_t skipped =
            static_cast<std::uint64_t>(left) * static_cast<std::uint64_t>(sample_bits) / 8;
        const auto count =
            (static_cast<std::size_t>(stored.right - left) * static_cast<std::size_t>(sample_bits) + 7) / 8;
        std::vector<std::uint8_t> bytes = rows_.header(stored.right - left, stored.height());
        const std::size_t header = bytes.size();
        bytes.resize(header + count * static_cast<std::size_t>(stored.height()));
        const auto first = rows_.bottom_up ? rows_.height - stored.bottom : std::int64_t{stored.top};
        for (int y = 0; y < stored.height(); ++y) {
            const std::uint64_t at =
                rows_.pixels + static_cast<std::uint64_t>(first + y) * rows_.row_bytes() + skipped;
            const std::span row(bytes.data() + header + static_cast<std::size_t>(y) * count, count);
            if (file_.read_at(at, row) < count)
                throw Error(ErrorKind::kBadFile, cat(file_.path(), ": the image is truncated"));
        }
        DecodedPicture out = decode_pnm({file_.path(), bytes, {}, options_});
        if (left < stored.left) cut_columns(stored.left - left, out.image);
        return out;
    }

    PictureHeader header() {
        check_size(file_.path(), rows_.width, rows_.height, rows_.channels, options_.limits);
        PictureHeader out;
        out.width = static_cast<int>(rows_.width);
        out.height = static_cast<int>(rows_.height);
        out.block_width = out.block_height = 1;
        std::vector<std::uint8_t> zero = rows_.header(1, 1);
        zero.resize(zero.size() + static_cast<std::size_t>(rows_.channels) * sizeof(float));
        out.zero_pixel = decode_pnm({file_.path(), zero, {}, options_});
        return out;
    }

  private:
    static void cut_columns(int count, Image& image) {
        const int width = image.width - count;
        const auto row = static_cast<std::ptrdiff_t>(width) * image.channels;
        for (int y = 0; y < image.height; ++y)
            std::copy_n(image.pixel(count, y), row, image.data.begin() + row * y);
        image.width = width;
        image.data.resize(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.height));
    }

    ReadImageOptions options_;
    RandomFile file_;
    PnmRows rows_;
};

}  // namespace

std::unique_ptr<RegionReader> open_pnm_regions(const std::string& path, const ReadImageOptions& options) {
    const std::optional<PnmRows> rows = pnm_rows(path, RandomFile(path).bytes_at(0, kStart));
    if (!rows) return open_whole(path, options);
    PictureHeader header = PnmDecoder(path, options, *rows).header();
    return open_decoded(path, options, std::move(header), [path, options, rows = *rows] {
        return std::make_unique<PnmDecoder>(path, options, rows);
    });
}

}  // namespace imgmesh
