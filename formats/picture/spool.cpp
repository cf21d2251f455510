#include "formats/picture/spool.h"

#include "formats/files/random_file.h"
#include "formats/picture/decode/spool_tag.h"
#include "formats/picture/regions/row_source.h"
#include "formats/picture/regions/spool_exr.h"
#include "formats/picture/regions/spool_tiff.h"
#include "formats/picture/regions/tiled_rows.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

void set_tags(const RowLayout& layout, TIFF* t) {
    const bool inks = layout.color.inks;
    const int color = inks ? 4 : layout.channels < 3 ? 1 : 3;
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC,
                 inks         ? PHOTOMETRIC_SEPARATED
                 : color == 3 ? PHOTOMETRIC_RGB
                              : PHOTOMETRIC_MINISBLACK);
    const std::uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
    if (layout.channels > color) TIFFSetField(t, TIFFTAG_EXTRASAMPLES, 1, &alpha);
    if (layout.orientation > 0) TIFFSetField(t, TIFFTAG_ORIENTATION, layout.orientation);
    set_spool_tag(t, spool_tag({layout.color, layout.inks_upside_down}));
}

std::vector<std::string> spool_rows(RowSource& source, const std::string& out_path) {
    const RowLayout& layout = source.layout();
    TiledRows out(out_path, {layout.width, layout.height, layout.channels, layout.bits},
                  [&](TIFF* t) { set_tags(layout, t); });
    out.write_plane([&](int, std::span<std::uint8_t> row) {
        source.read(row);
        return true;
    });
    std::vector<std::string> warnings = layout.warnings;
    for (std::string& warning : source.finish()) warnings.push_back(std::move(warning));
    out.finish();
    return warnings;
}

PictureFormat format_of(const std::string& path) {
    constexpr std::size_t kStart = std::size_t{1} << 16;  // far more than signatures need
    return probe_picture(path, RandomFile(path).bytes_at(0, kStart)).format;
}

}  // namespace

std::vector<std::string> spool_picture(const std::string& path, const std::string& out_path,
                                       const ReadImageOptions& options) {
    switch (format_of(path)) {
        case PictureFormat::kPng:
            return spool_rows(*open_png_rows(path, options), out_path);
        case PictureFormat::kJpeg:
            return spool_rows(*open_jpeg_rows(path, options), out_path);
        case PictureFormat::kExr:
            return spool_exr(path, out_path, options);
        case PictureFormat::kTiff:
            return spool_tiff(path, out_path, options);
        default:
            throw Error(ErrorKind::kUnsupported,
                        cat(path, ": only PNG, JPEG, TIFF and EXR are rewritten by rows"));
    }
}

DecodedPicture zero_pixel(const RowLayout& layout) {
    DecodedPicture out;
    out.image = make_image(1, 1, layout.channels);
    out.image.sample_type = layout.bits == 16 ? SampleType::kUint16 : SampleType::kUint8;
    out.orientation = layout.orientation;
    out.color = layout.color;
    if (layout.color.inks) out.image.channel_names = {"C", "M", "Y", "K"};
    out.warnings = layout.warnings;
    return out;
}

}  // namespace imgmesh
