#include "formats/picture/regions/spool_tiff.h"

#include <optional>

#include "formats/picture/decode/tiff_picture.h"
#include "formats/picture/decode/tiff_rows.h"
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/tiled_rows.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A strip of 4096 x 1365 pixels of RGB is unpacked in a tenth of a second.
constexpr std::int64_t kMostInStrip = std::int64_t{1} << 24;

// Copies a tag of so many arrays or numbers, if the file has it.
template <typename... Values>
void copy_values(TIFF* from, TIFF* to, ttag_t tag, Values... values) {
    if (TIFFGetField(from, tag, &values...) == 1) TIFFSetField(to, tag, values...);
}

void copy_text(const TiffFile& from, TIFF* to, ttag_t tag) {
    if (!TIFFFindField(from.get(), tag, TIFF_ASCII)) return;
    std::uint32_t count = 0;
    const char* stored = nullptr;
    // The library does not know the tag, and gives the length of such.
    if (TIFFGetField(from.get(), tag, &count, &stored) != 1 || !stored) return;
    const std::string text(stored, count);
    TIFFFieldInfo field = {tag, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("text")};
    TIFFMergeFieldInfo(to, &field, 1);
    TIFFSetField(to, tag, text.c_str());
}

// What the layout of the copy, its colours, orientation and nodata are read from.
void copy_tags(const TiffFile& file, const TiffLayout& layout, TIFF* to) {
    TIFF* const from = file.get();
    TIFFSetField(to, TIFFTAG_PHOTOMETRIC, layout.photometric);
    if (!layout.extras.empty())
        TIFFSetField(to, TIFFTAG_EXTRASAMPLES, static_cast<std::uint16_t>(layout.extras.size()),
                     layout.extras.data());
    copy_values(from, to, TIFFTAG_SAMPLEFORMAT, std::uint16_t{});
    copy_values(from, to, TIFFTAG_ORIENTATION, std::uint16_t{});
    using Words = std::uint16_t*;
    using Floats = float*;
    if (layout.photometric == PHOTOMETRIC_PALETTE)
        copy_values(from, to, TIFFTAG_COLORMAP, Words{}, Words{}, Words{});
    if (layout.photometric == PHOTOMETRIC_YCBCR) {
        TIFFSetField(to, TIFFTAG_YCBCRSUBSAMPLING, layout.chroma_x, layout.chroma_y);
        copy_values(from, to, TIFFTAG_YCBCRCOEFFICIENTS, Floats{});
        copy_values(from, to, TIFFTAG_REFERENCEBLACKWHITE, Floats{});
    }
    copy_values(from, to, TIFFTAG_TRANSFERFUNCTION, Words{}, Words{}, Words{});
    copy_values(from, to, TIFFTAG_PRIMARYCHROMATICITIES, Floats{});
    copy_values(from, to, TIFFTAG_WHITEPOINT, Floats{});
    std::uint32_t length = 0;
    void* profile = nullptr;
    if (TIFFGetField(from, TIFFTAG_ICCPROFILE, &length, &profile) == 1 && profile)
        TIFFSetField(to, TIFFTAG_ICCPROFILE, length, profile);
    copy_text(file, to, kGdalNoData);
    set_spool_tag(to, copy_tag());
}

}  // namespace

bool is_spooled(const TiffFile& file, const TiffLayout& layout) {
    return layout.width * layout.block_height * layout.samples > kMostInStrip && has_rows(file, layout);
}

std::vector<std::string> spool_tiff(const std::string& path, const std::string& out_path,
                                    const ReadImageOptions& options) {
    const RandomFile file(path);
    TiffFile tiff(file);
    TiffPicture picture(tiff, options, source_limits(options, file.size()));
    const TiffLayout& layout = picture.layout();
    if (!has_rows(tiff, layout))
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": this TIFF is not one of rows that follow each other"));
    const RowShape shape{static_cast<int>(layout.width), static_cast<int>(layout.height), layout.samples,
                         layout.bits, layout.planar};
    TiledRows out(out_path, shape, [&](TIFF* to) { copy_tags(tiff, layout, to); });
    std::optional<std::string> broken;
    TiffRows rows(tiff, layout);
    for (int plane = 0; plane < (layout.planar ? layout.samples : 1); ++plane) {
        std::int64_t lost = -1;  // the strip that is broken
        out.write_plane([&](int y, std::span<std::uint8_t> row) {
            if (rows.strip(y) == lost) return false;
            try {
                rows.read(y, plane, row);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::kBadFile) throw;
                lost = rows.strip(y);
                if (!broken) broken = error.what();
                return false;
            }
            return true;
        });
    }
    if (broken && out.empty()) throw Error(ErrorKind::kBadFile, *broken);
    out.finish();
    std::vector<std::string> warnings = picture.zero_pixel().warnings;
    if (broken) warnings.push_back(cat("not all of it can be read: ", *broken));
    return warnings;
}

}  // namespace imgmesh
